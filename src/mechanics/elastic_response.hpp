#pragma once

#include <incise/mechanics/tissue.hpp>

namespace incise {

/// Deformation gradient F = Σ x_a g_aᵀ of one tet at the given positions.
[[nodiscard]] Mat3 deformation_gradient(const TissueModel& model, std::span<const Vec3> positions, std::size_t tet);

/// As the public one. `turning` is scratch, one matrix per tet.
void add_elastic_response(const TissueModel& model, TissueState& state, std::span<Vec3> forces, BlockMatrix* stiffness,
                          Tangent tangent, std::vector<Mat3>& turning, Workers& workers);

}  // namespace incise
