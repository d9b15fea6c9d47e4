#include "robot/tip_curve.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise::robot_detail {
namespace {

constexpr std::size_t kFinePerPiece = 64;  // chords this short deviate from the curve by less than 0.02 mm / 1000
constexpr double kLeastGapMm = 1e-3;

}  // namespace

SegmentPlace nearest_on_segment(const Vec3& p, const Vec3& begin, const Vec3& end) {
  const Vec3 along = end - begin;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((p - begin).dot(along) / length2, 0.0, 1.0) : 0.0;
  return {t, (p - begin - t * along).norm()};
}

std::vector<TipCurve::Knot> TipCurve::knots(const std::vector<Vec3>& values, const std::vector<double>& chords,
                                            bool is_closed) {
  const std::size_t n = values.size();
  std::vector<Knot> result(n);
  for (std::size_t i = 0; i < n; ++i) {
    result[i] = {values[i], Vec3::Zero(), Vec3::Zero()};
    if (!is_closed && (i == 0 || i + 1 == n)) continue;
    const double before = chords[(i + n - 1) % n], after = chords[i];
    const Vec3 in = (values[i] - values[(i + n - 1) % n]) / before, out = (values[(i + 1) % n] - values[i]) / after;
    result[i].slope = (after * in + before * out) / (before + after);
    result[i].bend = 2.0 * (out - in) / (before + after);
  }
  if (!is_closed && n == 2) {
    result[0].slope = result[1].slope = (values[1] - values[0]) / chords[0];
  } else if (!is_closed) {
    // At an end, the parabola through the last three points.
    result[0].bend = result[1].bend;
    result[0].slope = result[1].slope - chords[0] * result[1].bend;
    result[n - 1].bend = result[n - 2].bend;
    result[n - 1].slope = result[n - 2].slope + chords[n - 2] * result[n - 2].bend;
  }
  return result;
}

Vec3 TipCurve::value(const Knot& a, const Knot& b, double h, double t) {
  const double t2 = t * t, t3 = t2 * t, t4 = t3 * t, t5 = t4 * t;
  return (1 - 10 * t3 + 15 * t4 - 6 * t5) * a.value + (t - 6 * t3 + 8 * t4 - 3 * t5) * h * a.slope +
         (t2 - 3 * t3 + 3 * t4 - t5) / 2 * h * h * a.bend + (t3 - 2 * t4 + t5) / 2 * h * h * b.bend +
         (-4 * t3 + 7 * t4 - 3 * t5) * h * b.slope + (10 * t3 - 15 * t4 + 6 * t5) * b.value;
}

Vec3 TipCurve::slope(const Knot& a, const Knot& b, double h, double t) {
  const double t2 = t * t, t3 = t2 * t, t4 = t3 * t;
  return (-30 * t2 + 60 * t3 - 30 * t4) * (a.value - b.value) + (1 - 18 * t2 + 32 * t3 - 15 * t4) * h * a.slope +
         (2 * t - 9 * t2 + 12 * t3 - 5 * t4) / 2 * h * h * a.bend + (3 * t2 - 8 * t3 + 5 * t4) / 2 * h * h * b.bend +
         (-12 * t2 + 28 * t3 - 15 * t4) * h * b.slope;
}

TipSample TipCurve::sample(std::size_t piece, double t) const {
  const Piece& p = pieces_[piece];
  return {value(p.tip_from, p.tip_to, p.chord_mm, t), value(p.axis_from, p.axis_to, p.chord_mm, t).normalized(),
          (1.0 - t) * p.depth_from_mm + t * p.depth_to_mm, p.speed_mm_s, piece};
}

TipCurve::TipCurve(const ToolPath& path) : is_closed_(path.is_closed) {
  const std::size_t n = path.waypoints.size();
  std::vector<Vec3> tips, axes;
  for (const Waypoint& waypoint : path.waypoints) {
    tips.push_back(waypoint.position_mm + waypoint.depth_mm * waypoint.axis);
    axes.push_back(waypoint.axis);
  }
  const std::size_t pieces = is_closed_ ? n : n - 1;
  std::vector<double> chords(n);
  for (std::size_t i = 0; i < pieces; ++i) {
    chords[i] = (tips[(i + 1) % n] - tips[i]).norm();
    INCISE_REQUIRE(
        chords[i] > kLeastGapMm,
        fmt::format("expected tips more than {} mm apart, found {} mm after waypoint {}", kLeastGapMm, chords[i], i));
  }
  const auto tip_knots = knots(tips, chords, is_closed_), axis_knots = knots(axes, chords, is_closed_);
  for (std::size_t i = 0; i < pieces; ++i) {
    const std::size_t next = (i + 1) % n;
    pieces_.push_back({tip_knots[i], tip_knots[next], axis_knots[i], axis_knots[next], chords[i],
                       path.waypoints[i].depth_mm, path.waypoints[next].depth_mm, path.waypoints[i].speed_mm_s});
  }
  // Arc length by Simpson's rule over each short interval.
  double arc = 0.0;
  for (std::size_t i = 0; i < pieces; ++i) {
    const auto rate = [this, i](double t) {
      const Piece& p = pieces_[i];
      return slope(p.tip_from, p.tip_to, p.chord_mm, t).norm();
    };
    for (std::size_t k = 0; k < kFinePerPiece; ++k) {
      const double step = 1.0 / kFinePerPiece, t = step * static_cast<double>(k);
      fine_.push_back({arc, 1.0 / rate(t), 1.0 / rate(t + step), sample(i, t).tip_mm});
      arc += step / 6.0 * (rate(t) + 4.0 * rate(t + 0.5 * step) + rate(t + step));
    }
  }
  fine_.push_back({arc, 0.0, 0.0, sample(pieces - 1, 1.0).tip_mm});
}

double TipCurve::arc_at_waypoint(std::size_t i) const {
  return fine_[i * kFinePerPiece].arc_mm;
}

TipSample TipCurve::at(double arc_mm) const {
  if (is_closed_ && arc_mm > length_mm()) arc_mm = std::fmod(arc_mm, length_mm());
  arc_mm = std::clamp(arc_mm, 0.0, length_mm());
  const auto after = std::upper_bound(fine_.begin() + 1, fine_.end() - 1, arc_mm,
                                      [](double arc, const Fine& fine) { return arc < fine.arc_mm; });
  const auto i = static_cast<std::size_t>(after - fine_.begin()) - 1;
  const Fine &a = fine_[i], &b = fine_[i + 1];
  const double span = b.arc_mm - a.arc_mm, u = (arc_mm - a.arc_mm) / span;
  // The parameter is a cubic of the arc length with the right slopes, so the tip's speed is continuous.
  const std::size_t piece = i / kFinePerPiece;
  const auto k = static_cast<double>(i - piece * kFinePerPiece);
  const double u2 = u * u, u3 = u2 * u;
  const double t = (k + 3 * u2 - 2 * u3) / kFinePerPiece + (u3 - 2 * u2 + u) * span * a.t_per_mm +
                   (u3 - u2) * span * a.t_per_mm_at_end;
  return sample(piece, t);
}

double TipCurve::chord_error_mm(std::size_t moves) const {
  const double spacing = length_mm() / static_cast<double>(moves);
  double worst = 0.0;
  std::size_t fine = 0;
  for (std::size_t move = 0; move < moves; ++move) {
    const double end = spacing * static_cast<double>(move + 1);
    const Vec3 a = at(spacing * static_cast<double>(move)).tip_mm, b = at(std::min(end, length_mm())).tip_mm;
    for (; fine < fine_.size() && fine_[fine].arc_mm <= end; ++fine)
      worst = std::max(worst, nearest_on_segment(fine_[fine].tip_mm, a, b).distance_mm);
  }
  return worst;
}

}  // namespace incise::robot_detail
