#pragma once

#include "imaging/volume_filters.hpp"

#include <incise/imaging/segmentation.hpp>

#include <array>

namespace incise {

/// The part of a CT that is looked at, with room around it: everything outside the region of interest is background.
struct WorkingVolume {
  CtVolume hu;
  Mask region;     ///< inside the CT's grid and the region of interest
  Mask tissue;     ///< HU in the window, or painted as tissue: outside the region, too
  Mask in_window;  ///< the tissue in the region
  std::vector<std::uint8_t> unedited;  ///< in_window's voxels before the edits; empty: there are none
};

/// A grid of `size` voxels whose first is voxel `low` (which may lie outside) of `grid`.
[[nodiscard]] VolumeGrid sub_grid(const VolumeGrid& grid, const std::array<int, 3>& low,
                                  const std::array<int, 3>& size);

/// Cuts the region of interest out of the CT, `pad` voxels larger on every side, and applies the edits to it.
/// @param beyond  the value of voxels that the CT does not have. @throws
/// CaseError: region outside the volume, nothing in the window.
[[nodiscard]] WorkingVolume cut_out(const CtVolume& ct, const SegmentationSettings& settings, int pad,
                                    std::int16_t beyond, Monitor& monitor);

/// The offsets, in the working volume, of the seeds' voxels. @throws CaseError: a seed outside volume, region or
/// window.
[[nodiscard]] std::vector<std::size_t> locate_seeds(const CtVolume& ct, const WorkingVolume& work,
                                                    const SegmentationSettings& settings);

/// Where the region, or the end of the volume, cuts through the tissue of which the body is made: the voxels of the
/// body that tissue in the region joins, straight on, to such a place. Straight on: within `opening_mm`, which the
/// opening has taken away. Skin that merely lies at the region's face is not among them: a voxel is cut where 4 of the
/// 9 voxels of the layer beyond, round the next one, are tissue or outside the volume. @pre all on one grid.
[[nodiscard]] std::vector<MadeVoxel> find_cut_voxels(const Mask& body, const WorkingVolume& work,
                                                     const VolumeGrid& scan, double opening_mm);

/// Where the edits have made the body's surface, likewise: they made the voxel tissue, or took away the one beyond it.
[[nodiscard]] std::vector<MadeVoxel> find_painted_voxels(const Mask& body, const WorkingVolume& work,
                                                         double opening_mm);

/// Where the smoothed body begins beneath each of such voxels, straight on: smoothing moves what is curved.
/// @param smoothed  a part of the voxels of `from`. @param reach_mm  farther in, nothing is looked for.
[[nodiscard]] std::vector<MadeVoxel> carried_to_surface(const std::vector<MadeVoxel>& made, const VolumeGrid& from,
                                                        const Mask& smoothed, double reach_mm);

/// The smallest index box, from low to below high, that holds the mask's voxels. @pre at least one.
struct IndexBox {
  std::array<int, 3> low;
  std::array<int, 3> high;
};
[[nodiscard]] IndexBox box_of(const Mask& mask);

/// The voxels of the box; the box must lie inside the volume's grid.
template <class Value>
[[nodiscard]] Volume<Value> crop(const Volume<Value>& volume, const IndexBox& box) {
  const std::array<int, 3> size{box.high[0] - box.low[0], box.high[1] - box.low[1], box.high[2] - box.low[2]};
  Volume<Value> part{sub_grid(volume.grid, box.low, size), {}};
  part.voxels.reserve(part.grid.voxel_count());
  for (int k = box.low[2]; k < box.high[2]; ++k)
    for (int j = box.low[1]; j < box.high[1]; ++j) {
      const auto row = volume.voxels.begin() + static_cast<std::ptrdiff_t>(volume.grid.offset(box.low[0], j, k));
      part.voxels.insert(part.voxels.end(), row, row + size[0]);
    }
  return part;
}

}  // namespace incise
