#include "meshing/voxel_grids.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

namespace incise::meshing_detail {

void require_sound(const VolumeGrid& grid, std::size_t voxels) {
  constexpr double kOrthonormalTolerance = 1e-4;
  const auto& n = grid.size;
  const Vec3& mm = grid.spacing_mm;
  if (n[0] <= 0 || n[1] <= 0 || n[2] <= 0) {
    throw InvalidArgument(
        fmt::format("volume: found {} x {} x {} voxels, expected at least 1 x 1 x 1", n[0], n[1], n[2]));
  }
  if (voxels != grid.voxel_count()) {
    throw InvalidArgument(fmt::format("volume: found {} values, expected {}", voxels, grid.voxel_count()));
  }
  if (!mm.allFinite() || !(mm.minCoeff() > 0.0)) {
    throw InvalidArgument(
        fmt::format("volume: found spacing {} {} {} mm, expected finite numbers > 0", mm.x(), mm.y(), mm.z()));
  }
  if (!grid.origin_mm.allFinite()) throw InvalidArgument("volume: found an origin that is not finite");
  const Mat3 should_be_identity = grid.direction.transpose() * grid.direction;
  if (!grid.direction.allFinite() ||
      !((should_be_identity - Mat3::Identity()).cwiseAbs().maxCoeff() < kOrthonormalTolerance)) {
    throw InvalidArgument("volume: found axes that are not orthonormal, expected a rotation or reflection");
  }
}

}  // namespace incise::meshing_detail
