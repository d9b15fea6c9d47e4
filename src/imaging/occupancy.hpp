#pragma once

#include "imaging/segmentation_region.hpp"

#include <incise/core/workers.hpp>

namespace incise {

/// Share of every voxel that is tissue, [0, 1], from the CT's gray values near the body's border; see `segment`. All on
/// one grid.
[[nodiscard]] GrayVolume occupancy_from_gray(const CtVolume& hu, const Mask& region, const Mask& body,
                                             const SegmentationSettings& settings, Workers& workers);

/// Volume, mm³, where the trilinear interpolation of the values between voxel centres is at least `level`.
[[nodiscard]] double iso_volume_mm3(const GrayVolume& values, double level, Workers& workers);

}  // namespace incise
