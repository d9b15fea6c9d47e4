#pragma once

#include <incise/core/describe.hpp>
#include <incise/geometry/types.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace incise {

/// A regular grid of voxels in space. World coordinates are mm, LPS (x to the patient's left, y posterior, z superior):
/// `world = origin + direction * (spacing ∘ index)`, where index (0, 0, 0) is the *centre* of the first voxel.
struct VolumeGrid {
  std::array<int, 3> size{0, 0, 0};         ///< voxels along i, j, k
  Vec3 spacing_mm = Vec3::Ones();           ///< > 0
  Vec3 origin_mm = Vec3::Zero();            ///< centre of voxel (0, 0, 0)
  Mat3 direction = Mat3::Identity();        ///< orthonormal; columns are the unit i, j, k axes in world coordinates

  [[nodiscard]] std::size_t voxel_count() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]);
  }
  [[nodiscard]] double voxel_volume_mm3() const { return spacing_mm.prod(); }
  /// Position of voxel (i, j, k) in the array: i runs fastest, then j, then k.
  [[nodiscard]] std::size_t offset(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(size[0]) *
               (static_cast<std::size_t>(j) + static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(k));
  }
  /// The voxel (i, j, k) at a position in the array: the inverse of `offset`.
  [[nodiscard]] std::array<int, 3> voxel_at(std::size_t offset) const {
    const auto nx = static_cast<std::size_t>(size[0]), ny = static_cast<std::size_t>(size[1]);
    return {static_cast<int>(offset % nx), static_cast<int>(offset / nx % ny), static_cast<int>(offset / (nx * ny))};
  }
  [[nodiscard]] bool contains(int i, int j, int k) const {
    return i >= 0 && j >= 0 && k >= 0 && i < size[0] && j < size[1] && k < size[2];
  }
  /// World position, mm, of a (continuous) index.
  [[nodiscard]] Vec3 world_from_index(const Vec3& index) const {
    return origin_mm + direction * spacing_mm.cwiseProduct(index);
  }
  /// Continuous index of a world position, mm.
  [[nodiscard]] Vec3 index_from_world(const Vec3& world) const {
    return (direction.transpose() * (world - origin_mm)).cwiseQuotient(spacing_mm);
  }
};
inline void describe(Visitor& v, VolumeGrid& g) {
  v("size", g.size, "Number of voxels along i, j, k.");
  v("spacing_mm", g.spacing_mm, "Spacing of the voxels along i, j, k.");
  v("origin_mm", g.origin_mm, "Centre of voxel (0, 0, 0).");
  v("direction", g.direction, "Columns: the unit i, j, k axes in world coordinates.");
}

/// A grid with one value per voxel.
template <class Value>
struct Volume {
  VolumeGrid grid;
  std::vector<Value> voxels;  ///< grid.voxel_count() values, i fastest

  [[nodiscard]] Value at(int i, int j, int k) const { return voxels[grid.offset(i, j, k)]; }
  [[nodiscard]] Value& at(int i, int j, int k) { return voxels[grid.offset(i, j, k)]; }
};
template <class Value>
void describe(Visitor& v, Volume<Value>& volume) {
  v("grid", volume.grid, "Grid of the voxels.");
  v("voxels", volume.voxels, "Values, i fastest.");
}

/// CT in Hounsfield units. Voxels outside the scanner's field of view (padding) are air, -1024 HU.
using CtVolume = Volume<std::int16_t>;

/// 0 = background, 1 = tissue; further labels as the user states them.
using LabelVolume = Volume<std::uint8_t>;

/// Grey values of any meaning, as floats.
using GrayVolume = Volume<float>;

inline constexpr std::int16_t kAirHu = -1024;

}  // namespace incise
