#pragma once

#include <incise/core/workers.hpp>
#include <incise/mechanics/block_matrix.hpp>

#include <memory>
#include <span>

namespace incise {

/// Solver for the linear systems of Newton's method.
enum class LinearSolver {
  Automatic,  ///< chosen by the size of the body; if conjugate gradients fail, Cholesky takes over
  Cholesky,   ///< sparse factorisation: its cost does not depend on the material, but grows faster than the body
  ConjugateGradients,  ///< two-level preconditioned: little memory; costs about as much as reading the matrix some
                       ///< hundred times
};

struct PcgSettings {
  double relative_tolerance = 1e-2;  ///< > 0; stops at |r| <= relative_tolerance * max(reference_mn, floor_mn)
  double reference_mn = 0.0;         ///< scale of the stopping test; 0: |b|
  double floor_mn = 0.0;             ///< lower bound of that scale
  int max_iterations = 2000;
  /// Precision::Single only: start from the last solution, times the factor that lowers the energy most, instead of
  /// from zero. Starts from zero if the last solve did not converge or update() has refreshed the coarse matrix since.
  bool starts_from_last = false;
};

struct PcgReport {
  bool converged = false;
  int iterations = 0;          ///< of both solves together if the system was solved again in double precision
  double residual_mn = 0.0;    ///< |r| at the end
  bool is_indefinite = false;  ///< a direction of zero or negative stiffness was met
};

/// Number format of the iterations.
enum class Precision {
  Double,
  /// Vectors in single precision, the matrix in 16 bits per number: half the memory of Double or less. The matrix is
  /// rounded to 2e-5 of its diagonal, but its row sums are kept, so soft motions of the body keep their stiffness. The
  /// solution is off by about 3e-3, the residual by 2e-5 |A| |x|. Suited to steps whose errors the next step corrects,
  /// in tissue with λ up to a few hundred μ; beyond that, rounding hides the shear stiffness. A system that does not
  /// converge is solved again in double precision.
  Single,
};

/// Two-level preconditioned conjugate gradients: block-Jacobi plus an additive coarse space of rigid motions, six per
/// aggregate of about `vertices_per_aggregate` neighbouring vertices (docs/models/solvers.md). Constructed once per
/// topology and rest positions; call `update` after the matrix has changed (the coarse part may stay stale for some
/// steps).
class TwoLevelPcg {
 public:
  /// @param positions  N x 3, mm, at rest.
  /// @throws InvalidArgument for no pattern, another number of positions, positions that are not finite, or
  /// vertices_per_aggregate < 1.
  TwoLevelPcg(std::shared_ptr<const BlockPattern> pattern, std::span<const Vec3> positions,
              int vertices_per_aggregate = 140, Precision precision = Precision::Double);
  ~TwoLevelPcg();
  TwoLevelPcg(TwoLevelPcg&&) noexcept;
  TwoLevelPcg& operator=(TwoLevelPcg&&) noexcept;

  /// Takes over the diagonal blocks of `matrix` (in single precision: all blocks). With `refresh_coarse`, and in the
  /// first call, computes its coarse matrix too.
  /// @param changed_rows  per row of blocks: 0 if unchanged since the last update(); empty: all may have changed.
  /// @throws InvalidArgument if a diagonal block or the coarse matrix is not positive definite, or for another pattern.
  void update(const BlockMatrix& matrix, bool refresh_coarse, Workers& workers,
              std::span<const std::uint8_t> changed_rows = {});
  /// Solves matrix * x = b, from x = 0 unless settings.starts_from_last; b and x are N x 3. Same bits at any thread
  /// count.
  /// @pre in single precision, `matrix` is that of the last update().
  /// @throws InvalidArgument before the first update() and for a bad setting, another pattern or wrong sizes.
  PcgReport solve(const BlockMatrix& matrix, std::span<const Vec3> b, std::span<Vec3> x, const PcgSettings& settings,
                  Workers& workers);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Sparse Cholesky factorisation (CHOLMOD supernodal, METIS ordering, one BLAS thread): analysed once per pattern,
/// factored once per matrix.
class SparseCholesky {
 public:
  /// @throws InvalidArgument for a pattern without rows, or if memory runs out.
  explicit SparseCholesky(std::shared_ptr<const BlockPattern> pattern);
  ~SparseCholesky();
  /// Factors the matrix; reads its upper triangle only. Returns false if it is not positive definite.
  /// @throws InvalidArgument for another pattern, if memory runs out, or if CHOLMOD fails for another reason.
  [[nodiscard]] bool factor(const BlockMatrix& matrix);
  /// Solves A x = b with the last factor; b and x are N x 3.
  /// @throws InvalidArgument unless factor() succeeded, and for vectors of the wrong size.
  void solve(std::span<const Vec3> b, std::span<Vec3> x) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace incise
