#include "mechanics/held_axes.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise {

std::uint8_t held_axes(const TissueModel& model, const BlockMatrix& matrix, std::span<const std::uint8_t> also_held,
                       std::size_t v) {
  constexpr std::uint8_t kAll = 7;
  if (!also_held.empty() && also_held[v] != 0) return kAll;
  const double* diagonal = matrix.block(model.pattern->diagonal[v]);
  if (std::all_of(diagonal, diagonal + 9, [](double k) { return k == 0.0; })) return kAll;
  std::uint8_t axes = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (model.is_fixed[v][i]) axes = static_cast<std::uint8_t>(axes | (1U << i));
  }
  return axes;
}

void hold_right_side(std::uint8_t axes, Vec3& right_side) {
  for (int i = 0; i < 3; ++i) {
    if ((axes >> i & 1) != 0) right_side[i] = 0.0;
  }
}

void hold_row(BlockMatrix& matrix, std::span<const std::uint8_t> held, std::size_t row) {
  const BlockPattern& pattern = *matrix.pattern;
  for (auto slot = pattern.row_start[row]; slot < pattern.row_start[row + 1]; ++slot) {
    const auto column = static_cast<std::size_t>(pattern.column[static_cast<std::size_t>(slot)]);
    if ((held[row] | held[column]) == 0) continue;
    double* block = matrix.block(slot);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        const bool is_held = (held[row] >> i & 1U) != 0 || (held[column] >> j & 1U) != 0;
        if (is_held) block[3 * i + j] = row == column && i == j ? 1.0 : 0.0;
      }
    }
  }
}

void hold_constrained(const TissueModel& model, BlockMatrix& matrix, std::span<Vec3> right_side,
                      std::span<const std::uint8_t> also_held) {
  const std::size_t count = model.pattern->rows();
  INCISE_REQUIRE(matrix.pattern == model.pattern, "expected a matrix of the model's own pattern");
  INCISE_REQUIRE(
      right_side.size() == count && (also_held.empty() || also_held.size() == count),
      fmt::format("expected {} vertices, found {} and {} flags", count, right_side.size(), also_held.size()));
  std::vector<std::uint8_t> held(count);
  for (std::size_t v = 0; v < count; ++v) held[v] = held_axes(model, matrix, also_held, v);

  for (std::size_t row = 0; row < count; ++row) {
    hold_right_side(held[row], right_side[row]);
    hold_row(matrix, held, row);
  }
}

}  // namespace incise
