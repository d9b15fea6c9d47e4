#include "planning/path_course.hpp"

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr double kReach = 2.0;  // standard deviations within which a value counts as near

}  // namespace

PathCourse::PathCourse(const ToolPath& path) : contour_(entry_contour(path)) {
  const std::size_t n = contour_.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    along_.push_back(length_);
    length_ += (contour_.points[(i + 1) % n] - contour_.points[i]).norm();
  }
}

double PathCourse::along_mm(const Vec3& p) const {
  const ContourPoint nearest = nearest_on(contour_, p);
  const std::size_t next = nearest.segment + 1;
  const double end = next == along_.size() ? length_ : along_[next];
  return along_[nearest.segment] + nearest.fraction * (end - along_[nearest.segment]);
}

double PathCourse::way(double a, double b) const {
  return std::remainder(b - a, length_);
}

double PathCourse::share_mm(std::size_t waypoint) const {
  const std::size_t n = along_.size();
  const double next = waypoint + 1 == n ? length_ : along_[waypoint + 1];
  const double previous = waypoint == 0 ? along_[n - 1] - length_ : along_[waypoint - 1];
  return 0.5 * (next - previous);
}

double PathCourse::interpolate(std::span<const double> at_waypoints, double along_mm) const {
  if (at_waypoints.size() == 1) return at_waypoints[0];
  const double place = along_mm - length_ * std::floor(along_mm / length_);
  const auto above = std::upper_bound(along_.begin(), along_.end(), place);
  const auto next = static_cast<std::size_t>(above - along_.begin());  // the first waypoint lies at 0: never 0
  const double end = next == along_.size() ? length_ : along_[next];
  const double share = (place - along_[next - 1]) / (end - along_[next - 1]);
  return (1.0 - share) * at_waypoints[next - 1] + share * at_waypoints[next % along_.size()];
}

PathCourse::Averages PathCourse::average(std::span<const double> along_mm, std::span<const double> values,
                                         double smoothing_mm) const {
  Averages averages{std::vector<double>(along_.size(), 0.0), std::vector<std::uint8_t>(along_.size(), 0)};
  for (std::size_t i = 0; i < along_.size(); ++i) {
    double weights = 0.0;
    double sum = 0.0;
    double nearest = length_;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double apart = way(along_[i], along_mm[k]);
      nearest = std::min(nearest, std::abs(apart));
      const double weight = std::exp(-0.5 * std::pow(apart / smoothing_mm, 2));
      weights += weight;
      sum += weight * values[k];
    }
    averages.is_interpolated[i] = nearest > kReach * smoothing_mm ? 1 : 0;
    if (averages.is_interpolated[i] == 0) averages.value[i] = sum / weights;
  }
  bridge(averages);
  return averages;
}

void PathCourse::bridge(Averages& averages) const {
  const std::size_t n = along_.size();
  const std::vector<double> known = averages.value;
  const auto is_known = [&](std::size_t i) { return averages.is_interpolated[i] == 0; };
  for (std::size_t i = 0; i < n; ++i) {
    if (is_known(i)) continue;
    std::size_t before = 1;
    while (before < n && !is_known((i + n - before) % n)) ++before;
    std::size_t after = 1;
    while (after < n && !is_known((i + after) % n)) ++after;
    if (before == n) continue;  // no waypoint has a value near it
    const std::size_t a = (i + n - before) % n;
    const std::size_t b = (i + after) % n;
    const auto round = [&](double way_mm) { return way_mm - length_ * std::floor(way_mm / length_); };
    const double behind = round(along_[i] - along_[a]);
    const double ahead = round(along_[b] - along_[i]);
    averages.value[i] = (known[a] * ahead + known[b] * behind) / (behind + ahead);
  }
}

}  // namespace incise
