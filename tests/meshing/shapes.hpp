#pragma once

#include <incise/core/units.hpp>
#include <incise/geometry/contour.hpp>
#include <incise/geometry/tet_mesh.hpp>
#include <incise/geometry/volume.hpp>

#include <cmath>

namespace incise::testing {

/// Label 1 in every voxel whose centre lies in the ellipsoid with the given half axes around the origin.
inline LabelVolume ellipsoid_labels(const Vec3& half_axes_mm, double spacing_mm) {
  LabelVolume labels;
  labels.grid.spacing_mm = Vec3::Constant(spacing_mm);
  Vec3 last;
  for (int axis = 0; axis < 3; ++axis) {
    const int count = static_cast<int>(2.0 * half_axes_mm[axis] / spacing_mm) + 4;
    labels.grid.size[static_cast<std::size_t>(axis)] = count;
    last[axis] = count - 1;
  }
  labels.grid.origin_mm = -0.5 * spacing_mm * last;
  for (int k = 0; k < labels.grid.size[2]; ++k) {
    for (int j = 0; j < labels.grid.size[1]; ++j) {
      for (int i = 0; i < labels.grid.size[0]; ++i) {
        const Vec3 p = labels.grid.world_from_index(Vec3(i, j, k)).cwiseQuotient(half_axes_mm);
        labels.voxels.push_back(p.squaredNorm() < 1.0 ? 1 : 0);
      }
    }
  }
  return labels;
}

inline double ellipsoid_volume_mm3(const Vec3& half_axes_mm) {
  return 4.0 / 3.0 * units::kPi * half_axes_mm.prod();
}

/// A ring of `radius_mm` around the z axis, on the upper side of the ellipsoid.
inline Contour ring_on_ellipsoid(const Vec3& half_axes_mm, double radius_mm, std::size_t count = 48) {
  Contour ring;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2.0 * units::kPi * static_cast<double>(i) / static_cast<double>(count);
    const Vec2 flat = radius_mm * Vec2(std::cos(angle), std::sin(angle));
    const double left = 1.0 - flat.cwiseQuotient(half_axes_mm.head<2>()).squaredNorm();
    ring.points.emplace_back(flat.x(), flat.y(), half_axes_mm.z() * std::sqrt(left));
  }
  return ring;
}

/// The surface of the block [0, size], as 12 triangles.
inline TriMesh block_surface(const Vec3& size_mm) {
  TriMesh skin = boundary_surface(make_block(size_mm, {1, 1, 1}));
  return skin;
}

}  // namespace incise::testing
