#pragma once

#include <string_view>

/// The files of src/report/page and three.js, written into the library by embed.cmake when it is built.
namespace incise::page {

extern const std::string_view page_html;
extern const std::string_view page_css;
extern const std::string_view three_licence;
extern const std::string_view three_js;
extern const std::string_view decode_js;
extern const std::string_view viewer_js;
extern const std::string_view cut_view_js;
extern const std::string_view mesh_view_js;
extern const std::string_view main_js;

}  // namespace incise::page
