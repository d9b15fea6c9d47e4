#pragma once

#include <incise/core/workers.hpp>
#include <incise/geometry/volume.hpp>

#include <algorithm>
#include <cstdint>

namespace incise {

/// 1 = in the set, 0 = not.
using Mask = Volume<std::uint8_t>;

/// Returns the voxels for whose value the condition holds.
template <class Value, class Condition>
[[nodiscard]] Mask mask_where(const Volume<Value>& volume, const Condition& holds) {
  Mask mask{volume.grid, std::vector<std::uint8_t>(volume.voxels.size())};
  std::ranges::transform(volume.voxels, mask.voxels.begin(),
                         [&](Value value) { return static_cast<std::uint8_t>(holds(value)); });
  return mask;
}

/// The face-connected pieces of a mask.
struct Pieces {
  Volume<std::int32_t> number;  ///< 0 outside the mask, else 1..count in the order of their first voxels
  std::int32_t count = 0;
};

[[nodiscard]] Pieces find_pieces(const Mask& mask);

/// Returns the distance, in the unit of the grid's spacing, from every voxel's centre to the nearest centre in the mask
/// (0 inside); +infinity everywhere for an empty mask. Exact; O(voxels).
[[nodiscard]] GrayVolume distance_to(const Mask& mask, Workers& workers);

/// Convolves with a Gaussian of standard deviation `sigma`, in the unit of the grid's spacing; values repeat beyond the
/// border. 0 returns the input.
[[nodiscard]] GrayVolume gaussian(GrayVolume volume, double sigma, Workers& workers);

/// Returns the voxels that are not in the mask.
[[nodiscard]] Mask complement(const Mask& mask);

}  // namespace incise
