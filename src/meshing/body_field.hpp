#pragma once

#include <incise/geometry/volume.hpp>

#include <array>
#include <cstddef>

namespace incise::meshing_detail {

/// Returns the value of a volume, interpolated trilinearly.
/// @param cell  the voxel with the lowest indices of the eight around the place.  @param f  place between them, [0, 1].
[[nodiscard]] double trilinear(const GrayVolume& volume, const std::array<int, 3>& cell, const Vec3& f);

/// What BodyField::largest_body kept and left out.
struct BodyReport {
  double volume_mm3 = 0.0;  ///< of the body kept: Σ occupancy x volume of a voxel
  std::size_t dropped_bodies = 0;
  double dropped_volume_mm3 = 0.0;
};

/// The occupancy of one body, cropped to its box, surrounded by zeros and interpolated trilinearly. Local coordinates
/// are in mm along the grid's axes from the centre of the first voxel: `world = origin + direction * local`.
class BodyField {
 public:
  /// Returns the largest face-connected component of voxels of at least 0.5, with the fainter voxels around it that are
  /// nearer to it than to another component. @throws InvalidArgument for values outside [0, 1] or not finite, a broken
  /// grid, or no voxel of at least 0.5.
  static BodyField largest_body(const GrayVolume& occupancy, BodyReport& report);

  [[nodiscard]] const VolumeGrid& grid() const { return volume_.grid; }
  [[nodiscard]] double value_at(const Vec3& local) const;  ///< 0 outside the box
  [[nodiscard]] float voxel(int i, int j, int k) const { return volume_.at(i, j, k); }
  /// Returns the box of all voxel centres, local coordinates.
  [[nodiscard]] Box3 box() const;
  [[nodiscard]] Vec3 local_from_index(const Vec3& index) const { return index.cwiseProduct(grid().spacing_mm); }
  [[nodiscard]] Vec3 world_from_local(const Vec3& local) const { return grid().origin_mm + grid().direction * local; }

  /// Returns at most `count` points where the iso surface crosses lines between neighbouring voxels, far from one
  /// another: each is at least `spacing_mm` from all before it, except among the first `least`. Local coordinates.
  [[nodiscard]] Points spread_surface_points(double iso, std::size_t count, std::size_t least, double spacing_mm) const;

 private:
  GrayVolume volume_;
};

}  // namespace incise::meshing_detail
