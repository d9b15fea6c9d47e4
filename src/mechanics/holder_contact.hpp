#pragma once

#include <incise/geometry/surface_query.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <array>
#include <vector>

namespace incise {

/// How a point lies to a support.
struct SupportGap {
  double gap_mm = 0.0;          ///< signed distance: negative behind the surface; infinite where nothing is touched
  Vec3 normal = Vec3::UnitZ();  ///< unit, gradient of the gap
};

/// Signed distance to a holder's surface. Its sign comes from the normal at the nearest point, which on edges and at
/// corners is the angle-weighted sum of the faces' normals: with it the sign is right wherever the nearest point lies
/// [Baerentzen2005]. A point whose nearest place is on the rim of an open surface, beside the sheet, touches
/// nothing.
class HolderContact {
 public:
  /// @throws InvalidArgument naming the first problem: no triangles, not finite, an edge of more than two triangles,
  /// neighbours oriented against each other, triangles that cross, a closed surface turned inside out.
  explicit HolderContact(const TriMesh& surface);

  [[nodiscard]] SupportGap gap(const Vec3& p) const;

 private:
  void find_edges(const TriMesh& surface);
  void find_normals(const TriMesh& surface);

  SurfaceQuery query_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<Vec3, 3>> edge_normals_;  ///< per triangle: of the edge opposite each corner
  std::vector<std::array<bool, 3>> is_rim_edge_;   ///< the same, for edges of one triangle only
  std::vector<Vec3> vertex_normals_;
  std::vector<bool> is_rim_vertex_;
  Box3 box_;
  bool is_closed_ = true;
};

}  // namespace incise
