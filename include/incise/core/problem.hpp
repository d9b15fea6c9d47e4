#pragma once

#include <span>
#include <string>
#include <vector>

namespace incise {

/// What is wrong with a value: a complaint as data, of which a sentence is made where it is shown.
struct Problem {
  std::string path;  ///< of the field: prony[0].time_s
  std::string found;
  std::string expected;
};

/// "depth_mm: found -1, expected a depth above 0 mm".
[[nodiscard]] std::string sentence(const Problem& problem);
[[nodiscard]] std::vector<std::string> sentences(std::span<const Problem> problems);

}  // namespace incise
