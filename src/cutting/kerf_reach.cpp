#include "kerf.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/surface_query.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace incise {
namespace {

/// Least distances between the kerf and the tumour: in all, beside and beneath the tumour.
class Nearest {
 public:
  explicit Nearest(const Vec3& approach) : approach_(approach) {}

  /// @param outward  from the tumour's surface to the kerf or, for a place of the kerf inside the tumour, from that
  /// place to the surface.
  void add(const Vec3& outward, bool is_inside) {
    const double length = outward.norm();
    const double distance = is_inside ? -length : length;
    nearest = std::min(nearest, distance);
    const double down = outward.dot(approach_);
    std::optional<double>& part = down > (outward - down * approach_).norm() ? beneath : beside;
    part = std::min(part.value_or(distance), distance);
  }
  double nearest = std::numeric_limits<double>::infinity();
  std::optional<double> beside;
  std::optional<double> beneath;

 private:
  Vec3 approach_;
};

/// Planned depth of the tool's tip at the points of the profile, along the approach: linear between waypoints.
std::vector<double> planned_along(const ToolPath& path, const DepthProfile& profile, const Vec3& approach) {
  const std::size_t n = path.waypoints.size();
  const auto depth_of = [&](std::size_t i) {
    return path.waypoints[i % n].depth_mm * path.waypoints[i % n].axis.dot(approach);
  };
  const Contour entries = entry_contour(path);
  std::vector<double> planned;
  planned.reserve(profile.course.points.size());
  for (const Vec3& p : profile.course.points) {
    const ContourPoint at = nearest_on(entries, p);
    planned.push_back((1.0 - at.fraction) * depth_of(at.segment) + at.fraction * depth_of(at.segment + 1));
  }
  return planned;
}

}  // namespace

Spread spread_of(std::span<const double> values, std::span<const double> weights) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  double sum = 0.0, weight = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double own = weights.empty() ? 1.0 : weights[i];
    sum += own * values[i];
    weight += own;
  }
  return {sum / weight, *low, *high};
}

DepthReached depth_reached(const KerfInput& kerf, const ToolPath& path, const IncisionSettings& settings) {
  DepthReached result;
  for (const Waypoint& waypoint : path.waypoints) {
    result.planned_mm +=
        waypoint.depth_mm * waypoint.axis.dot(settings.approach) / static_cast<double>(path.waypoints.size());
  }
  KerfDepthSettings depth;
  depth.needle_diameter_mm = 2.0 * radius_mm(settings.tool);
  depth.pixel_mm = std::min(depth.pixel_mm, 0.25 * depth.needle_diameter_mm);
  depth.reach_mm = std::max(depth.reach_mm, depth.needle_diameter_mm);
  result.profile = depth_along(kerf, entry_contour(path), depth);
  result.planned_at_mm = planned_along(path, result.profile, settings.approach);
  result.depth_mm = spread_of(result.profile.depth_mm);
  return result;
}

void require_volume(const TriMesh& tumor_surface) {
  const double volume = enclosed_volume_mm3(tumor_surface);
  INCISE_REQUIRE(volume > 0.0, fmt::format("expected a tumour surface that encloses a volume, found {} mm³", volume));
}

std::optional<DeepMargin> deep_margin(const KerfBody& body, const DepthReached& depth,
                                      const IncisionSettings& settings) {
  const TriMesh& tumor = settings.tumor_surface;
  if (tumor.triangles.empty() || body.surface.triangles.empty()) return std::nullopt;
  require_volume(tumor);
  const Vec3& approach = settings.approach;
  const SurfaceQuery tumor_query(tumor);
  const SurfaceQuery kerf_query(body.surface);
  Nearest nearest(approach);
  for (const Vec3& p : body.surface.vertices) {
    const Vec3 from_tumor = p - tumor_query.nearest(p).position_mm;
    const bool is_inside = tumor_query.contains(p, approach);
    nearest.add(is_inside ? Vec3(-from_tumor) : from_tumor, is_inside);
  }
  // Corners of each surface against the faces of the other: a small tumour may face the middle of a wall.
  for (const Vec3& t : tumor.vertices) {
    if (kerf_query.contains(t, approach)) continue;  // the kerf's corners have shown this
    nearest.add(kerf_query.nearest(t).position_mm - t, false);
  }
  DeepMargin margin{nearest.nearest, nearest.beside, nearest.beneath, {}};
  double tumor_bottom = -std::numeric_limits<double>::infinity();
  for (const Vec3& t : tumor.vertices) tumor_bottom = std::max(tumor_bottom, t.dot(approach));
  std::vector<double> floors;
  for (std::size_t i = 0; i < depth.profile.depth_mm.size(); ++i) {
    floors.push_back(depth.profile.course.points[i].dot(approach) + depth.profile.depth_mm[i] - tumor_bottom);
  }
  margin.floor_below_mm = spread_of(floors);
  return margin;
}

}  // namespace incise
