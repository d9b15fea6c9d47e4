#pragma once

#include <incise/geometry/types.hpp>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace incise {

/// One point found near another.
struct Neighbour {
  std::size_t index = 0;
  double squared_mm2 = 0.0;  ///< squared distance
};

/// Finds nearest points in a fixed cloud (kd-tree). Copies the points. Results are sorted by distance, then by index.
/// Several threads may query at once. Build O(n log n), query O(log n) typical.
class NeighbourSearch {
 public:
  /// @pre at least one point, all finite.
  explicit NeighbourSearch(std::span<const Vec3> points);

  [[nodiscard]] Neighbour nearest(const Vec3& p) const;
  /// Returns the `count` nearest points, or all points if there are fewer.
  [[nodiscard]] std::vector<Neighbour> nearest(const Vec3& p, std::size_t count) const;
  /// Returns all points closer than `radius_mm`, which must be >= 0.
  [[nodiscard]] std::vector<Neighbour> within(const Vec3& p, double radius_mm) const;

 private:
  struct Tree;
  std::shared_ptr<Tree> tree_;  ///< shared with copies; does not change once built
};

}  // namespace incise
