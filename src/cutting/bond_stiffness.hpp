#pragma once

#include <cmath>

namespace incise {

/// Returns the bond stiffness with which tets of finite size transmit the same pull as the continuum of the law.
///
/// Held tissue follows the tool across a layer √(μ/κ) thick, which transmits √(μ κ) per area and offset to the body.
/// Linear elements of length h transmit √(μ κ (1 + κ h² / (12 μ))) instead (exact in one dimension): a coarser mesh
/// holds more firmly. To transmit √(μ κ) on every mesh, elements hold with the root κ_h of
/// κ_h (1 + κ_h h² / (12 μ)) = κ. Derivation, and accuracy in three dimensions: docs/models/cutting.md.
/// @param kappa_kpa_mm2  κ, bond stiffness of the continuum, kPa/mm², >= 0.
/// @param mu_kpa         μ, shear modulus of the tet, kPa, > 0.
/// @param edge_mm        h, root mean square of the tet's edges at rest, >= 0.
/// @returns κ_h, kPa/mm², in [0, κ].
[[nodiscard]] inline double resolved_bond_stiffness(double kappa_kpa_mm2, double mu_kpa, double edge_mm) {
  // The positive root, in a form without cancellation for fine meshes.
  return 2.0 * kappa_kpa_mm2 / (1.0 + std::sqrt(1.0 + kappa_kpa_mm2 * edge_mm * edge_mm / (3.0 * mu_kpa)));
}

}  // namespace incise
