#include "kerf.hpp"

#include <incise/geometry/surface_query.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace incise {
namespace {

constexpr double kOnSkinMm = 1.0;       // greatest distance of live tissue from a curve on the skin that it carries
constexpr double kAcrossStepMm = 0.25;  // step of the search for tissue across a gap, and its tolerance
constexpr double kDirectionMm =
    2.0;  // to either side: length over which a mid-line's direction is taken, free of the mesh's grain
constexpr double kBelowSkinMm = 0.5;  // depth of that search: within the tets of the skin

/// The triangles with the vertices that they use, in order of first use.
TriMesh with_own_vertices(std::span<const BoundaryFace> faces, std::span<const Vec3> positions) {
  TriMesh surface;
  std::vector<VertexId> place(positions.size());
  for (const BoundaryFace& face : faces) {
    Triangle triangle = face.corners;
    for (VertexId& corner : triangle) {
      VertexId& known = place[corner.index()];
      if (!known.is_valid()) {
        known = VertexId(surface.vertices.size());
        surface.vertices.push_back(positions[corner.index()]);
      }
      corner = known;
    }
    surface.triangles.push_back(triangle);
  }
  return surface;
}

std::vector<Triangle> corners_of_faces(std::span<const BoundaryFace> faces) {
  std::vector<Triangle> triangles;
  triangles.reserve(faces.size());
  for (const BoundaryFace& face : faces) triangles.push_back(face.corners);
  return triangles;
}

}  // namespace

KerfBody kerf_body(const TetMesh& mesh, std::span<const Vec3> stretched, std::span<const std::uint8_t> is_live) {
  std::vector<std::uint8_t> is_gone(is_live.size());
  std::transform(is_live.begin(), is_live.end(), is_gone.begin(), [](std::uint8_t live) { return live == 0 ? 1 : 0; });
  KerfBody body;
  body.surface = with_own_vertices(boundary_faces(mesh, is_gone), stretched);
  body.volume_mm3 = enclosed_volume_mm3(body.surface);
  body.boundary = manifoldness_of(body.surface.triangles);
  body.live_skin = manifoldness_of(corners_of_faces(boundary_faces(mesh, is_live)));
  return body;
}

KerfLayer kerf_layer(const KerfInput& kerf, const ToolPath& path, double depth_mm) {
  double planned_mm = 0.0;
  for (const Waypoint& waypoint : path.waypoints) planned_mm = std::max(planned_mm, waypoint.depth_mm);
  KerfLayer layer;
  layer.depth_mm = depth_mm;
  layer.is_within_plan = depth_mm <= planned_mm;
  if (!layer.is_within_plan) return layer;
  KerfMidlineSettings midline;
  midline.layer_top_mm = depth_mm - 0.5 * kLayerThicknessMm;
  midline.layer_bottom_mm = depth_mm + 0.5 * kLayerThicknessMm;
  KerfMidline found = midline_contour(kerf, midline);
  if (path.is_closed) {
    layer.is_closed = found.is_closed;
    if (!found.is_closed && std::isfinite(found.gap_mm)) layer.gap_mm = found.gap_mm;
    if (found.gap_place_mm) layer.gap_place_mm = *found.gap_place_mm + depth_mm * kerf.approach;
  }
  layer.width_mm = found.mean_width_mm;
  layer.centerline = std::move(found.contour);
  if (!layer.centerline) return layer;
  for (Vec3& p : layer.centerline->points) p += depth_mm * kerf.approach;
  return layer;
}

LiveDisplacement displacement_of_live(const TetMesh& mesh, std::span<const std::uint8_t> is_live,
                                      std::span<const Vec3> from, std::span<const Vec3> to) {
  auto live = std::make_shared<TetMesh>();
  live->vertices.assign(from.begin(), from.end());
  for (std::size_t tet = 0; tet < mesh.tets.size(); ++tet) {
    if (is_live[tet] != 0) live->tets.push_back(mesh.tets[tet]);
  }
  if (live->tets.empty()) return [](const Vec3&, double) { return std::nullopt; };
  const auto locator = std::make_shared<const TetLocator>(*live, from);
  return [live, locator, from, to](const Vec3& p, double tolerance_mm) -> std::optional<Vec3> {
    const auto point = locator->locate(p, tolerance_mm);
    if (!point) return std::nullopt;
    return position_of(*point, *live, to) - position_of(*point, *live, from);
  };
}

std::optional<Contour> carried_with_live(const Contour& curve, double reach_mm, const Vec3& approach,
                                         const TriMesh& surface, const LiveDisplacement& displacement) {
  const SurfaceQuery skin(surface);  // uncut: the search across the gap follows its slope
  const auto first_across = [&](const Vec3& p, const Vec3& direction) -> std::optional<Vec3> {
    for (double s = 0.0; s <= reach_mm; s += kAcrossStepMm) {
      const auto seen = skin.seen_at(p + s * direction, approach);
      if (!seen) continue;
      if (const auto u = displacement(seen->position_mm + kBelowSkinMm * approach, kAcrossStepMm)) return u;
    }
    return std::nullopt;
  };
  const std::size_t n = curve.points.size();
  const std::size_t apart =
      std::min(n / 8, static_cast<std::size_t>(kDirectionMm / length_mm(curve) * static_cast<double>(n))) + 1;
  Contour moved{{}, curve.is_closed};
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3& p = curve.points[i];
    if (reach_mm == 0.0) {
      const auto u = displacement(p, kOnSkinMm);
      if (!u) return std::nullopt;
      moved.points.push_back(p + *u);
      continue;
    }
    const std::size_t before = curve.is_closed ? (i + n - apart) % n : i - std::min(i, apart);
    const std::size_t after = curve.is_closed ? (i + apart) % n : std::min(i + apart, n - 1);
    const Vec3 left = -approach.cross(curve.points[after] - curve.points[before]).normalized();
    const auto on_left = first_across(p, left);
    const auto on_right = first_across(p, -left);
    if (!on_left || !on_right) return std::nullopt;
    moved.points.push_back(p + 0.5 * (*on_left + *on_right));
  }
  return moved;
}

}  // namespace incise
