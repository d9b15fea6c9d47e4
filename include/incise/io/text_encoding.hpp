#pragma once

#include <string>
#include <string_view>

namespace incise {

/// Text made safe for XML, HTML and SVG, in content and in quoted attributes.
[[nodiscard]] std::string escaped(std::string_view text);

inline constexpr std::string_view kBase64Digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Base64 (RFC 4648, section 4, with padding).
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace incise
