#pragma once

#include <incise/geometry/types.hpp>
#include <incise/mechanics/material.hpp>

namespace incise {

/// Returns the principal first Piola stresses, kPa, of a homogeneous state with these principal stretches (> 0), from
/// the law's energy in terms of the stretches. Fibres along the first axis add E_f(s_1 − 1). Corotational:
/// 2μ(s_i − 1) + λ(Σ s − 3). Stable Neo-Hookean [Smith, de Goes and Kim 2018, eq. 14, with parameters matched to small
/// strains]: μ' s_i (1 − 1/(Σ s² + 1)) + λ'(J − α) J / s_i, μ' = 4μ/3, λ' = λ + 5μ/6, α = 1 + μ'/λ' − μ'/(4λ').
/// @throws InvalidArgument for fibres in another direction, or stiffening.
[[nodiscard]] Vec3 principal_stress_kpa(const Material& material, const Vec3& stretches);

/// Returns the transverse stretch s of a bar stretched to `along`, sides free: root of P_3(along, s, s) = 0.
[[nodiscard]] double free_stretch_of_bar(const Material& material, double along);
/// Returns the stretch s through a sheet stretched to `along` both ways, faces free: root of P_3(along, along, s) = 0.
[[nodiscard]] double free_stretch_of_sheet(const Material& material, double along);

/// Returns the stress P_xy, kPa, of the simple shear x = X + γ Y. Corotational, with tan θ = γ/2:
/// 2μ(γ − sin θ) + λ(√(4 + γ²) − 2) sin θ. Stable Neo-Hookean: μ' γ (1 − 1/(4 + γ²)).
[[nodiscard]] double simple_shear_stress_kpa(const Material& material, double shear);

/// Returns the tip displacement, mm, of a clamped beam under a force per width (mN/mm) across its free end: bending
/// F L³/3EI plus shear F L/(5/6 G A) [Timoshenko and Goodier, Theory of Elasticity, 3rd ed., sec. 21; shear factor of a
/// rectangle at ν = 0].
[[nodiscard]] double beam_tip_mm(double length_mm, double height_mm, double youngs_modulus_kpa, double force_per_width);

/// Returns the radial displacement, mm, at radius r of a hollow sphere (radii a < b, mm) under inner pressure p, small
/// strains: p a³ / (E (b³ − a³)) ((1 − 2ν) r + (1 + ν) b³ / (2 r²)) [Lamé 1852; Timoshenko and Goodier, sec. 136].
[[nodiscard]] double sphere_displacement_mm(double r, double a, double b, double pressure_kpa,
                                            double youngs_modulus_kpa, double nu);

/// Returns the exponent α of the displacement r^α at a corner of interior angle ω (radians), one side clamped and one
/// free, plane strain: the root in [0.3, 1] of sin²(αω) = ((κ + 1)² − 4 α² sin²ω) / (4κ), κ = 3 − 4ν [Williams 1952,
/// eq. 17].
[[nodiscard]] double corner_exponent(double angle, double nu);

}  // namespace incise
