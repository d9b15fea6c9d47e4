#include "verification/sofa_body.hpp"

#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace incise::testing {
namespace {

using Vector = Eigen::VectorXd;
using Corners = std::array<Vec3, 4>;

constexpr int kMaxNewton = 400;
constexpr double kConverged = 1e-10;
constexpr double kCgTolerance = 1e-9;

Mat3 edges(const Corners& x) {
  Mat3 d;
  for (int c = 0; c < 3; ++c) d.col(c) = x[static_cast<std::size_t>(c) + 1] - x[0];
  return d;
}

/// Orthogonal factor of the polar decomposition, by Newton's iteration Q <- (Q + Q^-T) / 2 [Higham 1986].
Mat3 polar(const Mat3& m) {
  Mat3 q = m / std::cbrt(std::abs(m.determinant()));
  for (int i = 0; i < 50; ++i) {
    const Mat3 next = 0.5 * (q + q.inverse().transpose());
    const double change = (next - q).norm();
    q = next;
    if (change < 1e-15) break;
  }
  return q;
}

/// Axes: first edge; normal of the first face; the one across both.
Mat3 frame(const Corners& x) {
  Mat3 q;
  q.col(0) = (x[1] - x[0]).normalized();
  q.col(2) = (x[1] - x[0]).cross(x[2] - x[0]).normalized();
  q.col(1) = q.col(2).cross(q.col(0));
  return q;
}

Mat3 turn_of(SofaRotation rotation, const Corners& rest, const Corners& now) {
  switch (rotation) {
    case SofaRotation::Small:
      return Mat3::Identity();
    case SofaRotation::Large:
      return frame(now) * frame(rest).transpose();
    case SofaRotation::PolarEdge:
      return polar(edges(now).transpose()).transpose() * polar(edges(rest).transpose());
    case SofaRotation::PolarF:
      return polar(edges(now) * edges(rest).inverse());
  }
  return Mat3::Identity();
}

Corners corners_of(const Tet& tet, const Points& positions) {
  Corners x;
  for (std::size_t c = 0; c < 4; ++c) x[c] = positions[tet[c].index()];
  return x;
}

std::vector<std::uint8_t> flags(std::size_t unknowns, const SofaCase& load) {
  std::vector<std::uint8_t> is_held(unknowns, 0);
  for (const auto& [unknown, displacement] : load.held) is_held[unknown] = 1;
  return is_held;
}

void clear_held(Vector& x, const std::vector<std::uint8_t>& is_held) {
  for (std::size_t i = 0; i < is_held.size(); ++i) {
    if (is_held[i] != 0) x[static_cast<Eigen::Index>(i)] = 0.0;
  }
}

/// Identity rows and columns for what is held.
void hold(Eigen::SparseMatrix<double>& matrix, const std::vector<std::uint8_t>& is_held) {
  for (Eigen::Index c = 0; c < matrix.outerSize(); ++c) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, c); entry; ++entry) {
      const bool is_out =
          is_held[static_cast<std::size_t>(entry.row())] != 0 || is_held[static_cast<std::size_t>(c)] != 0;
      if (is_out) entry.valueRef() = entry.row() == c ? 1.0 : 0.0;
    }
  }
}

Vector weight(const SofaBody& body, const Vec3& gravity) {
  Vector result(3 * static_cast<Eigen::Index>(body.size()));
  for (std::size_t v = 0; v < body.size(); ++v)
    result.segment<3>(3 * static_cast<Eigen::Index>(v)) = body.masses()[v] * gravity;
  return result;
}

void add_to(Points& positions, const Vector& change) {
  for (std::size_t v = 0; v < positions.size(); ++v)
    positions[v] += change.segment<3>(3 * static_cast<Eigen::Index>(v));
}

/// Plain conjugate gradients as SOFA's: zero start, stops at |r| / |b| or after so many iterations, converged or not.
Vector conjugate_gradients(const Eigen::SparseMatrix<double>& matrix, const Vector& b, int iterations) {
  Vector x = Vector::Zero(b.size());
  Vector r = b;
  Vector p = Vector::Zero(b.size());
  double previous = 1.0;
  for (int i = 0; i < iterations; ++i) {
    const double rho = r.squaredNorm();
    if (std::sqrt(rho) <= kCgTolerance * b.norm()) break;
    p = i == 0 ? r : Vector(r + rho / previous * p);
    const Vector q = matrix * p;
    const double alpha = rho / p.dot(q);
    x += alpha * p;
    r -= alpha * q;
    previous = rho;
  }
  return x;
}

}  // namespace

SofaBody::SofaBody(const TetMesh& mesh, const LameParameters& lame, double density, SofaRotation rotation)
    : mesh_(mesh),
      lame_(lame),
      rotation_(rotation),
      masses_(mesh.vertices.size(), 0.0),
      turns_(mesh.tets.size(), Mat3::Identity()) {
  for (const Tet& tet : mesh_.tets) {
    const Mat3 d = edges(corners_of(tet, mesh_.vertices));
    const Mat3 inverse = d.inverse();
    std::array<Vec3, 4> g;
    g[0].setZero();
    for (std::size_t c = 1; c < 4; ++c) {
      g[c] = inverse.row(static_cast<int>(c) - 1).transpose();
      g[0] -= g[c];
    }
    gradients_.push_back(g);
    volumes_.push_back(d.determinant() / 6.0);
    for (const VertexId v : tet) masses_[v.index()] += 0.25 * density * volumes_.back();
  }
}

void SofaBody::turn(const Points& positions) {
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
    turns_[t] = turn_of(rotation_, corners_of(mesh_.tets[t], mesh_.vertices), corners_of(mesh_.tets[t], positions));
  }
}

Vector SofaBody::forces(const Points& positions) const {
  Vector result = Vector::Zero(3 * static_cast<Eigen::Index>(size()));
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
    Mat3 f = Mat3::Zero();
    for (std::size_t c = 0; c < 4; ++c) f += positions[mesh_.tets[t][c].index()] * gradients_[t][c].transpose();
    const Mat3 s = turns_[t].transpose() * f;
    const Mat3 strain = 0.5 * (s + s.transpose()) - Mat3::Identity();
    const Mat3 stress =
        turns_[t] * (2.0 * lame_.mu_kpa * strain + lame_.lambda_kpa * strain.trace() * Mat3::Identity());
    for (std::size_t c = 0; c < 4; ++c) {
      result.segment<3>(3 * static_cast<Eigen::Index>(mesh_.tets[t][c].index())) -=
          volumes_[t] * (stress * gradients_[t][c]);
    }
  }
  return result;
}

Eigen::SparseMatrix<double> SofaBody::stiffness() const {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(144 * mesh_.tets.size());
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
    std::array<Vec3, 4> a;
    for (std::size_t c = 0; c < 4; ++c) a[c] = turns_[t] * gradients_[t][c];
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        const Mat3 block =
            volumes_[t] * (lame_.lambda_kpa * a[i] * a[j].transpose() + lame_.mu_kpa * a[j] * a[i].transpose() +
                           lame_.mu_kpa * a[i].dot(a[j]) * Mat3::Identity());
        const int row = 3 * static_cast<int>(mesh_.tets[t][i].index());
        const int column = 3 * static_cast<int>(mesh_.tets[t][j].index());
        for (int r = 0; r < 3; ++r) {
          for (int c = 0; c < 3; ++c) entries.emplace_back(row + r, column + c, block(r, c));
        }
      }
    }
  }
  const auto n = 3 * static_cast<Eigen::Index>(size());
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Points sofa_equilibrium(SofaBody& body, const SofaCase& load) {
  const std::vector<std::uint8_t> is_held = flags(3 * body.size(), load);
  const Vector dead = weight(body, load.gravity);
  Vector jump = Vector::Zero(dead.size());
  for (const auto& [unknown, displacement] : load.held) jump[static_cast<Eigen::Index>(unknown)] = displacement;
  Points positions = body.rest();
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
  for (int i = 0; i < kMaxNewton; ++i) {
    body.turn(positions);
    Eigen::SparseMatrix<double> matrix = body.stiffness();
    Vector right = body.forces(positions) + dead - matrix * jump;
    clear_held(right, is_held);
    hold(matrix, is_held);
    if (i == 0) solver.analyzePattern(matrix);
    solver.factorize(matrix);
    const Vector change = solver.solve(right) + jump;
    add_to(positions, change);
    jump.setZero();
    if (change.lpNorm<Eigen::Infinity>() < kConverged) return positions;
  }
  return {};
}

Points sofa_steps(SofaBody& body, const SofaCase& load, const SofaStepping& stepping) {
  const std::vector<std::uint8_t> is_held = flags(3 * body.size(), load);
  const Vector dead = weight(body, load.gravity);
  const Vector mass = weight(body, Vec3::Ones());
  const double h = stepping.step_s;
  const double of_mass = 1.0 + h * stepping.damping_mass;
  const double of_stiffness = h * h + h * stepping.damping_stiffness;
  Points positions = body.rest();
  Vector velocity = Vector::Zero(dead.size());
  Eigen::SparseMatrix<double> stiffness;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
  for (int step = 0; step < stepping.steps; ++step) {
    if (step == 0 || !body.is_linear()) {
      body.turn(positions);
      stiffness = body.stiffness();
    }
    Eigen::SparseMatrix<double> matrix = stiffness;
    Vector right = h * (body.forces(positions) + dead - (h + stepping.damping_stiffness) * (matrix * velocity) -
                        stepping.damping_mass * mass.cwiseProduct(velocity));
    clear_held(right, is_held);
    matrix *= of_stiffness;
    matrix.diagonal() += of_mass * mass;
    hold(matrix, is_held);
    Vector change;
    if (stepping.cg_iterations > 0) {
      change = conjugate_gradients(matrix, right, stepping.cg_iterations);
    } else {
      if (step == 0) solver.analyzePattern(matrix);
      if (step == 0 || !body.is_linear()) solver.factorize(matrix);
      change = solver.solve(right);
    }
    velocity += change;
    add_to(positions, h * velocity);
  }
  return positions;
}

TetMesh sofa_beam(const Vec3& low, const Vec3& high, std::array<int, 3> nodes) {
  constexpr std::array<std::array<std::size_t, 4>, 6> kTets{
      {{0, 5, 1, 6}, {0, 1, 3, 6}, {1, 3, 6, 2}, {6, 3, 0, 7}, {6, 7, 0, 5}, {7, 5, 4, 0}}};
  constexpr std::array<std::array<int, 3>, 8> kCorners{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
  TetMesh mesh;
  for (int k = 0; k < nodes[2]; ++k) {
    for (int j = 0; j < nodes[1]; ++j) {
      for (int i = 0; i < nodes[0]; ++i) {
        const Vec3 share(double(i) / (nodes[0] - 1), double(j) / (nodes[1] - 1), double(k) / (nodes[2] - 1));
        mesh.vertices.push_back(low + share.cwiseProduct(high - low));
      }
    }
  }
  for (int k = 0; k + 1 < nodes[2]; ++k) {
    for (int j = 0; j + 1 < nodes[1]; ++j) {
      for (int i = 0; i + 1 < nodes[0]; ++i) {
        const std::array<bool, 3> is_mirrored{i % 2 == 0, j % 2 == 1, k % 2 == 1};
        const bool is_odd = is_mirrored[0] ^ is_mirrored[1] ^ is_mirrored[2];
        for (const auto& corners : kTets) {
          Tet tet;
          for (std::size_t c = 0; c < 4; ++c) {
            std::array<int, 3> at = kCorners[corners[c]];
            for (std::size_t axis = 0; axis < 3; ++axis) {
              if (is_mirrored[axis]) at[axis] = 1 - at[axis];
            }
            tet[c] = VertexId{static_cast<std::size_t>(i + at[0] + nodes[0] * (j + at[1] + nodes[1] * (k + at[2])))};
          }
          // A mirrored tet is inside out; changing its last two corners puts it right.
          if (is_odd) std::swap(tet[2], tet[3]);
          mesh.tets.push_back(tet);
        }
      }
    }
  }
  return mesh;
}

double largest_distance(const Points& a, const Points& b) {
  double largest = a.size() == b.size() ? 0.0 : std::numeric_limits<double>::infinity();
  for (std::size_t v = 0; v < std::min(a.size(), b.size()); ++v) largest = std::max(largest, (a[v] - b[v]).norm());
  return largest;
}

}  // namespace incise::testing
