#pragma once

#include <incise/geometry/types.hpp>

#include <span>
#include <vector>

namespace incise {

/// Points, each with the number of cloud points that it represents.
struct WeightedPoints {
  Points points;
  std::vector<double> weights;
  double cell = 0.0;  ///< size of the cubes whose points were merged; 0: the cloud itself
};

/// Returns a cloud from coarse to fine: clusters of ever smaller cubes, and last the cloud itself.
[[nodiscard]] std::vector<WeightedPoints> levels_of(std::span<const Vec3> points);

/// Returns the coarsest level whose cubes are no larger than `share` times `sigma`: a cluster then widens a Gaussian's
/// σ² by at most the fraction share²/12.
[[nodiscard]] const WeightedPoints& level_for(const std::vector<WeightedPoints>& levels, double sigma,
                                              double share = 0.5);

/// Position and size of a cloud.
struct Measure {
  Vec3 center = Vec3::Zero();     ///< mean of the points
  double radius = 0.0;            ///< root mean square distance from the mean
  Vec3 variances = Vec3::Zero();  ///< along its principal axes, ascending
};
[[nodiscard]] Measure measure_of(std::span<const Vec3> points);

/// Returns (point - center) / length for every point.
[[nodiscard]] Points normalised(std::span<const Vec3> points, const Vec3& center, double length);

/// Whether a cloud with these variances (ascending) is a point or a line.
[[nodiscard]] bool is_line(const Vec3& variances);

}  // namespace incise
