#pragma once

#include <incise/robot/program_text.hpp>

#include <string>
#include <string_view>

namespace incise::robot_detail {

/// A text that stays on its line and shows what it holds, wherever it is read: every control character (C0, DEL, C1),
/// every character that ends a line somewhere (VT, FF, NEL, U+2028, U+2029), those that turn the direction of reading
/// or are not seen at all become a blank, each byte that is not UTF-8 a question mark.
[[nodiscard]] std::string comment_text(std::string_view text);

/// Where the first such character or byte of a text of several lines stands; LF, CR LF and tabs are allowed. npos:
/// nowhere.
[[nodiscard]] std::size_t first_hidden(std::string_view text);

/// The header with such values; one with line ends (LF, CR LF) becomes one entry a line.
[[nodiscard]] ProgramHeader plain_header(const ProgramHeader& header);

}  // namespace incise::robot_detail
