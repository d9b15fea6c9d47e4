#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

namespace incise {

/// A cloud in the rows and columns of a picture, row by row, with holes where nothing was measured.
struct GridCloud {
  TriMesh cloud;              ///< all points of the file, those that are not numbers included; places leaves these out
  int columns = 0, rows = 0;  ///< as the file's header says (`obj_info num_cols W`, `num_rows H`); 0: it does not
  std::vector<std::optional<std::size_t>> places;  ///< the point at each place of the picture; absent: a hole
};

/// Reads an organised `.ply`. Either every vertex is a place, holes being those with a coordinate that is not a number
/// (as PCL writes), or an element `range_grid` lists for every place no vertex or one (as Stanford's scans have it).
/// @throws DataError naming the line, byte or item, as read_cloud.
[[nodiscard]] GridCloud read_grid_cloud(const std::filesystem::path& path);

}  // namespace incise
