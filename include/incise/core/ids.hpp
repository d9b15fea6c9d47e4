#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>

namespace incise {

/// Index into one kind of array, as a distinct type: a VertexId cannot be passed where a TetId is meant.
/// Holds 32 bits; -1 means "none".
template <class Tag>
struct Id {
  std::int32_t value = -1;

  constexpr Id() = default;
  constexpr explicit Id(std::size_t position) : value(static_cast<std::int32_t>(position)) {}

  /// Position in the array. @pre is_valid().
  [[nodiscard]] constexpr std::size_t index() const { return static_cast<std::size_t>(value); }
  [[nodiscard]] constexpr bool is_valid() const { return value >= 0; }

  constexpr auto operator<=>(const Id&) const = default;
};

using VertexId = Id<struct VertexTag>;
using TetId = Id<struct TetTag>;
using TriangleId = Id<struct TriangleTag>;

}  // namespace incise
