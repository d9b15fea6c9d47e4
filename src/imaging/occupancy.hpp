#pragma once

#include "imaging/segmentation_region.hpp"

#include <incise/core/workers.hpp>

namespace incise {

/// Returns the fraction of every voxel that is tissue, [0, 1], from the CT's gray values near the body's border; see
/// `segment`. @pre all on one grid.
[[nodiscard]] GrayVolume occupancy_from_gray(const CtVolume& hu, const Mask& region, const Mask& body,
                                             const SegmentationSettings& settings, Workers& workers);

/// Returns the volume, mm³, in which the trilinear interpolation between voxel centres is at least `level`.
[[nodiscard]] double iso_volume_mm3(const GrayVolume& values, double level, Workers& workers);

}  // namespace incise
