#pragma once

#include <incise/imaging/segmentation.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace incise {

/// The face of the region that a CutVoxel's side faces most directly. @param side  0 to 5, see CutVoxel::side
[[nodiscard]] RegionFace face_of(const VolumeGrid& grid, std::int32_t side);

/// Tells which places of a specimen's skin lie where the region of interest, or the end of the scan, has cut through
/// its tissue. The skin there is artificial: the specimen continues beyond it. Labels that were drawn elsewhere are
/// taken for whole, unless they reach the end of their volume; so is a scan that was padded with air.
class CutFaces {
 public:
  CutFaces() = default;                          ///< nothing is cut: a specimen that was given as a mesh
  explicit CutFaces(const Segmentation& found);  ///< O(voxels)

  [[nodiscard]] bool empty() const { return sides_.empty(); }

  /// The face that made a triangle of the skin: its corners lie in cut voxels or next to them, and it looks the same
  /// way (within 60 degrees). Nothing where the skin is the specimen's own. @param corners  at rest (LPS, mm),
  /// counter-clockwise seen from outside. O(1).
  [[nodiscard]] std::optional<RegionFace> under(const std::array<Vec3, 3>& corners) const;

 private:
  [[nodiscard]] unsigned sides_near(const Vec3& place) const;

  VolumeGrid grid_;
  std::vector<std::uint8_t> sides_;  ///< of each voxel, a bit for each side that is cut; empty: none is
};

}  // namespace incise
