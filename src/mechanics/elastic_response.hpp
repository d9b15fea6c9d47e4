#pragma once

#include <incise/mechanics/tissue.hpp>

namespace incise {

/// Returns the deformation gradient F = Σ x_a g_aᵀ of one tet at the given positions.
[[nodiscard]] Mat3 deformation_gradient(const TissueModel& model, std::span<const Vec3> positions, std::size_t tet);

}  // namespace incise
