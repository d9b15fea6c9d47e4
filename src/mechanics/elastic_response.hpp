#pragma once

#include <incise/mechanics/tissue.hpp>

namespace incise {

/// Calls body(tet, corner) for each live tet that has vertex v as a corner, ascending.
template <class Body>
void for_live_corners(const TissueModel& model, const TissueState& state, std::size_t v, const Body& body) {
  for (const std::int32_t entry : model.corners_at(v)) {
    const std::size_t tet = static_cast<std::size_t>(entry) / 4;
    if (state.is_live[tet] != 0) body(tet, static_cast<std::size_t>(entry) % 4);
  }
}

/// Returns the deformation gradient F = Σ x_a g_aᵀ of one tet at the given positions.
[[nodiscard]] Mat3 deformation_gradient(const TissueModel& model, std::span<const Vec3> positions, std::size_t tet);

}  // namespace incise
