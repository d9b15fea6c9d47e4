#pragma once

#include <incise/mechanics/statics.hpp>
#include <incise/mechanics/tissue.hpp>

#include <cmath>

namespace incise::bench {

/// A 100 x 50 x 25 mm block, one end clamped, the other pulled 20 mm, on a platform: near `tets` tetrahedra of the paper's material.
inline TissueModel pulled_block(double tets) {
  const double cell_mm = std::cbrt(6.0 * 100.0 * 50.0 * 25.0 / tets);
  const auto cells = [cell_mm](double length_mm) { return static_cast<int>(std::lround(length_mm / cell_mm)); };
  return make_tissue_model(make_block({100, 50, 25}, {cells(100), cells(50), cells(25)}), Material{},
                           {FixedConstraint{EndRegion{-Vec3::UnitX(), 0.1}},
                            DisplacedConstraint{EndRegion{Vec3::UnitX(), 0.1}, Vec3(20, 0, 0)}, SupportConstraint{}});
}

}  // namespace incise::bench
