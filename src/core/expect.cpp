#include <incise/core/expect.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {

void Expect::operator()(bool is_valid, std::string_view field, double found, std::string_view expected) const {
  if (is_valid && std::isfinite(found)) return;
  violations_.push_back(fmt::format("{}: found {}, expected {}", field, found, expected));
}

void Expect::in_range(std::string_view field, double found, double low, double high) const {
  if (found >= low && found <= high) return;
  violations_.push_back(fmt::format("{}: found {}, expected a number in [{}, {}]", field, found, low, high));
}

}  // namespace incise
