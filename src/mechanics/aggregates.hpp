#pragma once

#include <incise/mechanics/block_matrix.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace incise {

/// Partition of vertices into aggregates of nearly equal size whose members lie close together.
struct Aggregates {
  std::vector<std::int32_t> start;      ///< A + 1, into `vertices`
  std::vector<std::int32_t> vertices;   ///< N, ascending within an aggregate
  std::vector<std::int32_t> of_vertex;  ///< N
  [[nodiscard]] std::size_t count() const { return start.empty() ? 0 : start.size() - 1; }
  [[nodiscard]] std::span<const std::int32_t> members(std::size_t aggregate) const {
    return list_of(start, vertices, aggregate);
  }
};

/// Divides the points into ceil(N / per_aggregate) aggregates by recursive bisection across the longest side of their
/// bounding box. @pre per_aggregate > 0.
[[nodiscard]] Aggregates bisect(std::span<const Vec3> positions, std::size_t per_aggregate);

}  // namespace incise
