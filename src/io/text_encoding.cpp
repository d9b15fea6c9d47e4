#include <incise/io/text_encoding.hpp>

#include <cstdint>

namespace incise {

std::string escaped(std::string_view text) {
  constexpr std::string_view kSpecial = "&<>\"'";
  constexpr std::string_view kEscapes[] = {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    const std::size_t place = kSpecial.find(c);
    result += place == std::string_view::npos ? std::string_view(&c, 1) : kEscapes[place];
  }
  return result;
}

std::string base64(std::string_view bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const bool is_padding = i + k > bytes.size();
      text += is_padding ? '=' : kBase64Digits[bits >> (18 - 6 * k) & 63];
    }
  }
  return text;
}

}  // namespace incise
