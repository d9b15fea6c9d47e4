#pragma once

#include <incise/mechanics/tissue.hpp>

namespace incise {

/// Deformation gradient F = Σ x_a g_aᵀ of one tet at the given positions.
[[nodiscard]] Mat3 deformation_gradient(const TissueModel& model, std::span<const Vec3> positions, std::size_t tet);

/// Which derivative of the elastic forces is wanted.
enum class Tangent {
  FrozenRotations,  ///< rotations held: positive semi-definite, cheap, exact at zero strain
  Exact,            ///< with the turn of the rotations: the Hessian of the energy
  Projected,        ///< as Exact, each tet's negative curvatures set to zero: positive semi-definite
};

/// As add_elastic_response, with a choice of tangent.
void add_elastic_response(const TissueModel& model, TissueState& state, std::span<Vec3> forces, BlockMatrix* stiffness,
                          Tangent tangent, Workers& workers);

}  // namespace incise
