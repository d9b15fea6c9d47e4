#pragma once

#include "blob_folder.hpp"

#include <incise/imaging/cut_faces.hpp>
#include <incise/mechanics/tissue.hpp>
#include <incise/workflow/products.hpp>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace incise::studio {

/// The skin of a mesh by itself, with a numbering of its own.
struct Skin {
  std::vector<VertexId> vertices;   ///< of the mesh, ascending
  std::vector<Triangle> triangles;  ///< of positions in `vertices`, counter-clockwise seen from outside
};
/// @param is_live  per tet; empty: all.
[[nodiscard]] Skin skin_of(const TetMesh& mesh, std::span<const std::uint8_t> is_live = {});
/// The skin's vertices where `positions` (of all vertices of the mesh) has them.
[[nodiscard]] Points positions_on(const Skin& skin, std::span<const Vec3> positions);

/// For each triangle of a found tissue's skin, 1 where the region of interest or the end of the scan made it.
[[nodiscard]] std::vector<std::uint8_t> cut_triangles(const CutFaces& faces, const TriMesh& skin);

/// Which constraints hold each vertex of the skin: bit c for constraint c of the first eight.
[[nodiscard]] std::vector<std::uint8_t> held_by(const Skin& skin, const TissueModel& model);
/// Of each constraint, those of the default included: kind, number of held vertices, and `setting` as a case file has
/// it.
[[nodiscard]] nlohmann::ordered_json constraints_json(const TissueModel& model);

/// Size, spacing_mm, origin_mm and axes: unit vectors along i, j and k.
[[nodiscard]] nlohmann::ordered_json grid_json(const VolumeGrid& grid);
[[nodiscard]] nlohmann::ordered_json points_json(std::span<const Vec3> points);
/// {"vertices", "triangles"}. @param slot  begins the names of both arrays' slots.
[[nodiscard]] nlohmann::ordered_json surface_json(BlobFolder& blobs, const std::string& slot,
                                                  std::span<const Vec3> vertices, std::span<const Triangle> triangles);
[[nodiscard]] nlohmann::ordered_json tool_path_json(const ToolPath& path);
/// A cut as the interface gives it (docs/decisions/0009-studio.md). @param followed  the path that the tool followed.
[[nodiscard]] nlohmann::ordered_json cut_json(const Case& settings, const SimulatedCut& cut, const ToolPath& followed);

}  // namespace incise::studio
