#pragma once

#include <incise/core/monitor.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <filesystem>

namespace incise {

/// Reads a tetrahedral mesh. The ending of the name says the format:
///
///   .vtu   VTK XML: ascii, base64 or raw, inline or appended, plain or zlib-compressed (what ParaView writes by
///   default) .vtk   VTK legacy, versions 1 to 5.1, ascii or binary .msh   Gmsh 1 ($NOD), 2.2 and 4.1, ascii .node,
///   .ele   TetGen, numbered from 0 or from 1; either name of the pair will do
///
/// Vertices keep the order of the file. Triangles, lines and single points beside the tets (boundary patches) are left
/// out, with their cell data; any other kind of volume element is refused. Coordinates are taken as mm, LPS; a .vtu or
/// .vtk stamped SPACE=RAS is turned (x and y negated, also in 3-component arrays of floating point numbers). Scaling,
/// from metres say, is the caller's matter.
///
/// Some programs number the corners the other way round: when *every* tet of the file has a negative volume, all are
/// turned over, by exchanging their last two corners; a Notice says so. A mixture is damage, and is
/// refused, as is a tet without volume.
///
/// Point and cell data come along as doubles under their names. TetGen's unnamed columns become `attribute_0`… and
/// `boundary_marker`; Gmsh's tags become the cell arrays `physical` and `geometrical`.
/// @throws DataError naming the line, byte or item: missing, truncated or damaged file, not-a-number coordinates, index
/// out of range,
///         no tets, mixed orientation, an unsupported variant (binary Gmsh, LZ4 or LZMA compression).
[[nodiscard]] TetMesh read_tet_mesh(const std::filesystem::path& path, Monitor& monitor);
/// The same for those who do not care which way round the file had it.
[[nodiscard]] TetMesh read_tet_mesh(const std::filesystem::path& path);

/// As read_tet_mesh, but a moment of a simulation is taken as it is: tets may be flat or turned inside out there, and
/// none is turned over.
[[nodiscard]] TetMesh read_deformed_tet_mesh(const std::filesystem::path& path);

/// What a specimen may measure along its longest side, mm.
inline constexpr double kSmallestBodyMm = 2.0;
inline constexpr double kLargestBodyMm = 2000.0;

/// Refuses the box round a specimen that is no specimen's: lengths in metres, or in some unit a thousand times smaller than the millimetre.
/// @throws DataError naming the file and the box's longest side.
void require_body_size(const Box3& box, const std::filesystem::path& path);

/// Writes a `.vtu` that ParaView opens and read_tet_mesh returns exactly: little endian, 64-bit floats, zlib-compressed
/// base64. A comment says SPACE=LPS and mm: meshio stops at text in field data. The file appears complete or not at
/// all.
/// @pre every number is finite, indices are in range, data arrays have the right length (InvalidArgument otherwise).
/// @throws DataError if the file cannot be written.
void write_vtu(const std::filesystem::path& path, const TetMesh& mesh);

}  // namespace incise
