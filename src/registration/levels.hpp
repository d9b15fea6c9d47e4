#pragma once

#include <incise/geometry/types.hpp>

#include <span>
#include <vector>

namespace incise {

/// Points with the number of cloud points that each stands for.
struct WeightedPoints {
  Points points;
  std::vector<double> weights;
  double cell = 0.0;  ///< size of the cubes whose points were put together; 0: every point is itself
};

/// A cloud, coarse to fine: clusters of ever smaller cubes, and last the cloud itself.
[[nodiscard]] std::vector<WeightedPoints> levels_of(std::span<const Vec3> points);

/// The coarsest level whose cubes are no larger than `share` of `sigma`: a cluster then widens a Gaussian's σ² by at
/// most share²/12.
[[nodiscard]] const WeightedPoints& level_for(const std::vector<WeightedPoints>& levels, double sigma,
                                              double share = 0.5);

/// The origin and length that a cloud is measured by: its mean and root mean square distance from it.
struct Measure {
  Vec3 center = Vec3::Zero();
  double radius = 0.0;
  Vec3 variances = Vec3::Zero();  ///< along its principal axes, ascending
};
[[nodiscard]] Measure measure_of(std::span<const Vec3> points);

/// The points less the centre, over the length.
[[nodiscard]] Points normalised(std::span<const Vec3> points, const Vec3& center, double length);

/// Whether a cloud of these variances is a point or a line.
[[nodiscard]] bool is_line(const Vec3& variances);

}  // namespace incise
