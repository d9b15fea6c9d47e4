#pragma once

#include <incise/geometry/types.hpp>
#include <incise/mechanics/material.hpp>

namespace incise {

/// Principal first Piola stresses, kPa, of a homogeneous state with these principal stretches (> 0), from the law's
/// energy written in the stretches; fibres, if any, lie along the first and add E_f(s_1 − 1). Corotational: 2μ(s_i − 1)
/// + λ(Σ s − 3). Stable Neo-Hookean [Smith, de Goes and Kim 2018, eq. 14, its parameters matched to small strains]: μ'
/// s_i (1 − 1/(Σ s² + 1)) + λ'(J − α) J / s_i, μ' = 4μ/3, λ' = λ + 5μ/6, α = 1 + μ'/λ' − μ'/(4λ').
[[nodiscard]] Vec3 principal_stress_kpa(const Material& material, const Vec3& stretches);

/// The stretch across a bar pulled to `along` whose sides are free: root of P_3(along, s, s) = 0 by bisection.
[[nodiscard]] double free_stretch_of_bar(const Material& material, double along);
/// The stretch through a sheet pulled to `along` both ways whose faces are free: root of P_3(along, along, s) = 0.
[[nodiscard]] double free_stretch_of_sheet(const Material& material, double along);

/// Stress P_xy, kPa, of the simple shear x = X + γ Y. Corotational, tan θ = γ/2: 2μ(γ − sin θ) + λ(√(4 + γ²) − 2) sin
/// θ. Stable Neo-Hookean: μ' γ (1 − 1/(4 + γ²)).
[[nodiscard]] double simple_shear_stress_kpa(const Material& material, double shear);

/// Tip displacement, mm, of a clamped beam of height h under a force per width (mN/mm) across its free end; bending
/// F L³/3EI and shear F L/(5/6 G A) [Timoshenko and Goodier, Theory of Elasticity, 3rd ed., sec. 21; shear factor of a
/// rectangle at ν = 0].
[[nodiscard]] double beam_tip_mm(double length_mm, double height_mm, double youngs_modulus_kpa, double force_per_width);

/// Radial displacement, mm, at radius r of a hollow sphere (radii a < b) under inner pressure p, small strains: p a³ /
/// (E (b³ − a³)) ((1 − 2ν) r + (1 + ν) b³ / (2 r²)) [Lamé 1852; Timoshenko and Goodier, sec. 136].
[[nodiscard]] double sphere_displacement_mm(double r, double a, double b, double pressure_kpa,
                                            double youngs_modulus_kpa, double nu);

/// Exponent α of the displacement r^α at a corner of interior angle ω (radians) with one side clamped and one free,
/// plane strain: smallest positive root of sin²(αω) = ((κ + 1)² − 4 α² sin²ω) / (4κ), κ = 3 − 4ν [Williams 1952, eq.
/// 17].
[[nodiscard]] double corner_exponent(double angle, double nu);

}  // namespace incise
