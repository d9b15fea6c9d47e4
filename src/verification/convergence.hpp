#pragma once

#include <cmath>
#include <limits>

namespace incise {

/// Returns the observed order of convergence from the errors on two meshes, the second twice as fine:
/// log2 |coarse / fine|.
[[nodiscard]] inline double observed_rate(double coarse_error, double fine_error) {
  return std::log2(std::abs(coarse_error / fine_error));
}

/// Returns the limit of two values whose errors shrink with the square of the mesh size, the second mesh twice as fine
/// (Richardson).
[[nodiscard]] inline double second_order_limit(double coarse, double fine) {
  return fine + (fine - coarse) / 3.0;
}

/// Returns the limit of three values, on meshes each twice as fine as the one before, whose differences shrink by a
/// constant factor (Aitken; Richardson with the observed order). NaN if they do not shrink.
[[nodiscard]] inline double extrapolated(double coarse, double medium, double fine) {
  const double factor = (medium - coarse) / (fine - medium);
  if (!(factor > 1.0)) return std::numeric_limits<double>::quiet_NaN();
  return fine + (fine - medium) / (factor - 1.0);
}

}  // namespace incise
