#include <incise/calibration/picture_match.hpp>
#include <incise/core/error.hpp>
#include <incise/core/units.hpp>

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace incise {
namespace {

constexpr std::size_t kEdgePoints = 90;
constexpr double kCoarseStepDeg = 2.0;
constexpr double kFineStepDeg = 0.1;
constexpr double kBetterBy = 2.0;  // a mirror image or a far turn has to fit this much better

/// Returns an edge about its own centroid, in the view along the approach. @param middle  is set to that centroid.
Contour centred_in_view(const Contour& edge, const Vec3& approach, Vec2& middle) {
  INCISE_REQUIRE(edge.is_closed && edge.points.size() >= 3,
                 fmt::format("expected a closed tumour edge of at least 3 points, found {}", edge.points.size()));
  Contour flat = resample(flat_in_view(edge, view_along(approach)), kEdgePoints);
  const Vec3 centre = curve_centroid(flat);
  for (Vec3& p : flat.points) p -= centre;
  middle = centre.head<2>();
  return flat;
}

Contour turned(const Contour& edge, double degrees) {
  const Eigen::AngleAxisd turn(units::rad_from_deg(degrees), Vec3::UnitZ());
  Contour result = edge;
  for (Vec3& p : result.points) p = turn * p;
  return result;
}

/// Root mean square of the distances in both directions.
double rms_between(const Contour& a, const Contour& b) {
  double squares = 0.0;
  for (const Vec3& p : a.points) squares += std::pow(nearest_on(b, p).distance_mm, 2);
  for (const Vec3& p : b.points) squares += std::pow(nearest_on(a, p).distance_mm, 2);
  return std::sqrt(squares / static_cast<double>(a.points.size() + b.points.size()));
}

struct Turn {
  double degrees = 0.0;
  double rms_mm = std::numeric_limits<double>::infinity();
};

/// Finds the turn of least cost in a range. @param prior_weight  mm² per degree²
Turn best_turn(const Contour& photographed, const Contour& simulated, double from, double to, double step,
               double prior_weight) {
  Turn best;
  double least = std::numeric_limits<double>::infinity();
  const auto steps = static_cast<int>(std::round((to - from) / step));
  for (int i = 0; i <= steps; ++i) {
    const double degrees = from + i * step;
    const double rms = rms_between(turned(photographed, degrees), simulated);
    const double cost = rms * rms + prior_weight * degrees * degrees;
    if (cost < least) {
      least = cost;
      best = {degrees, rms};
    }
  }
  return best;
}

Contour mirrored(Contour edge) {
  for (Vec3& p : edge.points) p.x() = -p.x();
  std::reverse(edge.points.begin(), edge.points.end());
  return edge;
}

}  // namespace

PictureMatch match_picture(const Contour& photographed, const Vec3& photo_approach, const Contour& simulated,
                           const Vec3& approach, const PictureMatchSettings& settings) {
  INCISE_REQUIRE(settings.turn_sd_deg > 0.0 && settings.edge_sd_mm > 0.0 && settings.most_turn_deg > 0.0 &&
                     settings.most_turn_deg < 180.0,
                 "expected deviations above 0 and a greatest turn in (0, 180) degrees");
  Vec2 from = Vec2::Zero();
  Vec2 to = Vec2::Zero();
  const Contour seen = centred_in_view(photographed, photo_approach, from);
  const Contour made = centred_in_view(simulated, approach, to);
  // The distances along an edge of some 60 mm are worth about ten independent ones.
  constexpr double kPlaces = 10.0;
  const double prior = std::pow(settings.edge_sd_mm / settings.turn_sd_deg, 2) / kPlaces;
  Turn best = best_turn(seen, made, -settings.most_turn_deg, settings.most_turn_deg, kCoarseStepDeg, prior);
  best = best_turn(seen, made, best.degrees - kCoarseStepDeg, best.degrees + kCoarseStepDeg, kFineStepDeg, prior);
  PictureMatch match{best.degrees, to - from, best.rms_mm, false, {}};
  match.is_doubtful = best.rms_mm > settings.edge_sd_mm || std::abs(best.degrees) > settings.doubtful_turn_deg;
  if (best.rms_mm <= settings.edge_sd_mm) return match;
  const Turn far = best_turn(seen, made, -180.0, 180.0 - kCoarseStepDeg, kCoarseStepDeg, 0.0);
  const Turn mirror = best_turn(mirrored(seen), made, -180.0, 180.0 - kCoarseStepDeg, kCoarseStepDeg, 0.0);
  const bool is_mirror_better = mirror.rms_mm < far.rms_mm;
  if (kBetterBy * std::min(far.rms_mm, mirror.rms_mm) > best.rms_mm) return match;
  match.objection =
      is_mirror_better
          ? fmt::format(
                "a tumour edge that fits the simulated one when it is mirrored ({:.2f} mm apart, but {:.2f} mm as "
                "photographed)",
                mirror.rms_mm, best.rms_mm)
          : fmt::format(
                "a tumour edge that fits the simulated one when it is turned by {:.0f} degrees ({:.2f} mm apart, "
                "but {:.2f} mm as photographed)",
                far.degrees, far.rms_mm, best.rms_mm);
  return match;
}

}  // namespace incise
