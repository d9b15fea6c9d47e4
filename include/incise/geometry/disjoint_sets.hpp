#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace incise {

/// Disjoint sets of the numbers 0 to count - 1, each number alone at first (union-find with path halving). The lowest
/// member represents its set.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  /// Returns the lowest member of the set of i.
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// Merges the sets of a and b.
  void join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace incise
