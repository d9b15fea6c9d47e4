#pragma once

#include "support/contour_shapes.hpp"

#include <incise/geometry/tet_mesh.hpp>
#include <incise/workflow/case.hpp>
#include <incise/workflow/inputs.hpp>

#include <stdexcept>

namespace incise::testing {

/// A coarse block of tissue, 44 x 50 x 10 mm, with a round tumour edge of radius 5 mm on it.
class BlockInputs : public Inputs {
 public:
  CtVolume read_ct(Monitor&) override { throw std::logic_error("this specimen comes as a mesh"); }
  std::optional<TetMesh> read_specimen_mesh(Monitor&) override { return make_block({44, 50, 10}, {30, 34, 7}); }
  std::optional<Contour> read_tumor_edge() override { return circle(5.0, 60, Vec3(22, 24, 10)); }
};

/// The paper's loop on that block: a thick needle, so that a quarter of a minute is enough.
inline Case coarse_case() {
  Case settings;
  settings.gravity_mm_s2 = Vec3::Zero();
  settings.constraints = std::vector<Constraint>{
      FixedConstraint{EndRegion{Vec3::UnitY(), 4.0}},
      DisplacedConstraint{EndRegion{-Vec3::UnitY(), 4.0}, Vec3(0.0, -5.0, 0.0)},
      FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(45, 51, 0.1))}, {false, false, true}}};
  settings.tool = Needle{.diameter_mm = 1.6};
  settings.cut.reach_mm = 0.4;
  settings.cut.advance_per_step_mm = 0.8;
  settings.cut.dullness = 9.0;
  settings.cut.bond_stiffness_kpa_mm2 = 100.0;
  settings.frames = 0;
  return settings;
}

}  // namespace incise::testing
