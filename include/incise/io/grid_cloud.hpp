#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

namespace incise {

/// An organised cloud: one place for each pixel of a picture, row by row, with holes where nothing was measured.
struct GridCloud {
  TriMesh cloud;              ///< all points of the file, mm, LPS; non-finite points too, but `places` leaves them out
  int columns = 0, rows = 0;  ///< as stated in the header (`obj_info num_cols W`, `num_rows H`); 0: not stated
  std::vector<std::optional<std::size_t>> places;  ///< index of the point at each pixel; absent: a hole
};

/// Reads an organised `.ply` in either of two forms: every vertex is a pixel, and a vertex with a NaN coordinate is a
/// hole (as PCL writes it); or the element `range_grid` lists one vertex or none for each pixel (as in Stanford's
/// scans). @throws DataError naming the line, byte or item, as read_cloud.
[[nodiscard]] GridCloud read_grid_cloud(const std::filesystem::path& path);

}  // namespace incise
