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

/// Nearest points in a fixed cloud (kd-tree). Copies the points. Answers come nearest first, ties by index, and may be
/// asked for from several threads at once. Build O(n log n), query O(log n) typical.
class NeighbourSearch {
 public:
  /// @pre at least one point, all finite.
  explicit NeighbourSearch(std::span<const Vec3> points);
  ~NeighbourSearch();
  NeighbourSearch(NeighbourSearch&&) noexcept;
  NeighbourSearch& operator=(NeighbourSearch&&) noexcept;

  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] Neighbour nearest(const Vec3& p) const;
  /// The `count` nearest points, or all there are.
  [[nodiscard]] std::vector<Neighbour> nearest(const Vec3& p, std::size_t count) const;
  /// All points closer than `radius_mm`.
  [[nodiscard]] std::vector<Neighbour> within(const Vec3& p, double radius_mm) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace incise
