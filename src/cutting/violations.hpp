#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

namespace incise {

/// Notes a field of settings that is not valid, or not finite: "dullness: found -1, expected a number of reference steps above 0".
inline void expect(bool is_valid, std::vector<std::string>& violations, const char* field, double found, const char* expected) {
  if (!is_valid || !std::isfinite(found)) {
    violations.push_back(fmt::format("{}: found {}, expected {}", field, found, expected));
  }
}

}  // namespace incise
