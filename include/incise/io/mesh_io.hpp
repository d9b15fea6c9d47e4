#pragma once

#include <incise/core/monitor.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <filesystem>

namespace incise {

/// Reads a tetrahedral mesh. The extension gives the format:
///
///   .vtu         VTK XML: ascii, base64 or raw, inline or appended, plain or zlib-compressed (ParaView's default)
///   .vtk         VTK legacy, versions 1 to 5.1, ascii or binary
///   .msh         Gmsh 1 ($NOD), 2.2 and 4.1, ascii
///   .node, .ele  TetGen, numbered from 0 or from 1; give either file of the pair
///
/// Vertices keep the order of the file. Triangles, lines and points beside the tets (boundary patches) are dropped with
/// their cell data; any other kind of volume element is refused. Coordinates are taken as mm, LPS, and are not scaled.
/// A .vtu or .vtk stamped SPACE=RAS is converted: x and y are negated, also in 3-component floating-point arrays.
///
/// Some programs number the corners in the opposite order: if *every* tet of the file has a negative volume, all are
/// turned over by exchanging their last two corners, and a Notice reports it. A mixture of signs is refused as damage,
/// and so is a tet without volume.
///
/// Point and cell data are kept as doubles under their names. TetGen's unnamed columns become `attribute_0`… and
/// `boundary_marker`; Gmsh's tags become the cell arrays `physical` and `geometrical`.
/// @throws DataError naming the line, byte or item: missing, truncated or damaged file, non-finite coordinates, index
///         out of range, no tets, mixed orientation, an unsupported variant (binary Gmsh, LZ4 or LZMA compression).
[[nodiscard]] TetMesh read_tet_mesh(const std::filesystem::path& path, Monitor& monitor);
/// The same without notices.
[[nodiscard]] TetMesh read_tet_mesh(const std::filesystem::path& path);

/// Reads one moment of a simulation, where tets may be flat or inverted: as read_tet_mesh, but without checking volumes
/// and without turning tets over.
[[nodiscard]] TetMesh read_deformed_tet_mesh(const std::filesystem::path& path);

/// Range of the longest side of a specimen's bounding box, mm, limits included.
inline constexpr double kSmallestBodyMm = 2.0;
inline constexpr double kLargestBodyMm = 2000.0;

/// Checks that a specimen's bounding box, mm, is in that range: lengths in metres or micrometres are not.
/// @throws DataError naming the file and the longest side.
void require_body_size(const Box3& box, const std::filesystem::path& path);

/// Writes a `.vtu` that ParaView opens and that read_tet_mesh reads back exactly: little endian, 64-bit floats,
/// zlib-compressed base64. SPACE=LPS and mm are stated in a comment, because meshio fails on text in field data. All or
/// nothing.
/// @pre every number is finite, indices are in range, data arrays have the right length (InvalidArgument).
/// @throws DataError if the file cannot be written.
void write_vtu(const std::filesystem::path& path, const TetMesh& mesh);

}  // namespace incise
