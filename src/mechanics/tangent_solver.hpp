#pragma once

#include <incise/mechanics/solvers.hpp>
#include <incise/mechanics/tissue.hpp>

#include <memory>
#include <optional>
#include <span>
#include <string>

namespace incise {

/// Bodies with more vertices than this are left to conjugate gradients. Measured: docs/records/solvers.md.
inline constexpr std::size_t kMostVerticesForCholesky = 3000;

/// The linear solver behind Newton's method: chooses one, keeps what can be kept from system to system, and counts.
/// Solvers are made when they are first needed.
class TangentSolver {
 public:
  TangentSolver(const TissueModel& model, LinearSolver choice, int max_cg_iterations);

  enum class End { Solved, NotPositiveDefinite, NotConverged };
  /// Solves matrix * x = b to |residual| <= tolerance |b| (by Cholesky: to rounding).
  End solve(const BlockMatrix& matrix, std::span<const Vec3> b, std::span<Vec3> x, double tolerance, Workers& workers);
  /// Forgets what the preconditioner kept of earlier matrices, so that the next solution depends on its own system
  /// only.
  void forget();

  [[nodiscard]] int cg_iterations() const { return cg_iterations_; }
  [[nodiscard]] int factorisations() const { return factorisations_; }
  /// What was chosen and why, and what became of it; for a person.
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
