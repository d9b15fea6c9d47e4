#pragma once

#include <incise/mechanics/tissue.hpp>

namespace incise {

/// Returns the axes of one vertex whose equations are replaced, bit i for axis i: its constrained axes, or all if its
/// diagonal block is zero (no tet holds it) or if it is flagged in `also_held` (one flag per vertex, or empty).
[[nodiscard]] std::uint8_t held_axes(const TissueModel& model, const BlockMatrix& matrix,
                                     std::span<const std::uint8_t> also_held, std::size_t v);

/// Sets the right side to zero along the held axes.
void hold_right_side(std::uint8_t axes, Vec3& right_side);

/// Replaces, in one row of blocks, the rows and columns of all held axes (bits as above) by those of the identity.
void hold_row(BlockMatrix& matrix, std::span<const std::uint8_t> held, std::size_t row);

}  // namespace incise
