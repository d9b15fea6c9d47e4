#include "mechanics/tangent_solver.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace {

/// The coarse matrix is rebuilt after a system that took this many times the iterations per digit of the first system
/// after the last rebuild.
constexpr double kStaleGrowth = 1.3;

}  // namespace

TangentSolver::TangentSolver(const TissueModel& model, LinearSolver choice, int max_cg_iterations)
    : model_(model),
      choice_(choice),
      max_cg_iterations_(max_cg_iterations),
      is_iterative_(choice == LinearSolver::ConjugateGradients ||
                    (choice == LinearSolver::Automatic && model.mesh.vertices.size() > kMostVerticesForCholesky)) {}

void TangentSolver::forget() {
  is_coarse_stale_ = true;
}

TangentSolver::End TangentSolver::solve_by_cg(const BlockMatrix& matrix, std::span<const Vec3> b, std::span<Vec3> x,
                                              double tolerance, Workers& workers) {
  if (!pcg_) pcg_.emplace(model_.pattern, model_.mesh.vertices);
  const bool is_fresh = is_coarse_stale_;
  try {
    pcg_->update(matrix, is_fresh, workers);
  } catch (const InvalidArgument&) {  // a diagonal block or the coarse matrix is not positive definite
    return End::NotPositiveDefinite;
  }
  PcgSettings settings;
  settings.relative_tolerance = tolerance;
  settings.max_iterations = max_cg_iterations_;
  const PcgReport report = pcg_->solve(matrix, b, x, settings, workers);
  ++cg_systems_;
  cg_iterations_ += report.iterations;
  const int per_digit = static_cast<int>(report.iterations / -std::log10(tolerance));
  if (is_fresh) fresh_iterations_ = per_digit;
  is_coarse_stale_ = per_digit > kStaleGrowth * fresh_iterations_;
  if (report.is_indefinite) return End::NotPositiveDefinite;
  return report.converged ? End::Solved : End::NotConverged;
}

TangentSolver::End TangentSolver::solve(const BlockMatrix& matrix, std::span<const Vec3> b, std::span<Vec3> x,
                                        double tolerance, Workers& workers) {
  if (is_iterative_ && !has_given_way_) {
    const End end = solve_by_cg(matrix, b, x, tolerance, workers);
    if (end != End::NotConverged || choice_ == LinearSolver::ConjugateGradients) return end;
    has_given_way_ = true;
  }
  if (!cholesky_) cholesky_.emplace(model_.pattern);
  ++factorisations_;
  if (!cholesky_->factor(matrix)) return End::NotPositiveDefinite;
  cholesky_->solve(b, x);
  return End::Solved;
}

std::string TangentSolver::explanation() const {
  const std::size_t vertices = model_.mesh.vertices.size();
  const std::string reason = choice_ == LinearSolver::Automatic
                                 ? fmt::format("{} vertices, {} {}", vertices,
                                               is_iterative_ ? "more than" : "not more than", kMostVerticesForCholesky)
                                 : fmt::format("as requested; {} vertices", vertices);
  if (!is_iterative_) {
    return fmt::format("sparse Cholesky (CHOLMOD, supernodal, METIS; {}): {} factorisations", reason, factorisations_);
  }
  std::string text = fmt::format("two-level conjugate gradients ({}): {} iterations for {} systems", reason,
                                 cg_iterations_, cg_systems_);
  if (has_given_way_) {
    text +=
        fmt::format(". One system did not converge in {} iterations; from then on sparse Cholesky: {} factorisations",
                    max_cg_iterations_, factorisations_);
  }
  return text;
}

}  // namespace incise
