#pragma once

#include "second_bench/holder.hpp"

#include <incise/imaging/tongue_shape.hpp>
#include <incise/second_bench/body.hpp>

#include <optional>

namespace incise::second_bench {

/// The state of a specimen in its holder.
struct BodyState {
  BrickTissue tissue;
  Platform platform;
  TongueShape shape;
  std::vector<std::optional<TissueSpan>> columns;  ///< per column of voxels, x fastest; nullopt: no tissue
  std::vector<float> energy_j;                     ///< per brick: heat that parts one of its voxels
  Points tumor_edge_rest;                          ///< counter-clockwise seen from above, mm
  std::vector<std::int32_t> suture_nodes;          ///< nodes that the suture holds
  float viscous_ratio = 0.0F;                      ///< as of begin_step()
  float viscous_time_s = 1.0F;

  [[nodiscard]] int columns_x() const { return kVoxelsAcross * tissue.grid.bricks_along(0); }
  [[nodiscard]] int columns_y() const { return kVoxelsAcross * tissue.grid.bricks_along(1); }
};

}  // namespace incise::second_bench
