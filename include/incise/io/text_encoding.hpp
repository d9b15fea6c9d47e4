#pragma once

#include <string>
#include <string_view>

namespace incise {

/// Returns the text escaped for XML, HTML and SVG, safe in content and in quoted attributes.
[[nodiscard]] std::string escaped(std::string_view text);

inline constexpr std::string_view kBase64Digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Returns the bytes as Base64 (RFC 4648, section 4, with padding).
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace incise
