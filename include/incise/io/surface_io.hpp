#pragma once

#include <incise/geometry/contour.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// Reads a triangle surface: `.ply` (ascii, binary little endian), `.stl` (ascii, binary; equal corners become one
/// vertex), `.obj`,
/// `.vtp` (all encodings of read_tet_mesh's `.vtu`). Polygons with more than three corners are cut into fans, which is
/// right for convex ones. Coordinates are mm, LPS; a file with SPACE=RAS in a comment, in the STL header or in the
/// field data (as 3D Slicer writes) is turned: x and y negated, also in normals and other 3-component floating point
/// data. Point data come along (`.ply`: `normals` for nx, ny, nz, every other property under its name; `.vtp`: all
/// arrays). Open and even non-manifold surfaces are read; see find_surface_problems.
/// @throws DataError naming the line, byte or item: missing, truncated or damaged file, not-a-number coordinates, no
/// triangles.
[[nodiscard]] TriMesh read_surface(const std::filesystem::path& path);

/// As read_surface, but a file without triangles is welcome too: a point cloud is a TriMesh without triangles. @throws
/// DataError
[[nodiscard]] TriMesh read_cloud(const std::filesystem::path& path);

/// Writes a binary little endian `.ply` with 64-bit coordinates, point data, and a comment SPACE=LPS. A cloud is a mesh
/// without triangles. Reading it back gives the same doubles; `normals` become nx, ny, nz, other arrays with several
/// components the scalar properties NAME_0, NAME_1….
/// @param specimen_id  kept in a comment (specimen_id.hpp); empty: none.
/// @pre finite numbers, indices in range, data of the right length.  @throws DataError if the file cannot be written.
void write_ply(const std::filesystem::path& path, const TriMesh& surface, std::string_view specimen_id = {});

/// Writes a `.vtp` for ParaView: triangles, or points when there are none. @pre, @throws as write_ply.
void write_vtp(const std::filesystem::path& path, const TriMesh& surface);

/// Writes contours as polylines in one `.vtp`; a closed one repeats its first point's index at the end.
/// @param point_data  arrays over the points of all contours, one contour after the other.
/// @pre, @throws as write_ply.
void write_vtp(const std::filesystem::path& path, std::span<const Contour> contours,
               const std::map<std::string, DataArray>& point_data = {});

/// What keeps a surface from enclosing a body, one entry per kind with the first offender and how many there are.
struct SurfaceProblem {
  enum class Kind {
    NonFiniteVertex,
    IndexOutOfRange,
    DegenerateTriangle,       ///< a corner twice
    NonManifoldEdge,          ///< more than two triangles meet
    OpenBoundary,             ///< an edge of only one triangle
    InconsistentOrientation,  ///< two neighbours run along their edge in the same direction
    InsideOut,                ///< closed, but the normals point inwards
    NoTriangles
  };
  Kind kind;
  std::array<std::size_t, 2> first{0, 0};  ///< vertices of the first bad edge; or vertex or triangle index, twice
  std::size_t count = 0;                   ///< how many vertices, triangles or edges are affected
  std::string text;                        ///< for a person
};

/// Every kind of problem found, empty for a closed, consistently outward oriented surface. O(n log n). The first two
/// kinds end the search, because edges have no meaning then.
[[nodiscard]] std::vector<SurfaceProblem> find_surface_problems(const TriMesh& surface);

/// Refuses a surface that does not enclose a body. @param path names the file in the message.
/// @throws DataError with the first problem, where it is, and the number of places.
void require_closed_manifold(const TriMesh& surface, const std::filesystem::path& path);

}  // namespace incise
