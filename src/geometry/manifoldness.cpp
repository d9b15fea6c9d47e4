#include <incise/geometry/disjoint_sets.hpp>
#include <incise/geometry/manifoldness.hpp>

#include <algorithm>
#include <tuple>
#include <vector>

namespace incise {
namespace {

/// A side of a triangle: its two vertices and their places in the list of all corners (3 · triangle + corner).
struct Side {
  VertexId low, high;
  std::size_t low_corner, high_corner;
};

std::vector<Side> sides_of(std::span<const Triangle> triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      const VertexId a = triangles[t][k], b = triangles[t][next];
      sides.push_back(a < b ? Side{a, b, 3 * t + k, 3 * t + next} : Side{b, a, 3 * t + next, 3 * t + k});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& o) {
    return std::tie(s.low, s.high, s.low_corner) < std::tie(o.low, o.high, o.low_corner);
  });
  return sides;
}

}  // namespace

Manifoldness manifoldness_of(std::span<const Triangle> triangles) {
  Manifoldness found;
  found.triangles = triangles.size();
  DisjointSets fans(3 * triangles.size());  // corners that are connected across edges of two triangles
  std::vector<VertexId> on_bad_edge;
  const std::vector<Side> sides = sides_of(triangles);
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
    if (end - i == 2) {
      fans.join(sides[i].low_corner, sides[i + 1].low_corner);
      fans.join(sides[i].high_corner, sides[i + 1].high_corner);
      continue;
    }
    ++(end - i == 1 ? found.open_edges : found.nonmanifold_edges);
    on_bad_edge.insert(on_bad_edge.end(), {sides[i].low, sides[i].high});
  }
  std::sort(on_bad_edge.begin(), on_bad_edge.end());

  std::vector<std::pair<VertexId, std::size_t>> fans_at;  // one entry per corner
  for (std::size_t c = 0; c < 3 * triangles.size(); ++c) fans_at.emplace_back(triangles[c / 3][c % 3], fans.root(c));
  std::sort(fans_at.begin(), fans_at.end());
  fans_at.erase(std::unique(fans_at.begin(), fans_at.end()), fans_at.end());
  for (std::size_t i = 0, end = 0; i < fans_at.size(); i = end) {
    while (end < fans_at.size() && fans_at[end].first == fans_at[i].first) ++end;
    if (end - i > 1 && !std::binary_search(on_bad_edge.begin(), on_bad_edge.end(), fans_at[i].first))
      ++found.pinched_vertices;
  }
  return found;
}

}  // namespace incise
