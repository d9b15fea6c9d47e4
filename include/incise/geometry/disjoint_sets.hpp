#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace incise {

/// Sets of the numbers from 0 on, each at first alone, that grow together (union-find with halving of the ways). The
/// lowest member stands for a set.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  /// The number that stands for the set of i.
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace incise
