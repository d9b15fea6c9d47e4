#pragma once

#include <incise/geometry/tet_mesh.hpp>
#include <incise/workflow/inputs.hpp>

#include <cmath>
#include <stdexcept>

namespace incise::testing {

/// A coarse block of tissue, 44 x 50 x 10 mm, with a round tumour edge of radius 5 mm on it.
class BlockInputs : public Inputs {
 public:
  CtVolume read_ct(Monitor&) override { throw std::logic_error("this specimen comes as a mesh"); }
  std::optional<TetMesh> read_specimen_mesh(Monitor&) override { return make_block({44, 50, 10}, {30, 34, 7}); }
  std::optional<Contour> read_tumor_edge() override {
    Contour edge;
    for (int i = 0; i < 60; ++i) {
      const double angle = 2.0 * M_PI * i / 60.0;
      edge.points.emplace_back(22.0 + 5.0 * std::cos(angle), 24.0 + 5.0 * std::sin(angle), 10.0);
    }
    return edge;
  }
};

}  // namespace incise::testing
