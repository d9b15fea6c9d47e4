#include "robot/tip_curve.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise::robot_detail {
namespace {

constexpr std::size_t kFinePerSegment = 64;  // chords this short deviate from the curve by less than 0.02 mm / 1000
constexpr double kLeastGapMm = 1e-3;

/// Tangent at b of the Catmull-Rom spline through a, b, c whose parameter is the chord length: the slope at b of the
/// parabola through the three. [Barry and Goldman 1988]
Vec3 tangent(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double before = (b - a).norm(), after = (c - b).norm();
  return (after * (b - a) / before + before * (c - b) / after) / (before + after);
}

/// Cubic Hermite curve over a chord of length h.
Vec3 hermite(const Vec3& p, const Vec3& p_slope, const Vec3& q, const Vec3& q_slope, double h, double t) {
  const double t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * p + (t3 - 2 * t2 + t) * h * p_slope + (3 * t2 - 2 * t3) * q + (t3 - t2) * h * q_slope;
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

std::vector<Vec3> slopes_at(const std::vector<Vec3>& tips, bool is_closed) {
  const std::size_t n = tips.size();
  std::vector<Vec3> slopes(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (is_closed || (i > 0 && i + 1 < n)) {
      slopes[i] = tangent(tips[(i + n - 1) % n], tips[i], tips[(i + 1) % n]);
    }
  }
  if (!is_closed && n == 2) {
    slopes[0] = slopes[1] = (tips[1] - tips[0]).normalized();
  } else if (!is_closed) {
    // End slopes of the parabola through the end's three points: twice the chord's slope less the neighbour's.
    slopes[0] = 2.0 * (tips[1] - tips[0]).normalized() - slopes[1];
    slopes[n - 1] = 2.0 * (tips[n - 1] - tips[n - 2]).normalized() - slopes[n - 2];
  }
  return slopes;
}

}  // namespace

TipCurve::TipCurve(const ToolPath& path) : is_closed_(path.is_closed) {
  const std::size_t n = path.waypoints.size();
  std::vector<Vec3> tips;
  for (const Waypoint& waypoint : path.waypoints)
    tips.push_back(waypoint.position_mm + waypoint.depth_mm * waypoint.axis);
  const std::size_t segments = is_closed_ ? n : n - 1;
  for (std::size_t i = 0; i < segments; ++i) {
    const double gap = (tips[(i + 1) % n] - tips[i]).norm();
    INCISE_REQUIRE(gap > kLeastGapMm, fmt::format("expected tips more than {} mm apart, found {} mm after waypoint {}",
                                                  kLeastGapMm, gap, i));
  }
  const std::vector<Vec3> slopes = slopes_at(tips, is_closed_);
  for (std::size_t i = 0; i < segments; ++i) {
    const Waypoint& from = path.waypoints[i];
    const Waypoint& to = path.waypoints[(i + 1) % n];
    const std::size_t next = (i + 1) % n;
    const double chord = (tips[next] - tips[i]).norm();
    for (std::size_t k = 0; k < kFinePerSegment; ++k) {
      const double t = static_cast<double>(k) / kFinePerSegment;
      fine_.push_back({hermite(tips[i], slopes[i], tips[next], slopes[next], chord, t),
                       ((1.0 - t) * from.axis + t * to.axis).normalized(), (1.0 - t) * from.depth_mm + t * to.depth_mm,
                       from.speed_mm_s});
    }
  }
  const Waypoint& last = is_closed_ ? path.waypoints.front() : path.waypoints.back();
  fine_.push_back({is_closed_ ? tips.front() : tips.back(), last.axis, last.depth_mm, last.speed_mm_s});
  arc_mm_.push_back(0.0);
  for (std::size_t i = 1; i < fine_.size(); ++i)
    arc_mm_.push_back(arc_mm_.back() + (fine_[i].tip_mm - fine_[i - 1].tip_mm).norm());
}

TipSample TipCurve::at(double arc_mm) const {
  if (is_closed_ && arc_mm > length_mm()) arc_mm = std::fmod(arc_mm, length_mm());
  const auto after = std::upper_bound(arc_mm_.begin() + 1, arc_mm_.end() - 1, arc_mm);
  const auto i = static_cast<std::size_t>(after - arc_mm_.begin());
  const double t = std::min(1.0, (arc_mm - arc_mm_[i - 1]) / (arc_mm_[i] - arc_mm_[i - 1]));
  const TipSample& a = fine_[i - 1];
  const TipSample& b = fine_[i];
  return {(1.0 - t) * a.tip_mm + t * b.tip_mm, ((1.0 - t) * a.axis + t * b.axis).normalized(),
          (1.0 - t) * a.depth_mm + t * b.depth_mm, a.speed_mm_s};
}

double TipCurve::chord_error_mm(std::size_t moves) const {
  const double spacing = length_mm() / static_cast<double>(moves);
  double worst = 0.0;
  std::size_t fine = 0;
  for (std::size_t move = 0; move < moves; ++move) {
    const double end = spacing * static_cast<double>(move + 1);
    const Vec3 a = at(spacing * static_cast<double>(move)).tip_mm, b = at(std::min(end, length_mm())).tip_mm;
    for (; fine < fine_.size() && arc_mm_[fine] <= end; ++fine) {
      worst = std::max(worst, distance_to_segment(fine_[fine].tip_mm, a, b));
    }
  }
  return worst;
}

}  // namespace incise::robot_detail
