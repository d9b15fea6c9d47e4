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
/// vertex), `.obj`, or `.vtp` (all encodings of read_tet_mesh's `.vtu`).
/// Polygons with more than three corners become fans of triangles, which is right for convex ones. Coordinates are mm,
/// LPS. A file with SPACE=RAS in a comment, in the STL header or in the field data (as 3D Slicer writes) is converted:
/// x and y are negated, also in normals and other 3-component floating-point data. Point data are kept (`.ply`: nx, ny,
/// nz as `normals`, every other property under its name; `.vtp`: all arrays). Open and non-manifold surfaces are read
/// too; see find_surface_problems.
/// @throws DataError naming the line, byte or item: missing, truncated or damaged file, non-finite coordinates, no
///         triangles.
[[nodiscard]] TriMesh read_surface(const std::filesystem::path& path);
/// Endings of read_surface's formats, for messages.
inline constexpr const char* kSurfaceFormats = ".ply, .stl, .obj or .vtp";
/// Returns whether a name, in any case, has the ending of a format of read_surface.
[[nodiscard]] bool is_surface_name(const std::filesystem::path& path);

/// Reads a surface or a point cloud, which is a TriMesh without triangles: as read_surface, but triangles are optional.
/// @throws DataError as read_surface, or if there are no points.
[[nodiscard]] TriMesh read_cloud(const std::filesystem::path& path);

/// Writes a surface or a cloud as binary little-endian `.ply` with 64-bit coordinates, point data, and a comment
/// SPACE=LPS. Reading it back gives the same doubles. `normals` become nx, ny, nz; other arrays with several components
/// become the scalar properties NAME_0, NAME_1….
/// @param specimen_id  stored in a comment (specimen_id.hpp); empty: none
/// @pre finite numbers, indices in range, data of the right length, array names without blanks (InvalidArgument).
/// @throws DataError if the file cannot be written.
void write_ply(const std::filesystem::path& path, const TriMesh& surface, std::string_view specimen_id = {});

/// Writes a `.vtp` for ParaView: the triangles, or the points if there are no triangles. @pre, @throws as write_ply.
void write_vtp(const std::filesystem::path& path, const TriMesh& surface);

/// Writes contours as polylines in one `.vtp`; a closed one repeats the index of its first point at the end.
/// @param point_data  arrays over the points of all contours, one contour after the other
/// @pre no contour is empty; otherwise as write_ply.  @throws DataError if the file cannot be written.
void write_vtp(const std::filesystem::path& path, std::span<const Contour> contours,
               const std::map<std::string, DataArray>& point_data = {});

/// One kind of problem that keeps a surface from enclosing a body: where it first occurs, and how often.
struct SurfaceProblem {
  enum class Kind {
    NonFiniteVertex,
    IndexOutOfRange,
    DegenerateTriangle,       ///< two corners are the same vertex
    NonManifoldEdge,          ///< more than two triangles meet
    OpenBoundary,             ///< only one triangle has the edge
    InconsistentOrientation,  ///< two neighbours traverse their edge in the same direction
    InsideOut,                ///< closed, but the normals point inwards
    NoTriangles
  };
  Kind kind;
  std::array<std::size_t, 2> first{0, 0};  ///< vertices of the first bad edge; or a vertex or triangle, twice
  std::size_t count = 0;                   ///< how many vertices, triangles or edges are affected
  std::string text;                        ///< for a person
};

/// Returns the problems of a surface, one entry per kind; empty for a closed surface whose triangles all face outwards.
/// After NonFiniteVertex, IndexOutOfRange or NoTriangles it looks no further. O(n log n).
[[nodiscard]] std::vector<SurfaceProblem> find_surface_problems(const TriMesh& surface);

/// Checks that a surface encloses a body. @param path  names the file in the message
/// @throws DataError with the first problem, where it is, and the number of places.
void require_closed_manifold(const TriMesh& surface, const std::filesystem::path& path);

}  // namespace incise
