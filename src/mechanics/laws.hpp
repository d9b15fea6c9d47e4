#pragma once

#include <incise/mechanics/tissue.hpp>

namespace incise {

/// One tet's deformation gradient F and the proper rotation R nearest to it.
struct Deformation {
  Mat3 f = Mat3::Identity();
  Mat3 r = Mat3::Identity();
};

// Every isotropic law is a sum Ψ = Ψ_shape(F) + λ/2 θ(F)², so that θ may be averaged over neighbouring tets. Energy
// densities are in kPa (= µJ/mm³). Equations and sources: docs/models/elasticity.md.

/// The isotropic law of one tet.
struct ShapeLaw {
  MaterialModel model = MaterialModel::Corotational;
  double mu_kpa = 0.0;
  double stiffening = 0.0;  ///< c20/c10 of Yeoh's law; > 0 for StableNeoHookean alone
};

/// Change of volume θ that the law's λ resists: tr(Rᵀ F) − 3 (corotational) or det F − 1 (stable Neo-Hookean).
[[nodiscard]] double dilation(MaterialModel model, const Deformation& deformation);
/// ∂θ/∂F: R or the cofactors of F.
[[nodiscard]] Mat3 dilation_gradient(MaterialModel model, const Deformation& deformation);
/// Ψ_shape, 0 at rest.
[[nodiscard]] double shape_energy_kpa(const ShapeLaw& law, const Deformation& deformation);
/// ∂Ψ_shape/∂F, first Piola.
[[nodiscard]] Mat3 shape_stress_kpa(const ShapeLaw& law, const Deformation& deformation);

/// ∂²Ψ/∂F² of one tet seen along its principal directions, F = U diag(σ) Vᵀ. An isotropic law falls apart there: the
/// three changes of σ are coupled among themselves, and each pair of off-diagonal changes (M_ij, M_ji) is on its own.
/// This makes projection cheap: a 3 x 3 matrix and six numbers in place of a 9 x 9 matrix.
struct PrincipalTangent {
  Mat3 u = Mat3::Identity();
  Mat3 v = Mat3::Identity();
  Mat3 stretch = Mat3::Zero();   ///< ∂²Ψ/∂σ_i∂σ_j
  Vec3 straight = Vec3::Zero();  ///< ∂²Ψ/∂M_ij² of the pair (i, j), listed under the third direction
  Vec3 crossed = Vec3::Zero();   ///< ∂²Ψ/∂M_ij∂M_ji of the same
};

/// Tangent of Ψ_shape + p θ + k/2 (dθ)²: what a tet has of its own volume (k = λ, p = λ θ), or what is left to it when
/// volume is averaged (k = 0, p = mean pressure of its corners). `FrozenRotations` of a law without rotations is
/// `Projected`.
[[nodiscard]] PrincipalTangent principal_tangent(const ShapeLaw& law, double p_kpa, double k_kpa,
                                                 const Deformation& deformation, Tangent tangent);

/// Block (a, b) of the stiffness per volume: contraction of the tangent with the shape gradients Vᵀ g_a and Vᵀ g_b.
[[nodiscard]] Mat3 stiffness_block(const PrincipalTangent& tangent, const Vec3& a, const Vec3& b);

/// Fibres along the unit direction a at rest, e = |F a| − 1: Ψ_f = E_f/2 e² in compression, E_f/(2s) (exp(s e²) − 1) in
/// tension, with the stiffening s; 0: E_f/2 e² in tension, too. Beyond s e² = kMostFibreExponent the force grows with
/// the slope that it has there.
struct FibreLaw {
  double modulus_kpa = 0.0;
  double stiffening = 0.0;
};
inline constexpr double kMostFibreExponent = 5.0;

[[nodiscard]] double fibre_energy_kpa(const FibreLaw& law, const Vec3& fibre, const Mat3& f);
[[nodiscard]] Mat3 fibre_stress_kpa(const FibreLaw& law, const Vec3& fibre, const Mat3& f);
/// H with d(P a) = H d(F a); without its negative curvatures unless `tangent` is Exact.
[[nodiscard]] Mat3 fibre_tangent_kpa(const FibreLaw& law, const Vec3& fibre, const Mat3& f, Tangent tangent);

}  // namespace incise
