#pragma once

#include <incise/mechanics/tissue.hpp>

namespace incise {

/// Axes of one vertex whose equation is replaced, bit i for axis i: its constrained axes, or all of them when nothing
/// of the body pulls on it or when it is among `also_held` (one flag per vertex, or empty).
[[nodiscard]] std::uint8_t held_axes(const TissueModel& model, const BlockMatrix& matrix,
                                     std::span<const std::uint8_t> also_held, std::size_t v);

/// Zero along the held axes.
void hold_right_side(std::uint8_t axes, Vec3& right_side);

/// Identity rows and columns for the held axes of every vertex (bits as above), in one row of blocks.
void hold_row(BlockMatrix& matrix, std::span<const std::uint8_t> held, std::size_t row);

}  // namespace incise
