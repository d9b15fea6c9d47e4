#pragma once

#include <incise/core/workers.hpp>
#include <incise/geometry/point_cloud.hpp>
#include <incise/geometry/tet_mesh.hpp>

namespace incise {

struct VisibleSurfaceSettings {
  Vec3 approach = -Vec3::UnitZ();  ///< direction of sight
  double spacing_mm = 1.0;         ///< least distance between two points; the mean one is about 1.3 times that
  double largest_tilt_deg = 80.0;  ///< between the outward normal and the observer; steeper faces a camera hardly sees
};

/// The part of a surface that an observer far away sees, as an even sample.
struct VisibleSurface {
  PointCloud cloud;       ///< with outward normals, interpolated between the vertices' (angle-weighted) ones
  double area_mm2 = 0.0;  ///< of the visible part, from dense samples: relative error about 1 / sqrt(10 · points)
};

/// Samples the surface evenly by area, lays the samples onto the curved surface that the triangles stand for (exact for
/// quadratics; [Boubekeur2008]; along creases of more than 35 degrees the triangles stay flat), drops what faces away,
/// is steeper than `largest_tilt_deg` or is hidden by another part (a ray towards the observer hits something), and
/// thins the rest so that no two points are closer than `spacing_mm`. The same input gives the same points; there is
/// nothing random in it.
/// @param surface  outward oriented; need not be closed.  @pre at least one triangle, settings in range.
[[nodiscard]] VisibleSurface visible_surface(const TriMesh& surface, const VisibleSurfaceSettings& settings,
                                             Workers& workers);

}  // namespace incise
