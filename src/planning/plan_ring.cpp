#include "planning/surface_walk.hpp"

#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/evaluation/level_loop.hpp>
#include <incise/planning/plan_path.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

constexpr double kGridMm = 0.25;
constexpr double kMarginToleranceMm = 0.01;
constexpr int kOffsetBisections = 48;
constexpr double kFirstStepMm = 0.01;  // of the search for a waypoint's bracket, doubled each time
constexpr int kMostDoublings = 7;

[[noreturn]] void throw_outside(double margin_mm, const Vec3& where, const std::string& why) {
  throw CaseError("plan", "lateral_margin_mm",
                  fmt::format("{:g}, a path outside the tissue: at {} mm {}", margin_mm, in_words(where), why),
                  "a ring that stays on the surface, seen along the approach",
                  "The tissue's rim, a fold, or another body over the tissue, such as the palate, is too close to "
                  "the tumour's edge. Use a smaller margin, or remove what is not the specimen with the brush "
                  "(ct.edits)");
}

/// The margin as a function of the place in the picture: f = distance of the surface there from the tumour edge −
/// margin. A flat offset would lie too far out wherever the surface slopes.
class MarginField {
 public:
  MarginField(const SurfaceView& view, const Contour& edge, double margin_mm)
      : view_(view), edge_(edge), margin_(margin_mm) {}

  [[nodiscard]] double operator()(const Vec2& place) const {
    const std::optional<SurfacePoint> seen = view_.at(place);
    if (!seen) return std::numeric_limits<double>::quiet_NaN();
    return nearest_on(edge_, seen->position_mm).distance_mm - margin_;
  }

  /// Unit direction in the picture from the tumour edge to a place.
  [[nodiscard]] Vec2 outward(const Vec2& place) const {
    const std::optional<SurfacePoint> seen = view_.at(place);
    if (!seen) return Vec2::Zero();
    return (place - view_.place_of(nearest_on(edge_, seen->position_mm).position_mm)).stableNormalized();
  }

 private:
  const SurfaceView& view_;
  const Contour& edge_;
  double margin_;
};

/// Moves a place outwards or inwards until it has the margin; nullopt if there is none within about a millimetre.
std::optional<Vec2> bring_to_margin(const Vec2& place, const MarginField& field) {
  const double start = field(place);
  if (start == 0.0) return place;
  const Vec2 direction = (start > 0.0 ? -1.0 : 1.0) * field.outward(place);
  double far = kFirstStepMm;
  for (int n = 0; n < kMostDoublings && !(field(place + far * direction) * start <= 0.0); ++n) far *= 2.0;
  if (!(field(place + far * direction) * start <= 0.0)) return std::nullopt;
  double near = 0.0;
  for (int n = 0; n < kOffsetBisections; ++n) {
    const double middle = 0.5 * (near + far);
    (field(place + middle * direction) * start > 0.0 ? near : far) = middle;
  }
  return place + 0.5 * (near + far) * direction;
}

/// Traces the closed curve of equal margin densely on the surface.
Contour margin_curve(const SurfaceView& view, const Contour& edge, const MarginField& field, double margin_mm) {
  const ViewFrame& frame = view.frame();
  const auto rightmost = std::max_element(edge.points.begin(), edge.points.end(), [&](const Vec3& a, const Vec3& b) {
    return frame.x.dot(a) < frame.x.dot(b);
  });
  const Vec2 inside = view.place_of(*rightmost);
  if (!(field(inside) < 0.0)) throw_outside(margin_mm, *rightmost, "the tumour edge itself is not on the surface");
  // A distance in space is never shorter than in the picture, so the search reaches every place at the margin.
  const LevelLoop loop = trace_level_loop(field, inside, margin_mm, std::min(kGridMm, 0.25 * margin_mm));
  const auto in_space = [&](const Vec2& place) {
    const std::optional<SurfacePoint> seen = view.at(place);
    return seen ? seen->position_mm : frame.from_view(Vec3(place.x(), place.y(), frame.z.dot(*rightmost)));
  };
  if (loop.undefined_at) throw_outside(margin_mm, in_space(*loop.undefined_at), "the surface ends");
  Contour curve{.points = {}, .is_closed = true};
  for (const Vec2& place : loop.points) {
    curve.points.push_back(in_space(place));
    if (!(std::abs(field(place)) <= kMarginToleranceMm))
      throw_outside(margin_mm, curve.points.back(), "the surface is folded");
  }
  return curve;
}

bool is_direction(const Vec3& v) {
  return v.allFinite() && v.norm() > 0.0;
}

}  // namespace

std::vector<Problem> validate(const PlanSettings& s) {
  std::vector<Problem> violations = problems_of(s);
  const int least = s.kind == PlanKind::Ring ? 8 : 2;
  Expect{violations}(s.waypoints >= least, "waypoints", s.waypoints,
                     fmt::format("at least {} for a {}", least, to_string(s.kind)));
  if (is_direction(s.approach) && is_direction(s.start_direction) &&
      s.approach.normalized().cross(s.start_direction.normalized()).norm() < 1e-3) {
    violations.push_back({"start_direction", "the direction of the approach", "a direction across the approach"});
  }
  return violations;
}

ToolPath plan_ring(const SurfaceQuery& surface, const Contour& tumor_edge, const PlanSettings& settings) {
  require_none(validate(settings));
  INCISE_REQUIRE(settings.kind == PlanKind::Ring, "expected settings of a ring, found those of a line");
  INCISE_REQUIRE(tumor_edge.is_closed && tumor_edge.points.size() >= 3,
                 "expected a closed tumour edge of at least 3 points");

  const SurfaceView view(surface, settings.approach);
  ToolPath path;
  path.tumor_edge = counter_clockwise(tumor_edge, settings.approach);
  const MarginField field(view, path.tumor_edge, settings.lateral_margin_mm);
  const Contour curve = margin_curve(view, path.tumor_edge, field, settings.lateral_margin_mm);
  const Contour even =
      resample(start_farthest_along(curve, settings.start_direction), static_cast<std::size_t>(settings.waypoints));

  // Even spacing moved the points off the curve by the height of a chord. Move them back onto it.
  Contour entries{.points = {}, .is_closed = true};
  for (const Vec3& p : even.points) {
    const std::optional<Vec2> place = bring_to_margin(view.place_of(p), field);
    if (!place || !(std::abs(field(*place)) <= kMarginToleranceMm))
      throw_outside(settings.lateral_margin_mm, p, "the margin cannot be kept");
    entries.points.push_back(view.at(*place)->position_mm);
  }
  entries = start_farthest_along(entries, settings.start_direction);
  for (const Vec3& p : entries.points) {
    path.waypoints.push_back({.position_mm = p,
                              .axis = view.tool_axis(view.place_of(p), settings.axis_mode),
                              .depth_mm = settings.depth_mm,
                              .speed_mm_s = settings.speed_mm_s});
  }
  check_path_as({"plan", "lateral_margin_mm", "depth_mm"}, path, surface, settings.approach, settings.rim_clearance_mm);
  return path;
}

}  // namespace incise
