#pragma once

#include <incise/core/workers.hpp>
#include <incise/mechanics/block_matrix.hpp>

#include <memory>
#include <span>

namespace incise {

/// Which solver takes the linear systems of Newton's method.
enum class LinearSolver {
  Automatic,  ///< by the size of the body; conjugate gradients give way to Cholesky where they fail
  Cholesky,   ///< sparse factorisation: its cost does not depend on the material, but grows faster than the body
  ConjugateGradients,  ///< two-level preconditioned: hardly any memory, and cost near that of reading the matrix some
                       ///< hundred times
};

struct PcgSettings {
  double relative_tolerance = 1e-2;  ///< stops at |r| <= relative_tolerance * max(reference, floor)
  double reference_mn = 0.0;         ///< scale of the stopping test; 0: |b|
  double floor_mn = 0.0;             ///< lower bound of that scale
  int max_iterations = 2000;
  /// Begin with the share of the last solution that lowers the energy most, in place of zero (of the last since
  /// update() renewed the coarse matrix; there is none, or with Precision::Double: zero).
  bool starts_from_last = false;
};

struct PcgReport {
  bool converged = false;
  int iterations = 0;
  double residual_mn = 0.0;    ///< |r| at the end
  bool is_indefinite = false;  ///< a direction of no or negative stiffness was met
  bool is_redone = false;      ///< single precision did not get there: solved again in double precision; the iterations of both are counted
};

/// The numbers that an iteration works with.
enum class Precision {
  Double,
  Single,  ///< Half the bytes and less: single precision, the matrix in 16 bits a number. Solves for a matrix rounded to
           ///< 2e-5 of its diagonal whose rows sum to what they did, so that soft motions of the body keep their stiffness:
           ///< the solution is off by some 3e-3, the residual by 2e-5 |A| |x|. For steps that are put right by the next, of
           ///< tissue with λ up to some hundred μ: beyond, the shear stiffness is lost in the rounding. What does not
           ///< converge is solved again in double precision.
};

/// Two-level preconditioned conjugate gradients: block-Jacobi plus an additive coarse space of rigid-body modes, one
/// set of six per aggregate of ~`vertices_per_aggregate` neighbouring vertices (physics of the strategy:
/// docs/models/solvers.md). Made once per topology and rest positions; `update` refreshes it after the matrix changed
/// (the coarse part may stay stale for some steps).
class TwoLevelPcg {
 public:
  TwoLevelPcg(std::shared_ptr<const BlockPattern> pattern, std::span<const Vec3> positions,
              int vertices_per_aggregate = 140, Precision precision = Precision::Double);
  ~TwoLevelPcg();
  TwoLevelPcg(TwoLevelPcg&&) noexcept;
  TwoLevelPcg& operator=(TwoLevelPcg&&) noexcept;

  /// Takes the diagonal blocks of `matrix` (in single precision: all of it), and with `refresh_coarse` its coarse
  /// matrix too. Throws InvalidArgument if not positive definite.
  /// @param changed_rows  per row of blocks: 0 where it is that of the last update(); empty: all may have changed.
  void update(const BlockMatrix& matrix, bool refresh_coarse, Workers& workers,
              std::span<const std::uint8_t> changed_rows = {});
  /// Solves matrix * x = b from x = 0. Deterministic for any thread count. In single precision `matrix` has to be that
  /// of the last update().
  PcgReport solve(const BlockMatrix& matrix, std::span<const Vec3> b, std::span<Vec3> x, const PcgSettings& settings,
                  Workers& workers);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Sparse Cholesky (CHOLMOD supernodal, METIS ordering, one BLAS thread): analysed once per pattern, factored per
/// matrix.
class SparseCholesky {
 public:
  explicit SparseCholesky(std::shared_ptr<const BlockPattern> pattern);
  ~SparseCholesky();
  /// False when the matrix is not positive definite.
  [[nodiscard]] bool factor(const BlockMatrix& matrix);
  void solve(std::span<const Vec3> b, std::span<Vec3> x) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace incise
