#pragma once

namespace incise {

/// The bond stiffness with which a tet of finite size holds tissue as firmly as the law means it for a continuum.
///
/// Held tissue follows the tool across a layer √(μ/κ) thick, and what the layer passes on to the body is √(μ κ) per area and offset.
/// Linear elements of length h that hold what they cover pass on √(μ κ (1 + κ h² / (12 μ))) instead, exactly, in one dimension: the coarser
/// the mesh, the firmer the hold. So that every mesh passes on √(μ κ), elements hold with the root κ_h of κ_h (1 + κ_h h² / (12 μ)) = κ.
/// Derivation, and what it is worth in three dimensions: docs/models/cutting.md.
/// @param kappa_kpa_mm2  κ, that of the continuum, kPa/mm², >= 0.
/// @param mu_kpa         μ, shear modulus of the tet, kPa, > 0.
/// @param edge_mm        h, root mean square of the tet's edges at rest, >= 0.
/// @returns κ_h, kPa/mm², in [0, κ].
[[nodiscard]] double resolved_bond_stiffness(double kappa_kpa_mm2, double mu_kpa, double edge_mm);

}  // namespace incise
