#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <array>
#include <cstddef>
#include <functional>
#include <string>

namespace incise {

/// Lengths of a set of edges, each edge counted once.
struct EdgeStatistics {
  std::size_t count = 0;
  double min_mm = 0.0;
  double mean_mm = 0.0;
  double max_mm = 0.0;
};
inline void describe(Visitor& v, EdgeStatistics& e) {
  v("count", e.count, "Number of edges.");
  v({"min", "Shortest edge.", "mm"}, e.min_mm);
  v({"mean", "Mean length.", "mm"}, e.mean_mm);
  v({"max", "Longest edge.", "mm"}, e.max_mm);
}

/// Size and quality of a mesh. A dihedral angle is the angle between two faces of a tet: 70.5 degrees in a regular tet,
/// near 0 or 180 in a sliver. The radius ratio is 3 x inscribed / circumscribed radius: 1 in a regular tet, 0 in a flat
/// or inverted one.
struct MeshQuality {
  static constexpr int kBinWidthDeg = 5;

  std::size_t tets = 0;
  std::size_t vertices = 0;
  double volume_mm3 = 0.0;
  double min_dihedral_deg = 0.0;
  double max_dihedral_deg = 0.0;
  std::array<std::size_t, 180 / kBinWidthDeg>
      dihedral_histogram{};  ///< six angles per tet; bin b holds [5 b, 5 b + 5) degrees
  double min_radius_ratio = 0.0;
  double mean_radius_ratio = 0.0;
  double smallest_tet_mm3 = 0.0;  ///< signed: negative if a tet is inverted
  EdgeStatistics edges;
};
inline void describe(Visitor& v, MeshQuality& q) {
  v("tets", q.tets, "Number of tets.");
  v("vertices", q.vertices, "Number of vertices.");
  v("volume_mm3", q.volume_mm3, "Volume of all tets.");
  v("min_dihedral_deg", q.min_dihedral_deg, "Smallest angle between two faces of a tet.");
  v("max_dihedral_deg", q.max_dihedral_deg, "Greatest such angle.");
  v.begin({"dihedral_histogram", "Histogram of the dihedral angles."});
  v.derived("bin_width_deg", MeshQuality::kBinWidthDeg, "Width of each bin.");
  v("counts", q.dihedral_histogram, "Number of angles in each bin, six for each tet.");
  v.end();
  v("min_radius_ratio", q.min_radius_ratio, "Least ratio of the radii of inscribed and circumscribed sphere, times 3.");
  v("mean_radius_ratio", q.mean_radius_ratio, "Mean of that ratio.");
  v("smallest_tet_mm3", q.smallest_tet_mm3, "Volume of the smallest tet; negative if it is inverted.");
  v("edge_mm", q.edges, "Lengths of the edges.");
}

/// Measures every tet and edge. A mesh without tets has zeros everywhere but in `vertices`. O(M log M) for M tets.
/// @throws InvalidArgument for a vertex that is not finite or an index out of range, naming the first.
[[nodiscard]] MeshQuality quality_of(const TetMesh& mesh);

/// Returns the lengths of the edges whose mid-point the predicate accepts, for example those near the cut.
/// @throws as quality_of.
[[nodiscard]] EdgeStatistics edges_where(const TetMesh& mesh, const std::function<bool(const Vec3&)>& accepts_midpoint);

/// Returns a table and a text histogram of the dihedral angles, for people to read; ends with a line break.
[[nodiscard]] std::string to_text(const MeshQuality& quality);

}  // namespace incise
