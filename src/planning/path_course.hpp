#pragma once

#include <incise/planning/converging_compensation.hpp>

#include <span>

namespace incise {

/// A closed path as a ruler: a place beside it has the arc length of the path's nearest point.
class PathCourse {
 public:
  explicit PathCourse(const ToolPath& path);

  [[nodiscard]] double length_mm() const { return length_; }
  [[nodiscard]] std::size_t waypoints() const { return along_.size(); }
  [[nodiscard]] double at(std::size_t waypoint) const { return along_[waypoint]; }  ///< its arc length
  /// How much of the path is nearer to this waypoint than to its neighbours.
  [[nodiscard]] double share_mm(std::size_t waypoint) const;
  /// Way from arc length a to b along the ring, the shorter one, signed.
  [[nodiscard]] double way(double a, double b) const;
  /// Arc length of the path's point nearest to p, [0, length].
  [[nodiscard]] double along_mm(const Vec3& p) const;
  /// Values given at the waypoints, at an arc length (round the ring), linear between waypoints. One value: everywhere.
  [[nodiscard]] double interpolate(std::span<const double> at_waypoints, double along_mm) const;

  struct Averages {
    std::vector<double> value;                  ///< per waypoint
    std::vector<std::uint8_t> is_interpolated;  ///< per waypoint: 1 where no value lay near
  };
  /// Means of values scattered along the path, per waypoint, with Gaussian weights of this standard deviation. Where
  /// none lies within two of them, the waypoint's neighbours are interpolated. @pre at least one value.
  [[nodiscard]] Averages average(std::span<const double> along_mm, std::span<const double> values,
                                 double smoothing_mm) const;

 private:
  void bridge(Averages& averages) const;

  Contour contour_;
  std::vector<double> along_;  ///< of the waypoints
  double length_ = 0.0;
};

}  // namespace incise
