#pragma once

#include <incise/geometry/types.hpp>
#include <incise/registration/similarity.hpp>

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

/// Returns the coarsest level whose cubes are no larger than half of `sigma`: a cluster then widens a Gaussian's σ² by
/// at most a 48th.
[[nodiscard]] const WeightedPoints& level_for(const std::vector<WeightedPoints>& levels, double sigma);

/// Position and size of a cloud.
struct Measure {
  Vec3 center = Vec3::Zero();     ///< mean of the points
  double radius = 0.0;            ///< root mean square distance from the mean
  Vec3 variances = Vec3::Zero();  ///< along its principal axes, ascending
};
[[nodiscard]] Measure measure_of(std::span<const Vec3> points);

/// Maps transforms to and from the frame of a search: each cloud centred, in units of the target's radius. Scales do
/// not change.
struct SearchFrame {
  Vec3 source_center;   ///< mean of the source, mm
  Vec3 target_center;   ///< mean of the target, mm
  double length = 1.0;  ///< radius of the target, mm

  [[nodiscard]] Similarity to_search(const Similarity& t) const {
    return {t.scale, t.rotation, (t(source_center) - target_center) / length};
  }
  [[nodiscard]] Similarity from_search(const Similarity& t) const {
    return {t.scale, t.rotation, length * t.translation_mm + target_center - t.scale * (t.rotation * source_center)};
  }
};

/// Returns (point - center) / length for every point.
[[nodiscard]] Points normalised(std::span<const Vec3> points, const Vec3& center, double length);

/// Whether a cloud with these variances (ascending) is a point or a line.
[[nodiscard]] bool is_line(const Vec3& variances);

/// @throws InvalidArgument without points, or for one that is not finite. @param name  of the cloud, for the message.
void require_usable(std::span<const Vec3> points, const char* name);

/// Returns centres spread evenly over the points: each next one is the farthest from those chosen, until all points are
/// within `spacing` of a chosen one or `most` are chosen.
[[nodiscard]] Points spread_centers(const Points& points, double spacing, std::size_t most);

/// Returns a Gaussian of this width about each centre (a column) at each point (a row).
[[nodiscard]] Eigen::MatrixXd gaussians(const Points& points, const Points& centers, double width);

}  // namespace incise
