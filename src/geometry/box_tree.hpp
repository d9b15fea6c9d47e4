#pragma once

#include <incise/geometry/types.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace incise {

/// Bounding volume hierarchy over boxes: median split along the longest side, nodes in one flat array, left child next
/// to its parent. The same boxes always give the same tree.
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(const std::vector<Box3>& boxes);

  [[nodiscard]] const Box3& box() const { return nodes_[0].box; }

  /// Calls visit(item) for every item whose leaf and its ancestors pass `accepts(box)`. `accepts` is called before each
  /// descent, so it may become stricter when `visit` finds something. The child with the lower `rank(box)` comes first.
  template <class Accepts, class Rank, class Visit>
  void traverse(const Accepts& accepts, const Rank& rank, const Visit& visit) const {
    std::array<std::uint32_t, kMaxDepth> stack{};
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const std::uint32_t at = stack[--depth];
      const Node& node = nodes_[at];
      if (!accepts(node.box)) continue;
      if (node.count > 0) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) visit(items_[i]);
        continue;
      }
      const std::uint32_t left = at + 1;
      const bool left_first = rank(nodes_[left].box) <= rank(nodes_[node.right].box);
      stack[depth++] = left_first ? node.right : left;
      stack[depth++] = left_first ? left : node.right;
    }
  }

 private:
  // Halving 2^32 items takes 32 levels; each level leaves at most one node waiting on the stack.
  static constexpr std::size_t kMaxDepth = 64;
  static constexpr std::uint32_t kLeafSize = 4;

  struct Node {
    Box3 box;
    std::uint32_t first = 0;  // leaf: first item
    std::uint32_t count = 0;  // leaf: number of items; inner node: 0
    std::uint32_t right = 0;  // inner node: right child
  };

  void build(const std::vector<Box3>& boxes, std::uint32_t first, std::uint32_t count);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
};

}  // namespace incise
