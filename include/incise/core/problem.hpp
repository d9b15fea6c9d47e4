#pragma once

#include <span>
#include <string>
#include <system_error>
#include <vector>

namespace incise {

/// A problem with a value, as data; it becomes a sentence where it is shown.
struct Problem {
  std::string path;  ///< of the field, such as prony[0].time_s; empty: the value as a whole
  std::string found;
  std::string expected;
  std::string hint = {};  ///< what to do about it; may be empty
};

/// Returns the problem as text: "depth_mm: found -1, expected a number above 0. Give it in mm."
[[nodiscard]] std::string sentence(const Problem& problem);
[[nodiscard]] std::vector<std::string> sentences(std::span<const Problem> problems);

/// Returns a text as it reads inside a sentence: without its capital letter, unless it begins with an abbreviation such
/// as DICOM.
[[nodiscard]] std::string within_sentence(std::string text);

/// Returns the system's reason for a failure, as it reads inside a sentence: "no such file or directory".
[[nodiscard]] std::string system_reason(const std::error_code& error);
/// As above. @param number  the value of errno.
[[nodiscard]] std::string system_reason(int number);

/// Checks that there are no problems. @param function  named in the message; by default the caller.
/// @throws InvalidArgument with all problems in one line.
void require_none(std::span<const Problem> problems, const char* function = __builtin_FUNCTION());

}  // namespace incise
