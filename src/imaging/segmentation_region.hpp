#pragma once

#include "imaging/volume_filters.hpp"

#include <incise/imaging/segmentation.hpp>

#include <array>
#include <optional>

namespace incise {

/// The part of a CT that is segmented, with a pad around it. Everything outside the region of interest is background.
struct WorkingVolume {
  CtVolume hu;
  Mask region;     ///< inside the CT's grid and the region of interest
  Mask tissue;     ///< HU in the window, or painted as tissue; also outside the region
  Mask in_window;  ///< the tissue in the region
  std::vector<std::uint8_t> unedited;  ///< voxels of in_window before the edits; empty if there are no edits
};

/// Returns whether a voxel with its centre at `p` lies in the region of interest, with room for rounding: a box that
/// ends on a voxel centre contains it. Without a box, every voxel does.
[[nodiscard]] bool is_in_roi(const std::optional<Box3>& roi_mm, const Vec3& p);

/// Returns a grid of `size` voxels whose first voxel is voxel `low` of `grid`; it may lie outside `grid`.
[[nodiscard]] VolumeGrid sub_grid(const VolumeGrid& grid, const std::array<int, 3>& low,
                                  const std::array<int, 3>& size);

/// Cuts the region of interest out of the CT, `pad` voxels larger on every side, and applies the edits to it.
/// @param beyond  value of voxels outside the CT.
/// @throws CaseError if the region is outside the volume, or nothing is in the window.
[[nodiscard]] WorkingVolume cut_out(const CtVolume& ct, const SegmentationSettings& settings, int pad,
                                    std::int16_t beyond, Monitor& monitor);

/// Returns the offsets of the seeds' voxels in the working volume. @throws CaseError for a seed outside the volume, the
/// region or the window.
[[nodiscard]] std::vector<std::size_t> locate_seeds(const CtVolume& ct, const WorkingVolume& work,
                                                    const SegmentationSettings& settings);

/// Returns the body's voxels where the region, or the end of the volume, cuts through tissue. A voxel of the region is
/// cut if, of the 3 x 3 voxels in the layer beyond it, at least 4 are tissue or outside the volume; skin that merely
/// touches the region's face is not. Where the opening removed tissue at the cut, the body's voxel straight inwards
/// from it counts, if it is within `opening_mm` and there is only tissue between. @pre all on one grid.
[[nodiscard]] std::vector<MadeVoxel> find_cut_voxels(const Mask& body, const WorkingVolume& work,
                                                     const VolumeGrid& scan, double opening_mm);

/// Returns, in the same way, the body's voxels where edits made the surface: they added the voxel, or removed the one
/// beyond it.
[[nodiscard]] std::vector<MadeVoxel> find_painted_voxels(const Mask& body, const WorkingVolume& work,
                                                         double opening_mm);

/// Returns, for each of these voxels, the first voxel of the smoothed body straight inwards from it, because smoothing
/// moves a curved surface; drops voxels without one.
/// @param smoothed  covers a part of the grid `from`. @param reach_mm  greatest distance to search.
[[nodiscard]] std::vector<MadeVoxel> carried_to_surface(const std::vector<MadeVoxel>& made, const VolumeGrid& from,
                                                        const Mask& smoothed, double reach_mm);

/// A box of voxel indices: low <= index < high.
struct IndexBox {
  std::array<int, 3> low;
  std::array<int, 3> high;
};
/// Returns the smallest box that contains the mask's voxels. @throws InvalidArgument if there are none.
[[nodiscard]] IndexBox box_of(const Mask& mask);

/// Returns the voxels of a box. @pre the box lies inside the volume's grid.
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
