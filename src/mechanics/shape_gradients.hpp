#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <Eigen/LU>
#include <array>

namespace incise {

struct ShapeGradients {
  std::array<Vec3, 4> gradients;  ///< of the linear shape function of each corner, 1/mm
  double volume_mm3 = 0.0;
};

[[nodiscard]] inline ShapeGradients shape_gradients(const TetMesh& mesh, std::size_t t) {
  const Tet& tet = mesh.tets[t];
  Mat3 edges;
  for (std::size_t c = 1; c < 4; ++c) {
    edges.col(static_cast<int>(c) - 1) = vertex(mesh.vertices, tet[c]) - vertex(mesh.vertices, tet[0]);
  }
  const Mat3 inverse = edges.inverse();
  ShapeGradients shape;
  for (std::size_t c = 1; c < 4; ++c) shape.gradients[c] = inverse.row(static_cast<int>(c) - 1).transpose();
  shape.gradients[0] = -(shape.gradients[1] + shape.gradients[2] + shape.gradients[3]);
  shape.volume_mm3 = edges.determinant() / 6.0;
  return shape;
}

}  // namespace incise
