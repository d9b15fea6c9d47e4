#pragma once

#include <incise/core/random.hpp>
#include <incise/mechanics/statics.hpp>
#include <incise/mechanics/tissue.hpp>

#include <algorithm>
#include <cmath>

namespace incise::testing {

// Central differences of a smooth function at a step of 1e-5 mm: truncation ~ 1e-10, cancellation ~ 1e-11 of its size.
inline constexpr double kDifferenceStep = 1e-5;
inline constexpr double kDifferenceTolerance = 1e-6;
inline constexpr double kRounding = 1e-12;

/// The plane x = at of a block, as a region.
inline Region plane_x(double at) {
  return BoxRegion{Box3(Vec3(at - 1e-6, -1e3, -1e3), Vec3(at + 1e-6, 1e3, 1e3))};
}
inline Region plane_y(double at) {
  return BoxRegion{Box3(Vec3(-1e3, at - 1e-6, -1e3), Vec3(1e3, at + 1e-6, 1e3))};
}
inline Region plane_z(double at) {
  return BoxRegion{Box3(Vec3(-1e3, -1e3, at - 1e-6), Vec3(1e3, 1e3, at + 1e-6))};
}

/// A block whose inner vertices are moved at random by up to `share` of a cell: no two tets alike, boundary and volume
/// kept.
inline TetMesh irregular_block(const Vec3& size, std::array<int, 3> cells, double share, std::uint64_t seed) {
  TetMesh mesh = make_block(size, cells);
  Random random(seed);
  const double edge = std::min({size[0] / cells[0], size[1] / cells[1], size[2] / cells[2]});
  for (Vec3& p : mesh.vertices) {
    const bool is_inner = (p.array() > 1e-9).all() && ((size - p).array() > 1e-9).all();
    const Vec3 shift(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
    if (is_inner) p += share * edge * shift;
  }
  return mesh;
}

/// An irregular block clamped at x = 0: the usual specimen of these tests.
inline TissueModel clamped_block(std::array<int, 3> cells = {4, 3, 3}, double nu = 0.45) {
  Material material{.poissons_ratio = nu};
  return make_tissue_model(irregular_block(Vec3(20, 12, 9), cells, 0.2, 7), material, {FixedConstraint{plane_x(0.0)}});
}

/// A tet with no two edges alike, whose corners are all held.
inline TissueModel one_tet(const Material& material) {
  TetMesh mesh;
  mesh.vertices = {Vec3(0, 0, 0), Vec3(2, 0.1, 0.2), Vec3(0.3, 1.5, -0.1), Vec3(0.2, 0.4, 1.8)};
  mesh.tets = {{VertexId{0}, VertexId{1}, VertexId{2}, VertexId{3}}};
  return make_tissue_model(mesh, material, {FixedConstraint{SphereRegion{Vec3::Zero(), 10.0}}});
}

inline Mat3 some_rotation(double angle = 2.0) {
  return Eigen::AngleAxisd(angle, Vec3(1.0, 2.0, -2.0) / 3.0).toRotationMatrix();
}

/// The rest state with every vertex moved at random by up to `amount` mm along each axis.
inline TissueState shaken(const TissueModel& model, double amount, std::uint64_t seed) {
  TissueState state = rest_state(model);
  Random random(seed);
  for (Vec3& p : state.positions) {
    for (int i = 0; i < 3; ++i) p[i] += random.uniform(-amount, amount);
  }
  return state;
}

inline Points elastic_forces(const TissueModel& model, TissueState& state, BlockMatrix* stiffness = nullptr,
                             int threads = 1) {
  Workers workers(threads);
  Points forces(model.mesh.vertices.size(), Vec3::Zero());
  add_elastic_response(model, state, forces, stiffness, workers);
  return forces;
}

/// Stiffness by central differences, at a step of `step` mm, of the forces that `forces(state)` returns.
template <class Forces>
Eigen::MatrixXd force_differences(const TissueState& start, double step, const Forces& forces) {
  const auto n = static_cast<Eigen::Index>(3 * start.positions.size());
  Eigen::MatrixXd result(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    TissueState state = start;
    double& x = state.positions[static_cast<std::size_t>(j / 3)][j % 3];
    const double at = x;
    x = at + step;
    const Points above = forces(state);
    x = at - step;
    const Points below = forces(state);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto v = static_cast<std::size_t>(i / 3);
      result(i, j) = -(above[v][i % 3] - below[v][i % 3]) / (2.0 * step);
    }
  }
  return result;
}

/// The static solution of a body that nobody watches.
inline StaticResult solve(const TissueModel& model, const StaticSettings& settings = {}, int threads = 1,
                          const TissueState* start = nullptr) {
  Workers workers(threads);
  Monitor silent;
  return solve_static(model, settings, workers, silent, start);
}

inline double norm(std::span<const Vec3> vectors) {
  double squared = 0.0;
  for (const Vec3& v : vectors) squared += v.squaredNorm();
  return std::sqrt(squared);
}

inline double largest(std::span<const Vec3> vectors) {
  double length = 0.0;
  for (const Vec3& v : vectors) length = std::max(length, v.norm());
  return length;
}

inline Mat3 block_of(const BlockMatrix& matrix, std::size_t slot) {
  return matrix.at(static_cast<std::int32_t>(slot));
}

/// All entries, for small bodies.
inline Eigen::MatrixXd dense(const BlockMatrix& matrix) {
  const auto n = static_cast<Eigen::Index>(3 * matrix.pattern->rows());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t row = 0; row < matrix.pattern->rows(); ++row) {
    for (auto slot = matrix.pattern->row_start[row]; slot < matrix.pattern->row_start[row + 1]; ++slot) {
      const auto at = static_cast<std::size_t>(slot);
      result.block<3, 3>(static_cast<Eigen::Index>(3 * row), 3 * matrix.pattern->column[at]) = block_of(matrix, at);
    }
  }
  return result;
}

}  // namespace incise::testing
