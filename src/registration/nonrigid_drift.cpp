#include "registration/gauss_field.hpp"
#include "registration/matching.hpp"

#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/registration/nonrigid_drift.hpp>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace incise {
namespace {

using Matrix = Eigen::MatrixXd;
constexpr std::size_t kRows = 256;      // rows of the basis per chunk
constexpr double kCenterSpacing = 0.5;  // in units of β

/// The deformation as a sum of Gaussians, and its M-step.
class SmoothField {
 public:
  SmoothField(const Points& source, double width, std::size_t most_centers)
      : centers_(spread_centers(source, kCenterSpacing * width, most_centers)),
        basis_(gaussians(source, centers_, width)),
        stiffness_(gaussians(centers_, centers_, width)) {}

  [[nodiscard]] std::size_t rank() const { return centers_.size(); }

  /// Solves (Φᵀ D Φ + λσ² G) W = Φᵀ (PX - D Y) and returns Φ W, the displacements of all source points (M x 3); nullopt
  /// if the system cannot be solved.
  [[nodiscard]] std::optional<Matrix> displacements(const Points& source, const std::vector<GaussSum>& held,
                                                    double cost, Workers& workers) const {
    const auto rank = static_cast<Eigen::Index>(centers_.size());
    const std::size_t chunks = Workers::chunk_count(source.size(), kRows);
    std::vector<Matrix> normal(chunks);
    std::vector<Matrix> right(chunks);
    workers.for_chunks(source.size(), kRows, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      const auto rows = static_cast<Eigen::Index>(end - begin);
      const auto part = basis_.middleRows(static_cast<Eigen::Index>(begin), rows);
      Eigen::VectorXd shares(rows);
      Matrix pull(rows, 3);
      for (Eigen::Index i = 0; i < rows; ++i) {
        const std::size_t at = begin + static_cast<std::size_t>(i);
        shares[i] = held[at].weight;
        pull.row(i) = (held[at].first - held[at].weight * source[at]).transpose();
      }
      normal[chunk].noalias() = part.transpose() * (shares.asDiagonal() * part);
      right[chunk].noalias() = part.transpose() * pull;
    });
    Matrix system = cost * stiffness_;
    // Centres much closer than β make G singular to rounding.
    system.diagonal().array() += 1e-10 * (cost + 1.0);
    Matrix pulled = Matrix::Zero(rank, 3);
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
      system += normal[chunk];
      pulled += right[chunk];
    }
    const Eigen::LDLT<Matrix> factor(system);
    if (factor.info() != Eigen::Success) return std::nullopt;
    const Matrix weights = factor.solve(pulled);
    if (!weights.allFinite()) return std::nullopt;
    return Matrix(basis_ * weights);
  }

 private:
  Points centers_;
  Matrix basis_;
  Matrix stiffness_;
};

}  // namespace

NonrigidDrift nonrigid_drift(std::span<const Vec3> source, std::span<const Vec3> target,
                             const NonrigidSettings& settings, Workers& workers, Monitor& monitor) {
  require_none(problems_of(settings));
  INCISE_REQUIRE(!source.empty() && !target.empty(), "expected at least 1 point in each cloud");
  const Measure source_measure = measure_of(source);
  const Measure target_measure = measure_of(target);
  INCISE_REQUIRE(source_measure.center.allFinite() && target_measure.center.allFinite(), "expected finite points");
  NonrigidDrift drift;
  drift.moved_mm.assign(source.begin(), source.end());
  if (is_line(source_measure.variances) || is_line(target_measure.variances)) {
    drift.outcome = DriftOutcome::Degenerate;
    return drift;
  }
  // One origin and one length for both clouds, which keeps their relative position.
  const double length = source_measure.radius;
  const Points y = normalised(source, source_measure.center, length);
  const Points x = normalised(target, source_measure.center, length);
  const SmoothField field(y, settings.smoothness, static_cast<std::size_t>(settings.max_centers));
  drift.rank = static_cast<int>(field.rank());
  Points placed = y;
  const Measure x_measure = measure_of(x);
  double sigma =
      settings.first_sigma
          ? *settings.first_sigma
          : std::sqrt((1.0 + x_measure.variances.sum() + x_measure.center.squaredNorm()) / settings.dimensions);
  int still = 0;
  while (drift.iterations < settings.max_iterations) {
    if (monitor.is_cancelled()) {
      drift.outcome = DriftOutcome::Cancelled;
      break;
    }
    const double noise = background(sigma, settings.outlier_weight, settings.dimensions, static_cast<double>(y.size()),
                                    static_cast<double>(x.size()));
    const std::vector<GaussSum> near = GaussField(placed, {}, sigma).at(x, workers);
    std::vector<double> shares(x.size());
    double count = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double all = near[i].weight + noise;
      shares[i] = all > 0.0 ? 1.0 / all : 0.0;
      count += shares[i] * near[i].weight;
    }
    const std::vector<GaussSum> held = GaussField(x, shares, sigma).at(placed, workers);
    const std::optional<Matrix> moves = field.displacements(y, held, settings.stiffness * sigma * sigma, workers);
    if (!moves || !(count > 0.0)) {
      drift.outcome = DriftOutcome::Degenerate;
      break;
    }
    double step = 0.0;
    double misfit = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) {
      const Vec3 now = y[i] + moves->row(static_cast<Eigen::Index>(i)).transpose();
      step += (now - placed[i]).squaredNorm();
      placed[i] = now;
      misfit += held[i].second - 2.0 * held[i].first.dot(now) + held[i].weight * now.squaredNorm();
    }
    ++drift.iterations;
    drift.matched_share = count / static_cast<double>(x.size());
    sigma = std::sqrt(std::max(0.0, misfit) / (count * settings.dimensions));
    still = std::sqrt(step / static_cast<double>(y.size())) < settings.tolerance ? still + 1 : 0;
    if (still >= 2 || sigma < kLeastSigma) {
      drift.outcome = DriftOutcome::Converged;
      break;
    }
  }
  for (std::size_t i = 0; i < y.size(); ++i) {
    drift.moved_mm[i] = length * placed[i] + source_measure.center;
    drift.largest_move_mm = std::max(drift.largest_move_mm, (drift.moved_mm[i] - source[i]).norm());
  }
  drift.sigma_mm = sigma * length;
  return drift;
}

}  // namespace incise
