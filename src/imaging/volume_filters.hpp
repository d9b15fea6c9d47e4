#pragma once

#include <incise/core/workers.hpp>
#include <incise/geometry/volume.hpp>

#include <cstdint>

namespace incise {

/// 1 = in the set, 0 = not.
using Mask = Volume<std::uint8_t>;

/// Pieces of a mask joined through voxel faces.
struct Pieces {
  Volume<std::int32_t> number;  ///< 0 outside the mask, else 1..count in the order of their first voxels
  std::int32_t count = 0;
};

[[nodiscard]] Pieces find_pieces(const Mask& mask);

/// Distance, in units of the grid's spacing, of every voxel's centre to the nearest centre in the mask (0 inside);
/// +infinity everywhere for an empty mask. Exact; O(voxels).
[[nodiscard]] GrayVolume distance_to(const Mask& mask, Workers& workers);

/// Convolution with a Gaussian of standard deviation `sigma`, in units of the grid's spacing; values repeat beyond the
/// border. 0 returns the input.
[[nodiscard]] GrayVolume gaussian(GrayVolume volume, double sigma, Workers& workers);

/// The voxels that are not in the mask.
[[nodiscard]] Mask complement(const Mask& mask);

}  // namespace incise
