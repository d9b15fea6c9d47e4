#pragma once

#include <incise/planning/converging_compensation.hpp>

#include <span>

namespace incise {

/// Arc length along a closed path, mm. A place beside the path has the arc length of its nearest point.
class PathCourse {
 public:
  explicit PathCourse(const ToolPath& path);

  [[nodiscard]] std::size_t waypoints() const { return along_.size(); }
  [[nodiscard]] double at(std::size_t waypoint) const { return along_[waypoint]; }  ///< arc length of a waypoint
  /// Length of the path that is nearer to this waypoint than to its neighbours, along the path.
  [[nodiscard]] double share_mm(std::size_t waypoint) const;
  /// Signed way from arc length a to b along the ring, the shorter one.
  [[nodiscard]] double way(double a, double b) const;
  /// Arc length of the path's point nearest to p, [0, length].
  [[nodiscard]] double along_mm(const Vec3& p) const;
  /// Interpolates values at the waypoints at an arc length (round the ring), linearly. A single value holds everywhere.
  [[nodiscard]] double interpolate(std::span<const double> at_waypoints, double along_mm) const;

  struct Averages {
    std::vector<double> value;                  ///< per waypoint
    std::vector<std::uint8_t> is_interpolated;  ///< per waypoint: 1 if no value lay near
  };
  /// Averages values scattered along the path at each waypoint, with Gaussian weights of standard deviation
  /// `smoothing_mm`. A waypoint without a value within two standard deviations is interpolated from its neighbours.
  /// @pre at least one value.
  [[nodiscard]] Averages average(std::span<const double> along_mm, std::span<const double> values,
                                 double smoothing_mm) const;

 private:
  void bridge(Averages& averages) const;

  Contour contour_;
  std::vector<double> along_;  ///< of the waypoints
  double length_ = 0.0;
};

}  // namespace incise
