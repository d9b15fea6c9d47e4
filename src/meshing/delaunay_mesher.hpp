#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <span>

namespace incise::meshing_detail {

/// Criteria for CGAL Mesh_3. Lengths in mm, angles in degrees; size factors are relative to the local edge length h.
struct DelaunayCriteria {
  double facet_angle_deg = 25.0;
  double facet_size_factor = 0.9;
  double facet_distance_mm = 0.2;
  double cell_radius_edge_ratio = 2.0;
  double cell_size_factor = 0.75;
  double surface_tolerance_mm = 0.005;  ///< greatest distance of a surface vertex from the body's boundary
  std::size_t max_vertices = 0;         ///< refinement stops at this count
};

/// The body to mesh. All functions are called from the calling thread. For the same point, is_inside and edge_length_mm
/// must always return the same value.
struct DelaunayDomain {
  std::function<bool(const Vec3&)> is_inside;
  std::function<double(const Vec3&)> edge_length_mm;
  std::function<bool()> is_cancelled;  ///< called occasionally during refinement
  Box3 box;                            ///< contains the whole body
  Points surface_points;               ///< where refinement starts: a few points on the boundary, far from one another
};

enum class RefineEnd { Done, Cancelled, TooManyVertices };

/// One run of CGAL Mesh_3 (sequential, deterministic), phase by phase. Hides CGAL from all other files.
class DelaunayMesher {
 public:
  DelaunayMesher(DelaunayDomain domain, const DelaunayCriteria& criteria);
  ~DelaunayMesher();
  DelaunayMesher(DelaunayMesher&&) noexcept;

  /// Refines surface and inside by Delaunay refinement until every criterion is met.
  [[nodiscard]] RefineEnd refine();
  /// Moves vertices of tets whose smallest dihedral angle is below the bound. @returns whether none remains.
  bool perturb(double sliver_bound_deg);
  /// Gives vertices weights that remove the remaining slivers. @returns whether none remains.
  bool exude(double sliver_bound_deg);

  [[nodiscard]] std::size_t tet_count() const;
  /// Returns the mesh: vertices in Mesh_3's own order, tets positively oriented.
  [[nodiscard]] TetMesh extract() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace incise::meshing_detail
