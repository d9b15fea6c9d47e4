#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <filesystem>
#include <vector>

/// One function per tet mesh format. They return the content of the file; read_tet_mesh checks volumes and orientation.
namespace incise::io_detail {

[[nodiscard]] TetMesh read_vtu(const std::filesystem::path& path);
[[nodiscard]] TetMesh read_legacy_vtk(const std::filesystem::path& path);
[[nodiscard]] TetMesh read_gmsh(const std::filesystem::path& path);
[[nodiscard]] TetMesh read_tetgen(const std::filesystem::path& path);

/// Cells of mixed kinds as VTK lists them, in one array of point indices.
struct VtkCells {
  std::vector<double> connectivity;  ///< point indices, one cell after the other
  std::vector<double> ends;          ///< where each cell ends in `connectivity`
  std::vector<double> types;         ///< VTK cell type numbers
};

/// Returns the tets among the cells, and the index of each one's cell. Skips lower-dimensional cells.
/// @param points  number of points
/// @throws DataError naming the first cell that is another volume element, has a wrong number of points, or an index
///         out of range.
[[nodiscard]] std::pair<std::vector<Tet>, std::vector<std::size_t>> tets_among(const VtkCells& cells,
                                                                               std::size_t points,
                                                                               const std::filesystem::path& path);

/// Returns the items of `array` that belong to the chosen cells.
[[nodiscard]] DataArray chosen(const DataArray& array, const std::vector<std::size_t>& cells);

}  // namespace incise::io_detail
