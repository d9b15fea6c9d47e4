#include <incise/core/expect.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {

void Expect::operator()(bool is_valid, std::string_view field, double found, std::string_view expected) const {
  if (is_valid && std::isfinite(found)) return;
  note({std::string(field), fmt::format("{}", found), std::string(expected)});
}

void Expect::in_range(std::string_view field, double found, double low, double high) const {
  if (found >= low && found <= high) return;
  note({std::string(field), fmt::format("{}", found), fmt::format("a number in [{}, {}]", low, high)});
}

void Expect::note(const Problem& problem) const {
  if (problems_ != nullptr) problems_->push_back(problem);
  if (sentences_ != nullptr) sentences_->push_back(sentence(problem));
}

}  // namespace incise
