#pragma once

#include <incise/mechanics/tissue.hpp>

#include <algorithm>

namespace incise {

/// Calls body(tet, corner) for each live tet that has vertex v as a corner, ascending.
template <class Body>
void for_live_corners(const TissueModel& model, const TissueState& state, std::size_t v, const Body& body) {
  for (const std::int32_t entry : model.corners_at(v)) {
    const std::size_t tet = static_cast<std::size_t>(entry) / 4;
    if (state.is_live[tet] != 0) body(tet, static_cast<std::size_t>(entry) % 4);
  }
}

/// Adds the four blocks of a tet in the row of `corner`. Block (b, a) is computed as the transpose of (a, b): symmetric
/// bit for bit.
/// @param block_of  block_of(a, b) returns a block with a <= b, per volume; symmetric if a == b.
template <class BlockOf>
void add_blocks(const TissueModel& model, const TissueState& state, std::size_t tet, std::size_t corner,
                BlockMatrix& matrix, const BlockOf& block_of) {
  for (std::size_t b = 0; b < 4; ++b) {
    Mat3 block = block_of(std::min(corner, b), std::max(corner, b));
    if (b < corner) block.transposeInPlace();
    matrix.at(model.tet_slots[tet][4 * corner + b]) += filled_volume_mm3(model, state, tet) * block;
  }
}

/// Returns the deformation gradient F = Σ x_a g_aᵀ of one tet at the given positions.
[[nodiscard]] Mat3 deformation_gradient(const TissueModel& model, std::span<const Vec3> positions, std::size_t tet);

}  // namespace incise
