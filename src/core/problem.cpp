#include <incise/core/problem.hpp>

#include <fmt/format.h>

namespace incise {

std::string sentence(const Problem& problem) {
  return fmt::format("{}: found {}, expected {}", problem.path, problem.found, problem.expected);
}

std::vector<std::string> sentences(std::span<const Problem> problems) {
  std::vector<std::string> all;
  for (const Problem& problem : problems) all.push_back(sentence(problem));
  return all;
}

}  // namespace incise
