#pragma once

#include <incise/geometry/surface_query.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <array>
#include <vector>

namespace incise {

/// Position of a point relative to a support.
struct SupportGap {
  double gap_mm = 0.0;          ///< signed distance: negative behind the surface; infinite clear of it
  Vec3 normal = Vec3::UnitZ();  ///< unit, gradient of the gap
};

/// Signed distance to a holder's surface. The normal at the nearest point gives the sign; on edges and at corners it is
/// the angle-weighted sum of the faces' normals, which gives the right sign wherever the nearest point lies
/// [Baerentzen2005]. A point beside an open surface, whose nearest point is on the rim, touches nothing.
class HolderContact {
 public:
  /// @throws InvalidArgument naming the first problem: no triangles, a vertex that is not finite, a triangle without
  /// area, an edge of more than two triangles, neighbours with opposite orientation, triangles that cross, a closed
  /// surface that is inside out.
  explicit HolderContact(const TriMesh& surface);

  /// Returns distance and normal at p (mm). The distance is infinite outside the box of a closed surface, beside the
  /// rim of an open one, and for a p that is not finite.
  [[nodiscard]] SupportGap gap(const Vec3& p) const;

 private:
  void find_edges(const TriMesh& surface);
  void find_normals(const TriMesh& surface);

  SurfaceQuery query_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<Vec3, 3>> edge_normals_;  ///< per triangle: of the edge opposite each corner
  std::vector<std::array<bool, 3>> is_rim_edge_;   ///< in the same order: whether the edge has only one triangle
  std::vector<Vec3> vertex_normals_;
  std::vector<bool> is_rim_vertex_;
  Box3 box_;
  bool is_closed_ = true;
};

}  // namespace incise
