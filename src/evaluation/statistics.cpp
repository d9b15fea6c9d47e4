#include <incise/core/error.hpp>
#include <incise/evaluation/statistics.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace incise {

Summary summarize(std::span<const double> values) {
  INCISE_REQUIRE(!values.empty(), "expected at least 1 value, found none");
  Summary summary{.mean = 0.0, .sd = 0.0, .min = values[0], .max = values[0]};
  double sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    INCISE_REQUIRE(std::isfinite(values[i]), fmt::format("value {} is not finite", i));
    sum += values[i];
    summary.min = std::min(summary.min, values[i]);
    summary.max = std::max(summary.max, values[i]);
  }
  const auto count = static_cast<double>(values.size());
  summary.mean = sum / count;
  // Two passes keep the digits of a small spread about a large mean.
  double squares = 0.0;
  for (const double value : values) squares += (value - summary.mean) * (value - summary.mean);
  if (values.size() > 1) summary.sd = std::sqrt(squares / (count - 1.0));
  return summary;
}

double normal_density(double z) {
  return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
}

double normal_share_below(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

}  // namespace incise
