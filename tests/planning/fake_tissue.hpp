#pragma once

#include <incise/planning/converging_compensation.hpp>

#include <cmath>
#include <functional>
#include <numbers>

namespace incise::testing {

inline constexpr double kEdgeRadiusMm = 10.0;
inline constexpr double kRingRadiusMm = 15.0;
/// By how much straight lines between 48 waypoints cut the ring's corners, and a margin.
inline constexpr double kChordMm = 0.03;
inline constexpr double kTurn = 2.0 * std::numbers::pi;

/// A stand-in for tissue round a round tumour on a flat body: the radius of the cut at an angle is that of the path,
/// answered `gain` times and blurred as by a lag, plus a drift that depends on the angle alone.
struct FakeTissue {
  std::function<double(double)> drift_mm = [](double) { return -1.4; };
  double gain = 1.0;
  double lag_mm = 0.0;  ///< standard deviation of the blur
  std::function<double(double)> grain_mm = [](double) { return 0.0; };
  double seen_from = 0.0;  ///< angles at which a contour is found, in (seen_from, 2π)

  [[nodiscard]] double path_offset(const ToolPath& path, double angle) const {
    const Contour entries = entry_contour(path);
    const Vec3 direction(std::cos(angle), std::sin(angle), 0.0);
    return nearest_on(entries, 1.01 * kRingRadiusMm * direction).position_mm.dot(direction) - kRingRadiusMm;
  }
  [[nodiscard]] double cut_radius(const ToolPath& path, double angle) const {
    if (lag_mm == 0.0) return kRingRadiusMm + gain * path_offset(path, angle) + drift_mm(angle) + grain_mm(angle);
    double sum = 0.0;
    double weights = 0.0;
    for (int j = -24; j <= 24; ++j) {
      const double apart = 0.125 * j;  // standard deviations
      const double weight = std::exp(-0.5 * apart * apart);
      sum += weight * path_offset(path, angle + apart * lag_mm / kRingRadiusMm);
      weights += weight;
    }
    return kRingRadiusMm + gain * sum / weights + drift_mm(angle) + grain_mm(angle);
  }
  [[nodiscard]] PathErrors cut(const ToolPath& path) const {
    PathErrors errors;
    for (int k = 0; k < 360; ++k) {
      const double angle = kTurn * k / 360.0;
      if (angle < seen_from) continue;
      const double radius = cut_radius(path, angle);
      errors.places.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0);
      errors.signed_error_mm.push_back(radius - kRingRadiusMm);
    }
    errors.lag_mm = lag_mm;
    errors.is_success = seen_from == 0.0;
    return errors;
  }
};

}  // namespace incise::testing
