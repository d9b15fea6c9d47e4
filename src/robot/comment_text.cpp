#include "robot/comment_text.hpp"

#include <incise/core/utf8.hpp>

#include <algorithm>
#include <array>
#include <cstdint>

namespace incise::robot_detail {
namespace {

struct Range {
  std::uint32_t first, last;
};

/// Characters that may end a line, change the reading direction, or are invisible [Unicode: Cc, Cf, Zl, Zp,
/// noncharacters].
constexpr std::array<Range, 17> kNotPlain{{{0x00, 0x1F},
                                           {0x7F, 0x9F},
                                           {0xAD, 0xAD},
                                           {0x61C, 0x61C},
                                           {0x180E, 0x180E},
                                           {0x200B, 0x200F},
                                           {0x2028, 0x202E},
                                           {0x2060, 0x206F},
                                           {0xFDD0, 0xFDEF},
                                           {0xFE00, 0xFE0F},
                                           {0xFEFF, 0xFEFF},
                                           {0xFFF9, 0xFFFB},
                                           {0xFFFE, 0xFFFF},
                                           {0x1D173, 0x1D17A},
                                           {0x1FFFE, 0x1FFFF},
                                           {0xE0000, 0xE0FFF},
                                           {0xF0000, 0x10FFFF}}};

bool is_plain(std::uint32_t code) {
  return std::none_of(kNotPlain.begin(), kNotPlain.end(),
                      [code](const Range& range) { return code >= range.first && code <= range.last; });
}

/// Length, in bytes, and code of the UTF-8 character at the beginning of a text; 0 bytes if there is none.
struct Utf8Character {
  std::size_t bytes = 0;
  std::uint32_t code = 0;
};

Utf8Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return {1, lead};
  const std::size_t bytes = lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  if (text.size() < bytes || first_not_utf8(text.substr(0, bytes))) return {};
  std::uint32_t code = lead & (0xFFU >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) code = (code << 6U) | (byte(i) & 0x3FU);
  return {bytes, code};
}

}  // namespace

std::string comment_text(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    const Utf8Character character = first_character(text);
    if (character.bytes == 0)
      plain += '?';
    else if (is_plain(character.code))
      plain += text.substr(0, character.bytes);
    else
      plain += ' ';
    text.remove_prefix(std::max<std::size_t>(1, character.bytes));
  }
  return plain;
}

std::size_t first_hidden(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const Utf8Character character = first_character(text.substr(at));
    const bool is_blank = text[at] == '\n' || text[at] == '\t' || text.substr(at, 2) == "\r\n";
    if (!is_blank && (character.bytes == 0 || !is_plain(character.code))) return at;
    at += character.bytes;
  }
  return std::string_view::npos;
}

ProgramHeader plain_header(const ProgramHeader& header) {
  ProgramHeader plain;
  for (const auto& [key, value] : header) {
    for (std::string_view rest = value;;) {
      const std::size_t end = rest.find('\n');
      std::string_view line = rest.substr(0, end);
      if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      plain.emplace_back(comment_text(key), comment_text(line));
      if (end == std::string_view::npos) break;
      rest.remove_prefix(end + 1);
    }
  }
  return plain;
}

}  // namespace incise::robot_detail
