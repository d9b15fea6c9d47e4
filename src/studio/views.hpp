#pragma once

#include "blob_folder.hpp"

#include <incise/imaging/made_skin.hpp>
#include <incise/mechanics/tissue.hpp>
#include <incise/workflow/margin_room.hpp>
#include <incise/workflow/products.hpp>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace incise::studio {

/// The skin of a mesh with its own numbering of vertices.
struct Skin {
  std::vector<VertexId> vertices;   ///< of the mesh, ascending
  std::vector<Triangle> triangles;  ///< indices into `vertices`, counter-clockwise seen from outside
};
/// @param is_live  per tet; empty: all.
[[nodiscard]] Skin skin_of(const TetMesh& mesh, std::span<const std::uint8_t> is_live = {});
/// Returns the positions of the skin's vertices. @param positions  of all vertices of the mesh.
[[nodiscard]] Points positions_on(const Skin& skin, std::span<const Vec3> positions);

/// Returns, for each triangle of the skin of a tissue at rest, 1 if the region of interest or the end of the scan made
/// it, 2 if strokes of the brush did, else 0.
[[nodiscard]] std::vector<std::uint8_t> cut_triangles(const MadeSkin& made, std::span<const Vec3> vertices,
                                                      std::span<const Triangle> triangles);

/// Returns the constraints that hold each vertex of the skin: bit c for constraint c of the first eight.
[[nodiscard]] std::vector<std::uint8_t> held_by(const Skin& skin, const TissueModel& model);
/// Returns for each constraint, defaults included: kind, number of held vertices, `setting` as in a case file,
/// `share_of_length`: its pull divided by the body's length along the pull, or null, and `note`: advice on it, or null.
[[nodiscard]] nlohmann::ordered_json constraints_json(const TissueModel& model);

/// Size, spacing_mm, origin_mm and axes: unit vectors along i, j and k.
[[nodiscard]] nlohmann::ordered_json grid_json(const VolumeGrid& grid);
[[nodiscard]] nlohmann::ordered_json points_json(std::span<const Vec3> points);
/// {"vertices", "triangles"}. @param slot  prefix of the names of both arrays' slots.
[[nodiscard]] nlohmann::ordered_json surface_json(BlobFolder& blobs, const std::string& slot,
                                                  std::span<const Vec3> vertices, std::span<const Triangle> triangles);
[[nodiscard]] nlohmann::ordered_json tool_path_json(const ToolPath& path);
/// Adds `greatest_margin_mm` and `margin_note`, which states it in a sentence.
void add_room(const MarginRoom& room, nlohmann::ordered_json& json);
/// Returns how a cut ended, in a sentence.
[[nodiscard]] std::string ended(Outcome outcome);
/// Returns a cut in the interface's form (docs/decisions/0009-studio.md). @param followed  the path that the tool
/// followed.
[[nodiscard]] nlohmann::ordered_json cut_json(const Case& settings, const SimulatedCut& cut, const ToolPath& followed);

}  // namespace incise::studio
