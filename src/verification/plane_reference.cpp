#include "verification/plane_reference.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/types.hpp>

#include <Eigen/SparseCholesky>

namespace incise {
namespace {

using Elasticity = Eigen::Matrix3d;
using ElementMatrix = Eigen::Matrix<double, 18, 18>;

Elasticity elasticity(const PanelProblem& problem) {
  const double e = problem.youngs_modulus_kpa;
  const double nu = problem.poissons_ratio;
  Elasticity d = Elasticity::Zero();
  if (problem.is_plane_strain) {
    const double factor = e / ((1.0 + nu) * (1.0 - 2.0 * nu));
    d << 1.0 - nu, nu, 0.0, nu, 1.0 - nu, 0.0, 0.0, 0.0, 0.5 - nu;
    return factor * d;
  }
  d << 1.0, nu, 0.0, nu, 1.0, 0.0, 0.0, 0.0, 0.5 * (1.0 - nu);
  return e / (1.0 - nu * nu) * d;
}

Vec2 place(double x, double y) {
  return {48.0 * x, 44.0 * x * (1.0 - y) + (44.0 + 16.0 * x) * y};
}

/// Quadratic Lagrange functions on nodes -1, 0, 1, and their slopes.
struct Line {
  std::array<double, 3> value, slope;
};
Line line_at(double t) {
  return {{0.5 * t * (t - 1.0), 1.0 - t * t, 0.5 * t * (t + 1.0)}, {t - 0.5, -2.0 * t, t + 0.5}};
}

constexpr std::array<double, 3> kGauss{-0.7745966692414834, 0.0, 0.7745966692414834};
constexpr std::array<double, 3> kWeight{5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};

ElementMatrix element(const std::array<Vec2, 9>& nodes, const Elasticity& d) {
  ElementMatrix k = ElementMatrix::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Line u = line_at(kGauss[i]);
      const Line v = line_at(kGauss[j]);
      Eigen::Matrix<double, 2, 9> slopes;
      Eigen::Matrix2d jacobian = Eigen::Matrix2d::Zero();
      for (int a = 0; a < 9; ++a) {
        const auto p = static_cast<std::size_t>(a % 3);
        const auto q = static_cast<std::size_t>(a / 3);
        slopes.col(a) = Vec2(u.slope[p] * v.value[q], u.value[p] * v.slope[q]);
        jacobian += slopes.col(a) * nodes[static_cast<std::size_t>(a)].transpose();
      }
      const double det = jacobian(0, 0) * jacobian(1, 1) - jacobian(0, 1) * jacobian(1, 0);
      Eigen::Matrix2d inverse;
      inverse << jacobian(1, 1), -jacobian(0, 1), -jacobian(1, 0), jacobian(0, 0);
      const Eigen::Matrix<double, 2, 9> gradients = inverse / det * slopes;
      Eigen::Matrix<double, 3, 18> b = Eigen::Matrix<double, 3, 18>::Zero();
      for (int a = 0; a < 9; ++a) {
        b(0, 2 * a) = gradients(0, a);
        b(1, 2 * a + 1) = gradients(1, a);
        b(2, 2 * a) = gradients(1, a);
        b(2, 2 * a + 1) = gradients(0, a);
      }
      k += kWeight[i] * kWeight[j] * det * b.transpose() * d * b;
    }
  }
  return k;
}

}  // namespace

double panel_tip_mm(const PanelProblem& problem, int n) {
  INCISE_REQUIRE(n >= 1, "expected at least one element");
  const int row = 2 * n + 1;
  const auto unknown = [&](int i, int j, int axis) { return i == 0 ? -1 : 2 * (j * (row - 1) + i - 1) + axis; };
  const int count = 2 * row * (row - 1);
  const Elasticity d = elasticity(problem);
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(count);
  for (int ej = 0; ej < n; ++ej) {
    for (int ei = 0; ei < n; ++ei) {
      std::array<Vec2, 9> nodes;
      std::array<int, 18> index{};
      for (int a = 0; a < 9; ++a) {
        const int i = 2 * ei + a % 3;
        const int j = 2 * ej + a / 3;
        nodes[static_cast<std::size_t>(a)] = place(0.5 * i / n, 0.5 * j / n);
        for (int axis = 0; axis < 2; ++axis) index[static_cast<std::size_t>(2 * a + axis)] = unknown(i, j, axis);
      }
      const ElementMatrix k = element(nodes, d);
      for (std::size_t r = 0; r < 18; ++r) {
        for (std::size_t c = 0; c < 18; ++c) {
          if (index[r] >= 0 && index[c] >= 0) {
            entries.emplace_back(index[r], index[c], k(static_cast<int>(r), static_cast<int>(c)));
          }
        }
      }
    }
    // Simpson's weights on a quadratic edge.
    const double edge = problem.traction_kpa * 16.0 / n;
    load[unknown(2 * n, 2 * ej, 1)] += edge / 6.0;
    load[unknown(2 * n, 2 * ej + 1, 1)] += 4.0 * edge / 6.0;
    load[unknown(2 * n, 2 * ej + 2, 1)] += edge / 6.0;
  }
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  const Eigen::VectorXd x = solver.solve(load);
  return x[unknown(2 * n, n, 1)];
}

}  // namespace incise
