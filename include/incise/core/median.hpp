#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace incise {

/// Returns the median of the values; of an even number, the upper of the two middle ones. Reorders the values.
/// @pre at least one value, none NaN.
template <class Number>
[[nodiscard]] Number median(std::vector<Number>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace incise
