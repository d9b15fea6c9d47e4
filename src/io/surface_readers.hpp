#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <filesystem>
#include <vector>

/// One function per surface format. They return the content of the file in LPS, with or without triangles.
namespace incise::io_detail {

[[nodiscard]] TriMesh read_ply(const std::filesystem::path& path);
[[nodiscard]] TriMesh read_stl(const std::filesystem::path& path);
[[nodiscard]] TriMesh read_obj(const std::filesystem::path& path);
[[nodiscard]] TriMesh read_vtp_surface(const std::filesystem::path& path);

/// Adds a polygon as a fan of triangles around its first corner.
void add_polygon(TriMesh& surface, const std::vector<VertexId>& corners);

/// @pre finite vertices, indices in range, data of the right length (InvalidArgument).
void require_writable(const TriMesh& surface);

}  // namespace incise::io_detail
