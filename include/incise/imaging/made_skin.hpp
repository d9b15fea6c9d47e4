#pragma once

#include <incise/imaging/segmentation.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace incise {

/// Returns the face of the region that a voxel's side faces most directly. @param side  0 to 5, see MadeVoxel::side
[[nodiscard]] RegionFace face_of(const VolumeGrid& grid, std::int32_t side);

/// Finds places where a specimen's skin is artificial. There are two kinds. Cut: the region of interest, or the end of
/// the scan, cuts through the tissue, and the specimen continues beyond the skin. Painted: strokes of the brush made
/// the skin. Labels drawn in another program count as complete unless they reach the end of their volume; so does a
/// scan that was padded with air. A place counts as cut or painted if its voxel, or one of the 26 around it, has such a
/// side, and the skin faces the same way (within 60 degrees). Places are at rest (LPS, mm), with outward unit normals.
/// O(1) per query.
class MadeSkin {
 public:
  MadeSkin() = default;                          ///< no artificial skin, as for a specimen given as a mesh
  explicit MadeSkin(const Segmentation& found);  ///< O(voxels)

  [[nodiscard]] bool empty() const { return cut_.empty() && painted_.empty(); }

  /// Returns the face of the region that cut the tissue at a place of the skin; nullopt if none did.
  [[nodiscard]] std::optional<RegionFace> cut_at(const Vec3& place, const Vec3& normal) const;

  /// Returns whether strokes of the brush made a place of the skin.
  [[nodiscard]] bool is_painted(const Vec3& place, const Vec3& normal) const;

 private:
  using Sides = std::vector<std::uint8_t>;  ///< for each voxel, bit s set if side s is artificial; empty: none is
  [[nodiscard]] Sides sides_of(const std::vector<MadeVoxel>& voxels) const;
  [[nodiscard]] unsigned sides_near(const Sides& sides, const Vec3& place) const;
  [[nodiscard]] std::optional<std::int32_t> side_at(const Sides& sides, const Vec3& place, const Vec3& normal) const;

  VolumeGrid grid_;
  Sides cut_;
  Sides painted_;
};

}  // namespace incise
