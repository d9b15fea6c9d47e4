#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <cmath>

namespace incise::testing {

/// Closed skin of a block 80 x 80 mm about the origin whose underside lies at z = -thickness and whose top is z =
/// height(x, y).
template <class Height>
TriMesh body_with_top(const Height& height, double thickness_mm = 20.0, int cells = 40) {
  TetMesh block = make_block(Vec3(80, 80, thickness_mm), {cells, cells, 2});
  for (Vec3& p : block.vertices) {
    p -= Vec3(40, 40, thickness_mm);
    p.z() += height(p.x(), p.y()) * (1.0 + p.z() / thickness_mm);
  }
  return boundary_surface(block);
}

inline TriMesh flat_body(double thickness_mm = 20.0) {
  return body_with_top([](double, double) { return 0.0; }, thickness_mm, 8);
}

/// A cap of a sphere of 40 mm radius: as curved as a tongue.
inline TriMesh dome() {
  return body_with_top([](double x, double y) { return std::sqrt(std::max(400.0, 1600.0 - x * x - y * y)) - 40.0; },
                       40.0, 80);
}

/// A plane that rises by `slope` along x.
inline TriMesh wedge(double slope) {
  return body_with_top([slope](double x, double) { return slope * x; }, 60.0, 8);
}

}  // namespace incise::testing
