#pragma once

#include <incise/geometry/point_cloud.hpp>

#include <filesystem>

namespace incise::steps {

/// Reads the points of a surface or cloud file, with its normals if it has them. @throws DataError, also for fewer than
/// `fewest` points.
[[nodiscard]] PointCloud read_points(const std::filesystem::path& path, std::size_t fewest);

/// Refuses points so far from each other, or from the origin, that they cannot be millimetres of tissue.
/// @throws DataError with what was found
void require_extent(const Points& points, const std::filesystem::path& path);

/// Refuses points that are no surface: in one place, on a line, or so far apart that they cannot be millimetres of
/// tissue. @throws DataError with what was found
void require_surface(const Points& points, const std::filesystem::path& path);

}  // namespace incise::steps
