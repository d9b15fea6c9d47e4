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
  v("mean", s.mean, "Mean value.");
  v("sd", s.sd, "Sample standard deviation; 0 for a single number.", kNotNegative);
  v("min", s.min, "Least value.");
  v("max", s.max, "Greatest value.");
}

/// Computes mean, spread and range. @throws InvalidArgument without values, or naming the first that is not finite.
[[nodiscard]] Summary summarize(std::span<const double> values);

/// Two-sided 95 % quantile of the standard normal distribution.
inline constexpr double kNormal95 = 1.959963984540054;
[[nodiscard]] double normal_density(double z);      ///< density of the standard normal distribution
[[nodiscard]] double normal_share_below(double z);  ///< probability of a standard normal number below z

}  // namespace incise
