#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/ids.hpp>
#include <incise/geometry/types.hpp>

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace incise {

/// A named array attached to points or cells: `components` numbers per item, items one after the other.
struct DataArray {
  int components = 1;
  std::vector<double> values;
};
inline void describe(Visitor& v, DataArray& a) {
  v("components", a.components, "Numbers for each item.", Range{1.0, 1e6});
  v("values", a.values, "Values, item by item.");
}

using Tet = std::array<VertexId, 4>;
using Triangle = std::array<VertexId, 3>;

/// Tetrahedral mesh, mm, LPS. A valid tet (a, b, c, d) has (b-a) x (c-a) · (d-a) > 0.
struct TetMesh {
  Points vertices;        ///< N x 3
  std::vector<Tet> tets;  ///< M x 4
  std::map<std::string, DataArray> point_data;  ///< N items each
  std::map<std::string, DataArray> cell_data;   ///< M items each
};
inline void describe(Visitor& v, TetMesh& m) {
  v("vertices", m.vertices, "Positions.");
  v("tets", m.tets, "Tets, four vertices each.");
  v("point_data", m.point_data, "Numbers for each vertex.");
  v("cell_data", m.cell_data, "Numbers for each tet.");
}

/// Triangle mesh, mm, LPS. Closed surfaces are oriented outwards.
struct TriMesh {
  Points vertices;                  ///< N x 3
  std::vector<Triangle> triangles;  ///< M x 3, counter-clockwise seen from outside
  std::map<std::string, DataArray> point_data;
};
inline void describe(Visitor& v, TriMesh& m) {
  v("vertices", m.vertices, "Positions.");
  v("triangles", m.triangles, "Triangles, three vertices each, counter-clockwise seen from outside.");
  v("point_data", m.point_data, "Numbers for each vertex.");
}

[[nodiscard]] inline const Vec3& vertex(std::span<const Vec3> vertices, VertexId id) { return vertices[id.index()]; }

/// Returns the positions of the corners of a tet or a triangle, mm.
template <std::size_t N>
[[nodiscard]] std::array<Vec3, N> corners_of(std::span<const Vec3> vertices, const std::array<VertexId, N>& ids) {
  std::array<Vec3, N> corners;
  for (std::size_t c = 0; c < N; ++c) corners[c] = vertex(vertices, ids[c]);
  return corners;
}

/// Signed volume, mm³, of the tet with the given corners; positive for a valid tet.
[[nodiscard]] double signed_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Sum of the signed volumes of all tets, mm³.
[[nodiscard]] double volume_mm3(const TetMesh& mesh);

/// Volume enclosed by a closed, outward oriented surface, mm³ (divergence theorem).
[[nodiscard]] double enclosed_volume_mm3(const TriMesh& surface);

/// Returns the corners of face f (0..3) of a tet: the face opposite corner f, counter-clockwise seen from outside.
[[nodiscard]] Triangle face_of(const Tet& tet, int face);

/// One triangle of the mesh's skin and the tet that it belongs to.
struct BoundaryFace {
  Triangle corners;  ///< counter-clockwise seen from outside
  TetId tet;
};

/// Returns the faces that belong to exactly one live tet, in order of tet, then face. O(M log M).
/// @param is_live  per tet, 1 if it is live; empty: all tets are.
[[nodiscard]] std::vector<BoundaryFace> boundary_faces(const TetMesh& mesh, std::span<const std::uint8_t> is_live = {});

/// Returns per tet: bit f is set where face f (opposite corner f) is on the skin. O(M log M).
[[nodiscard]] std::vector<std::uint8_t> skin_faces(const TetMesh& mesh);

/// Returns per tet the tet across each of its four faces (face f is opposite corner f); none: -1. O(M log M).
[[nodiscard]] std::vector<std::array<std::int32_t, 4>> face_neighbours(const TetMesh& mesh);

/// Returns the skin as a mesh that keeps all N vertices of `mesh` in their order, so vertex ids are shared.
[[nodiscard]] TriMesh boundary_surface(const TetMesh& mesh);

/// Box around all points, mm. @pre at least one point.
[[nodiscard]] Box3 bounding_box(std::span<const Vec3> points);

/// A problem of a mesh: non-finite coordinates, indices out of range, inverted or zero-volume tets, duplicate tets,
/// faces shared by more than two tets, unused vertices, more than one face-connected component, point or cell data of
/// the wrong length, or no tets.
struct MeshProblem {
  enum class Kind {
    NonFiniteVertex, IndexOutOfRange, InvertedTet, FlatTet, DuplicateTet, NonManifoldFace, UnusedVertex,
    Disconnected, WrongDataLength, NoTets
  };
  Kind kind;
  std::size_t first_index = 0;  ///< of the first vertex or tet affected; 0 for data
  std::size_t count = 0;        ///< of this kind; for data, how many numbers there are
  std::string text;             ///< for a person
};
/// Returns at most one entry for each kind of problem (for data of the wrong length, one for points and one for cells);
/// empty if the mesh is sound. If an index is out of range, the checks that read the tets are skipped.
[[nodiscard]] std::vector<MeshProblem> find_problems(const TetMesh& mesh);

/// Returns a block [0, size_mm] of nx x ny x nz cells, x fastest, each of six tets with matching faces (Kuhn): the
/// standard test body. @throws InvalidArgument for a size or number of cells that is not above 0.
[[nodiscard]] TetMesh make_block(const Vec3& size_mm, std::array<int, 3> cells);

}  // namespace incise
