#include "geometry/kerf_picture.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/gaussian.hpp>
#include <incise/geometry/kerf_contours.hpp>
#include <incise/geometry/morphology.hpp>
#include <incise/geometry/surface_query.hpp>
#include <incise/geometry/tracing.hpp>

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <functional>

namespace incise {
namespace {

/// Width of the strip of skin in the picture around the kerf, mm: shows the plug and the skin outside apart.
constexpr double kSkinBorderMm = 2.0;

/// Radius within which a plane is fitted to the plug's skin to read its height, mm.
constexpr double kHeightReachMm = 0.6;

void require_valid(const Vec3& inside_mm, const InnerEdgeSettings& settings) {
  INCISE_REQUIRE(inside_mm.allFinite(), "the point inside is not finite");
  INCISE_REQUIRE(std::isfinite(settings.spacing_mm) && settings.spacing_mm > 0.0,
                 fmt::format("expected a spacing above 0 mm, found {}", settings.spacing_mm));
}

void require_valid(const CutSurface& surface, const InnerEdgeSettings& settings) {
  INCISE_REQUIRE(surface.is_skin.size() == surface.triangles.size(),
                 fmt::format("expected a flag for each of {} triangles, found {}", surface.triangles.size(),
                             surface.is_skin.size()));
  require_valid(surface.inside_mm, settings);
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    INCISE_REQUIRE(surface.vertices[i].allFinite(), fmt::format("vertex {} is not finite", i));
  }
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const VertexId id : surface.triangles[t]) {
      INCISE_REQUIRE(
          id.is_valid() && id.index() < surface.vertices.size(),
          fmt::format("triangle {} names vertex {}, expected one of {}", t, id.value, surface.vertices.size()));
    }
  }
}

/// Returns the picture of the kerf and a strip of skin around it; nullopt without a kerf.
std::optional<DepthBuffer> picture_of(const CutSurface& surface, const Points& in_view, double pixel_mm) {
  Box3 walls;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (surface.is_skin[t] != 0) continue;
    for (const VertexId id : surface.triangles[t]) walls.extend(vertex(in_view, id));
  }
  if (walls.isEmpty()) return std::nullopt;
  const RasterGrid grid = grid_around(walls.min().head<2>(), walls.max().head<2>(), pixel_mm, kSkinBorderMm);
  return depth_buffer(grid, in_view, surface.triangles);
}

Raster visible_skin(const DepthBuffer& picture, const CutSurface& surface) {
  return set_where(picture, [&](std::size_t p) {
    const std::int32_t triangle = picture.triangles[p];
    return triangle >= 0 && surface.is_skin[static_cast<std::size_t>(triangle)] != 0;
  });
}

/// Whether the plug extends to the body's silhouette: it borders on empty pixels that continue to the picture's border.
bool borders_on_outside(const Raster& plug, const DepthBuffer& picture, double reach_mm) {
  const Raster empty = set_where(picture, [&](std::size_t p) { return picture.triangles[p] < 0; });
  const Components parts = find_components(empty, 1, Connectivity::Eight);
  const Raster around = dilated(plug, reach_mm);
  for (std::size_t p = 0; p < around.pixels.size(); ++p) {
    const std::int32_t part = parts.labels[p];
    if (around.pixels[p] != 0 && part >= 0 && parts.parts[static_cast<std::size_t>(part)].touches_border) return true;
  }
  return false;
}

/// Returns the connected skin around the point inside, without holes; nullopt if it is connected to the skin outside.
std::optional<Raster> plug_of(const DepthBuffer& picture, const CutSurface& surface, const Vec2& inside,
                              const InnerEdgeSettings& settings) {
  const Raster skin = visible_skin(picture, surface);
  // Closing first mends slits in the skin; opening then cuts strips that would join the plug to the outside.
  const Raster mended = opened(closed(skin, settings.closing_mm), settings.opening_mm);
  const auto [i, j] = picture.pixel_near(inside);
  if (!picture.contains(i, j)) return std::nullopt;
  const Components parts = find_components(mended, 1, Connectivity::Four);
  const std::int32_t part = parts.labels[picture.offset(i, j)];
  if (part < 0 || parts.parts[static_cast<std::size_t>(part)].touches_border) return std::nullopt;
  const Raster plug = holes_filled(part_of(mended, parts, part),
                                   picture.pixel_mm * picture.pixel_mm * static_cast<double>(picture.pixel_count()));
  if (borders_on_outside(plug, picture, settings.opening_mm + 2.0 * settings.pixel_mm)) return std::nullopt;
  return plug;
}

/// Returns the height of the plug's skin at a point of its edge, mm: on a plane fitted to the pixels around it, because
/// they all lie on one side.
std::optional<double> skin_height(const Raster& plug, const DepthBuffer& picture, const CutSurface& surface,
                                  const Vec2& p) {
  const int reach = static_cast<int>(std::ceil(kHeightReachMm / plug.pixel_mm));
  const auto [ci, cj] = plug.pixel_near(p);
  Mat3 normal_matrix = Mat3::Zero();
  Vec3 right_side = Vec3::Zero();
  int count = 0;
  for (int j = cj - reach; j <= cj + reach; ++j) {
    for (int i = ci - reach; i <= ci + reach; ++i) {
      if (!plug.contains(i, j) || plug.at(i, j) == 0) continue;
      const std::int32_t triangle = picture.triangles[plug.offset(i, j)];
      if (triangle < 0 || surface.is_skin[static_cast<std::size_t>(triangle)] == 0) continue;
      const Vec2 offset = (plug.centre(i, j) - p) / kHeightReachMm;
      if (offset.norm() > 1.0) continue;
      const Vec3 row(offset.x(), offset.y(), 1.0);
      normal_matrix += row * row.transpose();
      right_side += picture.heights_mm[plug.offset(i, j)] * row;
      ++count;
    }
  }
  if (count == 0) return std::nullopt;
  // Few pixels do not determine the slope: with a weak pull to zero slope, the result is their mean.
  normal_matrix(0, 0) += 1e-3;
  normal_matrix(1, 1) += 1e-3;
  return normal_matrix.ldlt().solve(right_side).z();
}

/// Returns the outline of the plug, at the height of its skin.
std::optional<Contour> edge_of(const Raster& plug, const ViewFrame& view, const InnerEdgeSettings& settings,
                               const std::function<std::optional<double>(const Vec2&)>& height_at) {
  std::optional<Contour> outline;
  for (Contour& line : level_lines(blurred(plug, settings.smoothing_mm), 0.5)) {
    if (!outline || length_mm(line) > length_mm(*outline)) outline = std::move(line);
  }
  if (!outline) return std::nullopt;
  Contour edge;
  for (const Vec3& p : outline->points) {
    const std::optional<double> height = height_at(p.head<2>());
    if (height) edge.points.push_back(view.from_view({p.x(), p.y(), *height}));
  }
  if (edge.points.size() < 3 || length_mm(edge) == 0.0) return std::nullopt;
  return start_farthest_along(counter_clockwise(evenly_spaced(edge, settings.spacing_mm), -view.z), view.x);
}

}  // namespace

std::optional<Contour> inner_edge_contour(const CutSurface& surface, const InnerEdgeSettings& settings) {
  require_valid(surface, settings);
  const ViewFrame view = view_along(surface.approach);
  const std::optional<DepthBuffer> picture =
      picture_of(surface, points_in_view(surface.vertices, view), settings.pixel_mm);
  if (!picture) return std::nullopt;
  const std::optional<Raster> plug = plug_of(*picture, surface, view.to_view(surface.inside_mm).head<2>(), settings);
  if (!plug) return std::nullopt;

  return edge_of(*plug, view, settings, [&](const Vec2& p) { return skin_height(*plug, *picture, surface, p); });
}

std::optional<Contour> inner_edge_contour(const KerfInput& kerf, const KerfMidlineSettings& layer,
                                          const InnerEdgeSettings& settings) {
  require_valid(kerf.inside_mm, settings);
  const ViewFrame view = view_along(kerf.approach);
  const std::optional<KerfPicture> picture = kerf_picture(kerf, view, layer);
  if (!picture) return std::nullopt;
  const std::optional<Raster> plug = enclosed_tissue(picture->mask, view.to_view(kerf.inside_mm).head<2>());
  if (!plug) return std::nullopt;
  const SurfaceQuery skin(kerf.surface);
  return edge_of(*plug, view, settings, [&](const Vec2& p) -> std::optional<double> {
    const auto seen = skin.seen_at(view.from_view({p.x(), p.y(), 0.0}), -view.z);
    if (!seen) return std::nullopt;
    return view.to_view(seen->position_mm).z();
  });
}

}  // namespace incise
