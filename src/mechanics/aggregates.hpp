#pragma once

#include <incise/geometry/types.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace incise {

/// Vertices in groups of near-equal size that lie close together.
struct Aggregates {
  std::vector<std::int32_t> start;      ///< A + 1, into `vertices`
  std::vector<std::int32_t> vertices;   ///< N, ascending within an aggregate
  std::vector<std::int32_t> of_vertex;  ///< N
  [[nodiscard]] std::size_t count() const { return start.empty() ? 0 : start.size() - 1; }
};

/// Recursive bisection across the longest side of the box around the points, into ceil(N / per_aggregate) groups. @pre
/// per_aggregate > 0.
[[nodiscard]] Aggregates bisect(std::span<const Vec3> positions, std::size_t per_aggregate);

}  // namespace incise
