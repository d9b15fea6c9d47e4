#include "geometry/box_tree.hpp"

#include <algorithm>
#include <numeric>

namespace incise {

BoxTree::BoxTree(const std::vector<Box3>& boxes) : items_(boxes.size()) {
  std::iota(items_.begin(), items_.end(), 0U);
  nodes_.reserve(boxes.size());
  build(boxes, 0, static_cast<std::uint32_t>(boxes.size()));
}

void BoxTree::build(const std::vector<Box3>& boxes, std::uint32_t first, std::uint32_t count) {
  const std::size_t at = nodes_.size();
  nodes_.emplace_back();
  Box3 box;
  Box3 centres;
  for (std::uint32_t i = first; i < first + count; ++i) {
    box.extend(boxes[items_[i]]);
    centres.extend(boxes[items_[i]].center());
  }
  nodes_[at].box = box;
  if (count <= kLeafSize) {
    nodes_[at].first = first;
    nodes_[at].count = count;
    return;
  }
  Eigen::Index axis = 0;
  centres.sizes().maxCoeff(&axis);
  const std::uint32_t half = count / 2;
  const auto begin = items_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    const double x = boxes[a].min()[axis] + boxes[a].max()[axis];
    const double y = boxes[b].min()[axis] + boxes[b].max()[axis];
    return x != y ? x < y : a < b;
  });
  build(boxes, first, half);
  nodes_[at].right = static_cast<std::uint32_t>(nodes_.size());
  build(boxes, first + half, count - half);
}

}  // namespace incise
