#include "meshing/voxel_grids.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/gaussian.hpp>
#include <incise/meshing/occupancy.hpp>

#include <fmt/format.h>

namespace incise {

GrayVolume occupancy_of(const LabelVolume& labels, double sigma_voxels) {
  meshing_detail::require_sound(labels.grid, labels.voxels.size());
  INCISE_REQUIRE(sigma_voxels >= 0.0 && sigma_voxels <= 10.0,
                 fmt::format("sigma_voxels: found {}, expected 0 to 10", sigma_voxels));
  const auto is_labelled = [&](std::size_t at) { return labels.voxels[at] != 0; };
  const Eigen::AlignedBox3i box = meshing_detail::box_of_voxels(labels.grid, is_labelled);
  INCISE_REQUIRE(!box.isEmpty(), "labels: found no voxel other than 0, expected a labelled body");
  GrayVolume result = meshing_detail::cut_out(labels.grid, box, gaussian_reach(sigma_voxels) + 1,
                                              [&](std::size_t at) { return is_labelled(at) ? 1.0F : 0.0F; });
  blur(result, sigma_voxels);
  return result;
}

}  // namespace incise
