#include "planning/surface_walk.hpp"

#include <incise/core/error.hpp>
#include <incise/planning/plan_path.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace {

constexpr double kOffSurfaceMm = 2.0;

void require_numbers(const PathCheckWords& words, const ToolPath& path) {
  const std::size_t least = path.is_closed ? 8 : 2;
  if (path.waypoints.size() < least) {
    throw CaseError(words.where, words.course_field, fmt::format("{} waypoints", path.waypoints.size()),
                    fmt::format("at least {} for {} path", least, path.is_closed ? "a closed" : "an open"));
  }
  for (std::size_t i = 0; i < path.waypoints.size(); ++i) {
    const Waypoint& w = path.waypoints[i];
    const auto refuse = [&](const std::string& field, const std::string& found, const std::string& expected) {
      throw CaseError(words.where, field, fmt::format("{} at waypoint {}", found, i), expected);
    };
    if (!w.position_mm.allFinite()) refuse(words.course_field, "a position that is not a number", "finite numbers");
    if (!w.axis.allFinite() || std::abs(w.axis.norm() - 1.0) > 1e-6) {
      refuse(words.course_field, fmt::format("an axis of length {}", w.axis.norm()), "a unit vector");
    }
    if (!std::isfinite(w.depth_mm) || w.depth_mm <= 0.0) {
      refuse(words.depth_field, fmt::format("a depth of {} mm", w.depth_mm), "a depth above 0 mm");
    }
    if (!std::isfinite(w.speed_mm_s) || w.speed_mm_s <= 0.0) {
      refuse("speed_mm_s", fmt::format("a speed of {} mm/s", w.speed_mm_s), "a speed above 0 mm/s");
    }
  }
}

void require_on_tissue(const PathCheckWords& words, const ToolPath& path, const SurfaceQuery& surface,
                       const SurfaceView& view, double rim_clearance_mm) {
  for (std::size_t i = 0; i < path.waypoints.size(); ++i) {
    const Waypoint& w = path.waypoints[i];
    const auto refuse = [&](const std::string& why, const std::string& expected) {
      throw CaseError(
          words.where, words.course_field,
          fmt::format("a path outside the tissue: waypoint {} at {} mm {}", i, in_words(w.position_mm), why), expected);
    };
    const std::optional<SurfacePoint> seen = surface.seen_at(w.position_mm, view.approach());
    if (!seen) refuse("is beside the surface", "every waypoint on the tissue, seen along the approach");
    if (std::abs(seen->distance_mm) > kOffSurfaceMm) {
      refuse(fmt::format("lies {:.2f} mm {} the surface", std::abs(seen->distance_mm),
                         seen->distance_mm > 0.0 ? "above" : "below"),
             fmt::format("at most {} mm along the approach", kOffSurfaceMm));
    }
    if (!view.is_clear_of_rim(view.place_of(w.position_mm), rim_clearance_mm)) {
      refuse("is too close to the surface's rim",
             fmt::format("{} mm of surface all round, seen along the approach", rim_clearance_mm));
    }
    if (w.axis.dot(view.smooth_normal(view.place_of(w.position_mm))) >= 0.0) {
      refuse("has an axis that points out of the tissue", "an axis that points into it");
    }
  }
}

void require_enough_depth(const PathCheckWords& words, const ToolPath& path, const SurfaceQuery& surface,
                          const SurfaceView& view) {
  for (std::size_t i = 0; i < path.waypoints.size(); ++i) {
    const Waypoint& w = path.waypoints[i];
    const Vec3 entry = view.at(view.place_of(w.position_mm))->position_mm;
    const std::optional<double> thickness = thickness_mm(surface, entry, w.axis);
    if (!thickness) {
      throw CaseError(words.where, words.depth_field, fmt::format("a surface that is not closed under waypoint {}", i),
                      "the closed skin of the tissue");
    }
    if (w.depth_mm < *thickness) continue;
    throw CaseError(
        words.where, words.depth_field,
        fmt::format("a depth through the tissue: {} mm at waypoint {} at {} mm, where the tissue is {:.2f} mm thick",
                    w.depth_mm, i, in_words(w.position_mm), *thickness),
        "a depth that stays inside the tissue",
        "The tool would come out beneath. If this tissue is a thin flake over the specimen, remove it with "
        "the brush (ct.edits)");
  }
}

}  // namespace

void check_path_as(const PathCheckWords& words, const ToolPath& path, const SurfaceQuery& surface, const Vec3& approach,
                   double rim_clearance_mm) {
  INCISE_REQUIRE(std::isfinite(rim_clearance_mm) && rim_clearance_mm >= 0.0,
                 fmt::format("expected a rim clearance of 0 mm or more, found {}", rim_clearance_mm));
  const SurfaceView view(surface, approach);
  require_numbers(words, path);
  if (crosses_itself_in_view(entry_contour(path), approach)) {
    throw CaseError(words.where, words.course_field, "a path that crosses itself, seen along the approach",
                    "a simple curve");
  }
  require_on_tissue(words, path, surface, view, rim_clearance_mm);
  require_enough_depth(words, path, surface, view);
}

void check_path(const ToolPath& path, const SurfaceQuery& surface, const Vec3& approach, double rim_clearance_mm) {
  check_path_as({}, path, surface, approach, rim_clearance_mm);
}

}  // namespace incise
