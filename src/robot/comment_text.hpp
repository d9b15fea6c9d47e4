#pragma once

#include <incise/robot/program_text.hpp>

#include <string>
#include <string_view>

namespace incise::robot_detail {

/// Returns the text without characters that could end its line or hide a part of it in some reader. Control characters
/// (C0, DEL, C1), characters that some readers take for a line end (VT, FF, NEL, U+2028, U+2029), characters that
/// change the reading direction and invisible characters become blanks; bytes that are not UTF-8 become question marks.
[[nodiscard]] std::string comment_text(std::string_view text);

/// Returns the position of the first such character or byte in a text of several lines, where LF, CR LF and tabs are
/// allowed; npos if there is none.
[[nodiscard]] std::size_t first_hidden(std::string_view text);

/// Returns the header with keys and values passed through comment_text. A value with line ends (LF, CR LF) becomes one
/// entry for each line.
[[nodiscard]] ProgramHeader plain_header(const ProgramHeader& header);

}  // namespace incise::robot_detail
