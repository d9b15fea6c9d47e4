#include "planning/surface_walk.hpp"

#include <incise/core/error.hpp>
#include <incise/planning/plan_path.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace {

constexpr double kLongestSegmentMm = 1.0;
/// A longer contour is not in mm, or not a contour of anything that we cut.
constexpr double kLongestContourMm = 1e4;

/// Words of a message about a drawn curve.
struct Words {
  const char* where;
  const char* field;
  const char* off_surface;
};
constexpr Words kEdgeWords{"tumor", "contour", "a tumour edge off the surface"};
constexpr Words kLineWords{"plan", "line", "a line off the surface"};

Vec3 lay_down(const Vec3& p, const std::string& name, const SurfaceQuery& surface, const Vec3& approach,
              double tolerance_mm, const Words& words) {
  const std::optional<SurfacePoint> seen = surface.seen_at(p, approach);
  const std::string expected = fmt::format("every point within {} mm of the surface along the approach", tolerance_mm);
  const std::string hint =
      "Is the curve in mm, LPS, and drawn on the configuration (rest or stretched) that the "
      "case states?";
  if (!seen) {
    throw CaseError(words.where, words.field,
                    fmt::format("{}: {} at {} mm is beside it", words.off_surface, name, in_words(p)), expected, hint);
  }
  if (std::abs(seen->distance_mm) > tolerance_mm) {
    throw CaseError(words.where, words.field,
                    fmt::format("{}: {} at {} mm lies {:.2f} mm {} it", words.off_surface, name, in_words(p),
                                std::abs(seen->distance_mm), seen->distance_mm > 0.0 ? "above" : "below"),
                    expected, hint);
  }
  return seen->position_mm;
}

void require_sound(const Contour& contour, const Vec3& approach, const Words& words) {
  const std::size_t least = contour.is_closed ? 3 : 2;
  if (contour.points.size() < least) {
    throw CaseError(words.where, words.field, fmt::format("{} points", contour.points.size()),
                    fmt::format("at least {}", least));
  }
  for (std::size_t i = 0; i < contour.points.size(); ++i) {
    if (contour.points[i].allFinite()) continue;
    throw CaseError(words.where, words.field, fmt::format("point {} with a coordinate that is not a number", i),
                    "finite numbers");
  }
  const double length = length_mm(contour);
  if (length <= 0.0 || length > kLongestContourMm) {
    throw CaseError(words.where, words.field, fmt::format("a length of {} mm", length),
                    fmt::format("a length in (0, {}] mm", kLongestContourMm));
  }
  if (contour.is_closed && std::abs(signed_area_mm2(contour, approach)) < 1e-6 * length * length) {
    throw CaseError(words.where, words.field, "a closed contour without an area, seen along the approach",
                    "an outline");
  }
  if (crosses_itself_in_view(contour, approach)) {
    throw CaseError(words.where, words.field, "a contour that crosses itself, seen along the approach",
                    "a simple curve");
  }
}

Contour project(const Contour& drawn, const SurfaceQuery& surface, const Vec3& approach, double tolerance_mm,
                const Words& words) {
  INCISE_REQUIRE(std::isfinite(tolerance_mm) && tolerance_mm >= 0.0,
                 fmt::format("expected a tolerance of 0 mm or more, found {}", tolerance_mm));
  require_sound(drawn, approach, words);
  Contour result{.points = {}, .is_closed = drawn.is_closed};
  const std::size_t n = drawn.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    result.points.push_back(
        lay_down(drawn.points[i], fmt::format("point {}", i), surface, approach, tolerance_mm, words));
    if (!drawn.is_closed && i + 1 == n) break;
    const Vec3& start = drawn.points[i];
    const Vec3& end = drawn.points[(i + 1) % n];
    const auto pieces = static_cast<int>(std::ceil((end - start).norm() / kLongestSegmentMm));
    const std::string name = fmt::format("the segment from point {} to {}", i, (i + 1) % n);
    for (int piece = 1; piece < pieces; ++piece) {
      // A chord under a bulging surface is drawn correctly although it lies deep: the tolerance applies only to its
      // ends.
      const Vec3 between = start + (end - start) * (static_cast<double>(piece) / pieces);
      result.points.push_back(lay_down(between, name, surface, approach, tolerance_mm + (end - start).norm(), words));
    }
  }
  return result;
}

}  // namespace

Contour project_tumor_edge(const Contour& edge, const SurfaceQuery& surface, const Vec3& approach,
                           double tolerance_mm) {
  return project({edge.points, true}, surface, approach, tolerance_mm, kEdgeWords);
}

Contour project_line(const Contour& line, const SurfaceQuery& surface, const Vec3& approach, double tolerance_mm) {
  return project({line.points, false}, surface, approach, tolerance_mm, kLineWords);
}

}  // namespace incise
