#pragma once

#include <span>
#include <string>
#include <vector>

namespace incise {

/// What is wrong with a value: a complaint as data, of which a sentence is made where it is shown.
struct Problem {
  std::string path;  ///< of the field: prony[0].time_s; empty: the value as a whole
  std::string found;
  std::string expected;
  std::string hint = {};  ///< what to do about it; may be empty
};

/// "depth_mm: found -1, expected a number above 0. Give it in mm."
[[nodiscard]] std::string sentence(const Problem& problem);
[[nodiscard]] std::vector<std::string> sentences(std::span<const Problem> problems);

/// @throws InvalidArgument with all of them in one line, from the function that asks.
void require_none(std::span<const Problem> problems, const char* function = __builtin_FUNCTION());

}  // namespace incise
