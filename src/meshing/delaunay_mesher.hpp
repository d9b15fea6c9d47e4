#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <span>

namespace incise::meshing_detail {

/// What CGAL Mesh_3 is asked for. Lengths in mm, angles in degrees, factors relative to the local edge length h.
struct DelaunayCriteria {
  double facet_angle_deg = 25.0;
  double facet_size_factor = 0.9;
  double facet_distance_mm = 0.2;
  double cell_radius_edge_ratio = 2.0;
  double cell_size_factor = 0.75;
  double surface_tolerance_mm = 0.005;  ///< how near the boundary of the body a surface vertex is put
  std::size_t max_vertices = 0;         ///< refinement stops here
};

/// The body to be meshed. All functions are called from the calling thread and must not change their answer.
struct DelaunayDomain {
  std::function<bool(const Vec3&)> is_inside;
  std::function<double(const Vec3&)> edge_length_mm;
  std::function<bool()> is_cancelled;  ///< asked now and then during refinement
  Box3 box;                            ///< holds the whole body
  Points surface_points;               ///< a few points on the boundary, far from one another: where refinement starts
};

enum class RefineEnd { Done, Cancelled, TooManyVertices };

/// One run of CGAL Mesh_3 (sequential, deterministic), phase by phase. The only place that sees CGAL.
class DelaunayMesher {
 public:
  DelaunayMesher(DelaunayDomain domain, const DelaunayCriteria& criteria);
  ~DelaunayMesher();
  DelaunayMesher(DelaunayMesher&&) noexcept;
  DelaunayMesher& operator=(DelaunayMesher&&) noexcept;

  /// Delaunay refinement of surface and inside until every criterion holds.
  [[nodiscard]] RefineEnd refine();
  /// Moves vertices of tets whose smallest dihedral angle is below the bound. @returns whether none is left.
  bool perturb(double sliver_bound_deg);
  /// Gives vertices weights that make remaining slivers vanish. @returns whether none is left.
  bool exude(double sliver_bound_deg);

  [[nodiscard]] std::size_t tet_count() const;
  /// Vertices in Mesh_3's own order, tets positively oriented.
  [[nodiscard]] TetMesh extract() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace incise::meshing_detail
