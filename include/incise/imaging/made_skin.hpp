#pragma once

#include <incise/imaging/segmentation.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace incise {

/// The face of the region that a MadeVoxel's side faces most directly. @param side  0 to 5, see MadeVoxel::side
[[nodiscard]] RegionFace face_of(const VolumeGrid& grid, std::int32_t side);

/// Tells which places of a specimen's skin are not its own. Where the region of interest, or the end of the scan, has
/// cut through its tissue, the specimen continues beyond the skin. Where a stroke of the brush has made the skin,
/// nothing but the stroke says that it is there. Labels that were drawn elsewhere are taken for whole, unless they
/// reach the end of their volume; so is a scan that was padded with air. A place of the skin is of either kind if it
/// lies in such a voxel, or in one of the 26 about it, and the skin looks the same way there (within 60 degrees).
/// Places and outward unit normals are at rest (LPS, mm). O(1) each.
class MadeSkin {
 public:
  MadeSkin() = default;                          ///< all skin is the specimen's own: it was given as a mesh
  explicit MadeSkin(const Segmentation& found);  ///< O(voxels)

  [[nodiscard]] bool empty() const { return cut_.empty() && painted_.empty(); }

  /// The face that has made a place of the skin by a cut; nothing where none has.
  [[nodiscard]] std::optional<RegionFace> cut_at(const Vec3& place, const Vec3& normal) const;

  /// Whether strokes of the brush made a place of the skin.
  [[nodiscard]] bool is_painted(const Vec3& place, const Vec3& normal) const;

 private:
  using Sides = std::vector<std::uint8_t>;  ///< of each voxel, a bit for each side that was made; empty: none was
  [[nodiscard]] Sides sides_of(const std::vector<MadeVoxel>& voxels) const;
  [[nodiscard]] unsigned sides_near(const Sides& sides, const Vec3& place) const;
  [[nodiscard]] std::optional<std::int32_t> side_at(const Sides& sides, const Vec3& place, const Vec3& normal) const;

  VolumeGrid grid_;
  Sides cut_;
  Sides painted_;
};

}  // namespace incise
