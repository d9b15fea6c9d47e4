#include "mechanics/aggregates.hpp"

#include <algorithm>
#include <numeric>

namespace incise {
namespace {

/// Splits [begin, end) of `order` into `groups` runs and appends the end of each run to `ends`.
void split(std::span<const Vec3> positions, std::vector<std::int32_t>& order, std::size_t begin, std::size_t end,
           std::size_t groups, std::vector<std::int32_t>& ends) {
  if (groups == 1) {
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(begin), order.begin() + static_cast<std::ptrdiff_t>(end));
    ends.push_back(static_cast<std::int32_t>(end));
    return;
  }
  Box3 box;
  for (std::size_t i = begin; i < end; ++i) box.extend(positions[static_cast<std::size_t>(order[i])]);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t left = groups / 2;
  const std::size_t middle = begin + (end - begin) * left / groups;
  std::nth_element(order.begin() + static_cast<std::ptrdiff_t>(begin),
                   order.begin() + static_cast<std::ptrdiff_t>(middle),
                   order.begin() + static_cast<std::ptrdiff_t>(end), [&](std::int32_t a, std::int32_t b) {
                     const double x = positions[static_cast<std::size_t>(a)][axis];
                     const double y = positions[static_cast<std::size_t>(b)][axis];
                     return x != y ? x < y : a < b;
                   });
  split(positions, order, begin, middle, left, ends);
  split(positions, order, middle, end, groups - left, ends);
}

}  // namespace

Aggregates bisect(std::span<const Vec3> positions, std::size_t per_aggregate) {
  Aggregates result;
  result.start.push_back(0);
  result.vertices.resize(positions.size());
  std::iota(result.vertices.begin(), result.vertices.end(), 0);
  result.of_vertex.resize(positions.size());
  if (positions.empty()) return result;
  const std::size_t groups = (positions.size() + per_aggregate - 1) / per_aggregate;
  split(positions, result.vertices, 0, positions.size(), groups, result.start);
  for (std::size_t a = 0; a < result.count(); ++a) {
    for (const std::int32_t v : result.members(a))
      result.of_vertex[static_cast<std::size_t>(v)] = static_cast<std::int32_t>(a);
  }
  return result;
}

}  // namespace incise
