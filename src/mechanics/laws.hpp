#pragma once

#include <incise/mechanics/tissue.hpp>

namespace incise {

/// One tet's deformation gradient F and the proper rotation R nearest to it.
struct Deformation {
  Mat3 f = Mat3::Identity();
  Mat3 r = Mat3::Identity();
};

// Every isotropic law is a sum Ψ = Ψ_shape(F) + λ/2 θ(F)², so θ can be averaged over neighbouring tets. Energy
// densities are in kPa (= µJ/mm³). Equations and sources: docs/models/elasticity.md.

/// The isotropic law of one tet.
struct ShapeLaw {
  MaterialModel model = MaterialModel::Corotational;
  double mu_kpa = 0.0;
  double stiffening = 0.0;  ///< c20/c10 of Yeoh's law; > 0 for StableNeoHookean only
};

/// Returns the change of volume θ that λ resists: tr(Rᵀ F) − 3 (corotational) or det F − 1 (stable Neo-Hookean).
[[nodiscard]] double dilation(MaterialModel model, const Deformation& deformation);
/// Returns ∂θ/∂F: R or the cofactors of F.
[[nodiscard]] Mat3 dilation_gradient(MaterialModel model, const Deformation& deformation);
/// Returns Ψ_shape, kPa; 0 at rest.
[[nodiscard]] double shape_energy_kpa(const ShapeLaw& law, const Deformation& deformation);
/// Returns the first Piola stress ∂Ψ_shape/∂F, kPa.
[[nodiscard]] Mat3 shape_stress_kpa(const ShapeLaw& law, const Deformation& deformation);

/// ∂²Ψ/∂F² of one tet in its principal directions, F = U diag(σ) Vᵀ. There the tangent of an isotropic law decouples:
/// the three changes of σ are coupled with one another only, and so is each pair of off-diagonal changes (M_ij, M_ji)
/// of M = Uᵀ dF V. Projection is therefore cheap: a 3 x 3 matrix and six numbers instead of a 9 x 9 matrix.
struct PrincipalTangent {
  Mat3 u = Mat3::Identity();
  Mat3 v = Mat3::Identity();
  Mat3 stretch = Mat3::Zero();   ///< ∂²Ψ/∂σ_i∂σ_j
  Vec3 straight = Vec3::Zero();  ///< entry k: ∂²Ψ/∂M_ij² of the pair (i, j) of the other two directions
  Vec3 crossed = Vec3::Zero();   ///< entry k: ∂²Ψ/∂M_ij∂M_ji of that pair
};

/// Returns the tangent of Ψ_shape + p θ + k/2 (dθ)². With volume per tet, k = λ and p = λ θ; with averaged volume, k =
/// 0 and p is the mean pressure of its corners. For a law without rotations, `FrozenRotations` means `Projected`.
[[nodiscard]] PrincipalTangent principal_tangent(const ShapeLaw& law, double p_kpa, double k_kpa,
                                                 const Deformation& deformation, Tangent tangent);

/// Returns block (a, b) of the stiffness per volume: the tangent contracted with the shape gradients Vᵀ g_a and Vᵀ g_b.
[[nodiscard]] Mat3 stiffness_block(const PrincipalTangent& tangent, const Vec3& a, const Vec3& b);

/// Law of fibres along the unit direction a at rest, with the strain e = |F a| − 1 and the stiffening s: Ψ_f = E_f/2 e²
/// in compression and E_f/(2s) (exp(s e²) − 1) in tension (s = 0: E_f/2 e²). Beyond s e² = kMostFibreExponent the force
/// continues linearly, with the slope at that point.
struct FibreLaw {
  double modulus_kpa = 0.0;
  double stiffening = 0.0;
};
inline constexpr double kMostFibreExponent = 5.0;

[[nodiscard]] double fibre_energy_kpa(const FibreLaw& law, const Vec3& fibre, const Mat3& f);
[[nodiscard]] Mat3 fibre_stress_kpa(const FibreLaw& law, const Vec3& fibre, const Mat3& f);
/// Returns H with d(P a) = H d(F a), kPa; unless `tangent` is Exact, its negative curvatures are set to zero.
[[nodiscard]] Mat3 fibre_tangent_kpa(const FibreLaw& law, const Vec3& fibre, const Mat3& f, Tangent tangent);

}  // namespace incise
