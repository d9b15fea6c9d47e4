#pragma once

#include <incise/core/workers.hpp>
#include <incise/geometry/point_cloud.hpp>
#include <incise/geometry/tet_mesh.hpp>

namespace incise {

struct VisibleSurfaceSettings {
  Vec3 approach = -Vec3::UnitZ();  ///< direction of sight
  double spacing_mm = 1.0;         ///< least distance between two points; the mean one is about 1.3 times that
  double largest_tilt_deg = 80.0;  ///< (0, 90], between outward normal and observer; a camera hardly sees more
};

/// The part of a surface that a distant observer sees, as an even sample.
struct VisibleSurface {
  PointCloud cloud;       ///< with outward normals, interpolated between the vertices' (angle-weighted) ones
  double area_mm2 = 0.0;  ///< of the visible part, from dense samples: relative error about 1 / sqrt(10 · points)
};

/// Samples the visible part of a surface. Spreads samples evenly by area over the triangles that face the observer
/// within `largest_tilt_deg`, moves them onto the curved surface that the triangles approximate (exact for quadratics;
/// [Boubekeur2008]; along creases of more than 35 degrees the triangles stay flat), drops those that another part hides
/// (a ray towards the observer hits something), and thins the rest so that no two points are closer than `spacing_mm`.
/// Deterministic: the same input gives the same points.
/// @param surface  oriented outwards; need not be closed.  @pre at least one triangle, settings in range.
[[nodiscard]] VisibleSurface visible_surface(const TriMesh& surface, const VisibleSurfaceSettings& settings,
                                             Workers& workers);

}  // namespace incise
