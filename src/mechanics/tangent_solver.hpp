#pragma once

#include <incise/mechanics/solvers.hpp>
#include <incise/mechanics/tissue.hpp>

#include <optional>
#include <span>
#include <string>

namespace incise {

/// LinearSolver::Automatic uses conjugate gradients for bodies with more vertices. Measured: docs/records/solvers.md.
inline constexpr std::size_t kMostVerticesForCholesky = 3000;

/// The linear solver behind Newton's method: chooses a solver, reuses data from system to system, and counts
/// iterations. Solvers are constructed when first needed.
class TangentSolver {
 public:
  TangentSolver(const TissueModel& model, LinearSolver choice, int max_cg_iterations);

  enum class End { Solved, NotPositiveDefinite, NotConverged };
  /// Solves matrix * x = b to |residual| <= tolerance |b| (by Cholesky: to rounding).
  End solve(const BlockMatrix& matrix, std::span<const Vec3> b, std::span<Vec3> x, double tolerance, Workers& workers);
  /// Discards what the preconditioner kept of earlier matrices: the next solution depends only on its own system.
  void forget();

  [[nodiscard]] int cg_iterations() const { return cg_iterations_; }
  /// Returns the chosen solver, the reason, and how it performed; for a person.
  [[nodiscard]] std::string explanation() const;

 private:
  End solve_by_cg(const BlockMatrix& matrix, std::span<const Vec3> b, std::span<Vec3> x, double tolerance,
                  Workers& workers);

  const TissueModel& model_;
  LinearSolver choice_;
  int max_cg_iterations_;
  bool is_iterative_;
  bool has_given_way_ = false;  // conjugate gradients failed once: Cholesky from then on
  std::optional<TwoLevelPcg> pcg_;
  std::optional<SparseCholesky> cholesky_;
  int cg_iterations_ = 0;
  int cg_systems_ = 0;
  int factorisations_ = 0;
  int fresh_iterations_ = 0;  // per digit, of the first system after the coarse matrix was made
  bool is_coarse_stale_ = true;
};

}  // namespace incise
