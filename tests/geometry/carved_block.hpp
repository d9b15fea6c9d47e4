#pragma once

#include <incise/core/random.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <algorithm>
#include <cmath>

namespace incise::testing {

using Corners = std::array<Vec3, 4>;

/// A block centred on x = y = 0 with its top at z = 0, of tets with edges of about 1.3 `cell_mm`, its inner vertices
/// moved at random.
inline TetMesh jittered_block(const Vec3& size, double cell_mm, std::uint64_t seed) {
  std::array<int, 3> cells{};
  for (std::size_t a = 0; a < 3; ++a)
    cells[a] = std::max(1, static_cast<int>(std::lround(size[static_cast<Eigen::Index>(a)] / cell_mm)));
  TetMesh mesh = make_block(size, cells);
  Random random(seed);
  for (Vec3& p : mesh.vertices) {
    for (Eigen::Index a = 0; a < 3; ++a) {
      const double move = 0.25 * cell_mm * random.uniform(-1.0, 1.0);
      if (p[a] > 1e-9 && p[a] < size[a] - 1e-9) p[a] += move;
    }
    p -= Vec3(0.5 * size.x(), 0.5 * size.y(), size.z());
  }
  return mesh;
}

/// Whether some part of the tet lies within `reach` of the shape with the given signed distance from its middle
/// (sampled on the edges).
template <class Distance>
bool comes_within(const Corners& corners, double reach, const Distance& distance) {
  double low = INFINITY;
  double high = -INFINITY;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) {
      for (int k = 0; k <= 8; ++k) {
        const double d = distance(Vec3(corners[a] + k / 8.0 * (corners[b] - corners[a])));
        low = std::min(low, d);
        high = std::max(high, d);
      }
    }
  }
  return low <= reach && high >= -reach;
}

}  // namespace incise::testing
