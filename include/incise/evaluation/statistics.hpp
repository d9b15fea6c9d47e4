#pragma once

#include <incise/core/describe.hpp>

#include <span>

namespace incise {

/// Mean, spread and range of a list of numbers, in their unit.
struct Summary {
  double mean = 0.0;
  double sd = 0.0;  ///< sample standard deviation (divided by n - 1); 0 for a single number
  double min = 0.0;
  double max = 0.0;
};
inline void describe(Visitor& v, Summary& s) {
  v("mean", s.mean, "Mean.");
  v("sd", s.sd, "Sample standard deviation; 0 for a single number.", kNotNegative);
  v("min", s.min, "Least.");
  v("max", s.max, "Greatest.");
}

/// @pre at least one value, all finite; otherwise InvalidArgument naming the first bad index.
[[nodiscard]] Summary summarize(std::span<const double> values);

/// Of the standard normal distribution: its density, and the probability of a number below z.
inline constexpr double kNormal95 = 1.959963984540054;  ///< its two-sided quantile of 95 %
[[nodiscard]] double normal_density(double z);
[[nodiscard]] double normal_share_below(double z);

}  // namespace incise
