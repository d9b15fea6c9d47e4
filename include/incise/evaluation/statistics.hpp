#pragma once

#include <span>

namespace incise {

/// Mean, spread and range of a list of numbers, in their unit.
struct Summary {
  double mean = 0.0;
  double sd = 0.0;  ///< sample standard deviation (divided by n - 1); 0 for a single number
  double min = 0.0;
  double max = 0.0;
};

/// @pre at least one value, all finite; otherwise InvalidArgument naming the first bad index.
[[nodiscard]] Summary summarize(std::span<const double> values);

}  // namespace incise
