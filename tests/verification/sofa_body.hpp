#pragma once

#include <incise/geometry/tet_mesh.hpp>
#include <incise/mechanics/material.hpp>

#include <Eigen/SparseCore>

namespace incise::testing {

/// How SOFA turns a tet. Only `PolarF` is incise's own; the others live here so that SOFA's fields can be met to their
/// printed digits. Formulas: README of the shared data, fem/sofa_block.
enum class SofaRotation {
  Small,      ///< identity
  Large,      ///< frame on the first edge and the first face: depends on the order of the tet's corners
  PolarEdge,  ///< polar factors of the edge matrices: depends on the order, too
  PolarF,     ///< polar factor of the deformation gradient
};

/// Linear tets with one of SOFA's rotations, written apart from the library: own gradients, forces, stiffness, solvers.
class SofaBody {
 public:
  SofaBody(const TetMesh& mesh, const LameParameters& lame, double density, SofaRotation rotation);

  [[nodiscard]] std::size_t size() const { return mesh_.vertices.size(); }
  [[nodiscard]] const Points& rest() const { return mesh_.vertices; }
  [[nodiscard]] const std::vector<double>& masses() const { return masses_; }
  /// Finds the rotations at these positions; forces and stiffness below use them.
  void turn(const Points& positions);
  /// Elastic forces, f = -V P g.
  [[nodiscard]] Eigen::VectorXd forces(const Points& positions) const;
  /// K = Σ R K_e Rᵀ, rotations frozen.
  [[nodiscard]] Eigen::SparseMatrix<double> stiffness() const;
  [[nodiscard]] bool is_linear() const { return rotation_ == SofaRotation::Small; }

 private:
  TetMesh mesh_;
  LameParameters lame_;
  SofaRotation rotation_;
  std::vector<std::array<Vec3, 4>> gradients_;
  std::vector<double> volumes_;
  std::vector<double> masses_;
  std::vector<Mat3> turns_;
};

/// What is done to a body: held unknowns (3 v + axis) with their displacement from rest, and gravity.
struct SofaCase {
  std::vector<std::pair<std::size_t, double>> held;
  Vec3 gravity = Vec3::Zero();
};

/// Static equilibrium: Newton with frozen rotations until the largest change is below 1e-10. Empty if that takes more
/// than 400 iterations.
[[nodiscard]] Points sofa_equilibrium(SofaBody& body, const SofaCase& load);

/// The scheme of the references: ((1 + h a) M + (h² + h b) K) dv = h (f - (h + b) K v - a M v), v += dv, x += h v.
struct SofaStepping {
  double step_s = 0.05;
  double damping_mass = 0.1;
  double damping_stiffness = 0.1;
  int steps = 1;
  int cg_iterations = 0;  ///< 0: exact solve; else plain conjugate gradients from zero, relative residual 1e-9
};
[[nodiscard]] Points sofa_steps(SofaBody& body, const SofaCase& load, const SofaStepping& stepping);

/// SOFA's beam of mirrored cells: a grid of nodes, x fastest, each cell six tets, all positive.
[[nodiscard]] TetMesh sofa_beam(const Vec3& low, const Vec3& high, std::array<int, 3> nodes);

[[nodiscard]] double largest_distance(const Points& a, const Points& b);

}  // namespace incise::testing
