#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace incise {

/// The middle one of the values in order, the upper of two. Reorders them. @pre at least one value, none NaN.
template <class Number>
[[nodiscard]] Number median(std::vector<Number>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace incise
