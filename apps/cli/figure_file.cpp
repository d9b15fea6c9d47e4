#include "figure_file.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/report/svg_png.hpp>

#include <fmt/format.h>

namespace incise::cli {

void require_figure_file(const std::filesystem::path& path, const char* option) {
  const std::string ending = path.extension().string();
  if (ending != ".svg" && ending != ".png") {
    throw CaseError("command line", option, fmt::format("'{}'", path.string()), "a name that ends in .svg or .png");
  }
  require_writable(path);
}

void write_figure(const std::filesystem::path& path, const std::string& svg) {
  const std::string bytes = path.extension() == ".png" ? png_of_svg(svg) : svg;
  write_atomically(path, bytes);
}

}  // namespace incise::cli
