#include "registration/observability.hpp"

#include "registration/icp.hpp"

#include <incise/core/units.hpp>

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

constexpr std::size_t kMostPoints = 3000;
// The distances of neighbouring points share the error of their plane and the curvature of the surface, so the number
// of independent ones is smaller than the number of pairs.
constexpr double kPairsPerIndependent = 4.0;
constexpr double kLeastVisible = 1e-12;

struct Overlap {
  std::vector<SurfacePair> pairs;  // within three robust standard deviations
  std::vector<std::size_t> indices;
  Vec3 center = Vec3::Zero();
  double length = 0.0;  // rms distance from the centre
  double rms = 0.0;     // of the distances
};

Overlap overlap_of(const SampledSurface& source, const SampledSurface& target, const Similarity& t, double width,
                   Workers& workers) {
  Overlap overlap;
  for (const SurfacePair& pair :
       pairs_of(source, spread_indices(source.cloud.points.size(), kMostPoints), target, t, workers)) {
    if (std::abs(pair.distance) > 1.2 * width) continue;  // 3 robust standard deviations
    overlap.pairs.push_back(pair);
    overlap.indices.push_back(pair.source);
    overlap.center += pair.place;
    overlap.rms += pair.distance * pair.distance;
  }
  const double n = std::max<double>(1.0, static_cast<double>(overlap.pairs.size()));
  overlap.center /= n;
  overlap.rms = std::sqrt(overlap.rms / n);
  for (const SurfacePair& pair : overlap.pairs) overlap.length += (pair.place - overlap.center).squaredNorm() / n;
  overlap.length = std::sqrt(overlap.length);
  return overlap;
}

/// Returns the displacement of a point by small motions, 3 x 7.
Eigen::Matrix<double, 3, 7> motion_of(const Vec3& arm) {
  Eigen::Matrix<double, 3, 7> m;
  m.leftCols<3>() << 0.0, arm.z(), -arm.y(), -arm.z(), 0.0, arm.x(), arm.y(), -arm.x(), 0.0;
  m.middleCols<3>(3) = Mat3::Identity();
  m.col(6) = arm;
  return m;
}

/// Returns the mean squared distance, each capped, of those source points that still lie above the target. (The cloud's
/// edge carries no information: it is only the edge of the camera's picture.)
double mean_square(const SampledSurface& source, const std::vector<std::size_t>& indices, const SampledSurface& target,
                   const Similarity& t, double cap, Workers& workers) {
  const std::vector<SurfacePair> pairs = pairs_of(source, indices, target, t, workers);
  double sum = 0.0;
  for (const SurfacePair& pair : pairs) sum += std::min(pair.distance * pair.distance, cap * cap);
  return pairs.empty() ? cap * cap : sum / static_cast<double>(pairs.size());
}

std::string name_of(const Vec7& direction, double length) {
  const double turn = direction.head<3>().norm() * length;
  const double shift = direction.segment<3>(3).norm();
  const double stretch = std::abs(direction[6]) * length;
  const Vec3 along = direction.segment<3>(3).stableNormalized();
  const Vec3 axis = direction.head<3>().stableNormalized();
  std::string text;
  const double all = turn + shift + stretch;
  const auto add = [&](double part, const std::string& name) {
    if (part < 0.25 * all) return;
    text += (text.empty() ? "" : " with ") + name;
  };
  add(shift, fmt::format("a shift along ({:.2f}, {:.2f}, {:.2f})", along.x(), along.y(), along.z()));
  add(turn, fmt::format("a turn about ({:.2f}, {:.2f}, {:.2f})", axis.x(), axis.y(), axis.z()));
  add(stretch, "a change of scale");
  return text;
}

/// Returns how far unit turns (rad), shifts and stretches move points about the centroid, rms. Averaged over all axes,
/// the squared displacement by a turn is two thirds of the squared arm.
Vec7 arms_of(double length) {
  Vec7 arms = Vec7::Ones();
  arms.head<3>().setConstant(std::sqrt(2.0 / 3.0) * length);
  arms[6] = length;
  return arms;
}

}  // namespace

PoseObservability pose_observability(const SampledSurface& source, const SampledSurface& target, const Similarity& t,
                                     double width, bool with_scale, Workers& workers) {
  PoseObservability certificate;
  const Overlap overlap = overlap_of(source, target, t, width, workers);
  const int motions = with_scale ? 7 : 6;
  certificate.motions = motions;
  certificate.center_mm = overlap.center;
  if (overlap.pairs.size() < 12) {
    certificate.sd_mm = certificate.weakest_sd_mm = std::numeric_limits<double>::infinity();
    return certificate;
  }
  Mat7 seen = Mat7::Zero();
  Mat7 moved_by = Mat7::Zero();
  for (const SurfacePair& pair : overlap.pairs) {
    const Vec7 g = pair_gradient(pair, overlap.center);
    const Eigen::Matrix<double, 3, 7> m = motion_of(pair.place - overlap.center);
    seen += g * g.transpose();
    moved_by += m.transpose() * m;
  }
  const auto pairs = static_cast<double>(overlap.pairs.size());
  const Eigen::MatrixXd a = seen.topLeftCorner(motions, motions) / pairs;
  Eigen::MatrixXd b = moved_by.topLeftCorner(motions, motions) / pairs;
  b.diagonal().array() += 1e-12 * b.trace();  // if the overlap is a line, one turn moves nothing
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(a, b);
  const double step =
      std::max({2.0 * std::max(target.spacing, t.scale * source.spacing), 3.0 * overlap.rms, 0.01 * overlap.length});
  const double cap = 3.0 * overlap.rms + step;
  const double at_rest = mean_square(source, overlap.indices, target, t, cap, workers);
  const double independent = std::max(1.0, pairs / kPairsPerIndependent);
  double total = 0.0;
  for (int k = 0; k < motions; ++k) {
    Vec7 direction = Vec7::Zero();
    direction.head(motions) = solver.eigenvectors().col(k);
    double visible = std::clamp(solver.eigenvalues()[k], 0.0, 1.0);
    certificate.visible[static_cast<std::size_t>(k)] = visible;
    if (k < 2) {
      const double there =
          mean_square(source, overlap.indices, target, nudged(t, step * direction, overlap.center), cap, workers);
      const double back =
          mean_square(source, overlap.indices, target, nudged(t, -step * direction, overlap.center), cap, workers);
      visible = std::clamp((0.5 * (there + back) - at_rest) / (step * step), 0.0, 1.0);
      certificate.sharpness[static_cast<std::size_t>(k)] = visible;
    }
    const double variance = overlap.rms * overlap.rms / (independent * std::max(visible, kLeastVisible));
    total += variance;
    // Not always motion 0: only the first two are measured, and measuring may find them more visible than a later one.
    const double sd = std::sqrt(variance);
    if (k == 0 || sd > certificate.weakest_sd_mm) {
      certificate.weakest_sd_mm = sd;
      certificate.weakest = name_of(direction, overlap.length);
    }
    certificate.covariance += variance * direction * direction.transpose();
  }
  set_covariance(certificate, certificate.covariance, certificate.center_mm, overlap.length);
  certificate.sd_mm = std::sqrt(total);
  return certificate;
}

void set_covariance(PoseObservability& certificate, const Mat7& covariance, const Vec3& center, double length) {
  certificate.covariance = covariance;
  certificate.center_mm = center;
  const Vec7 variances = covariance.diagonal();
  certificate.rotation_sd_deg = units::deg_from_rad(std::sqrt(variances.head<3>().sum()));
  certificate.translation_sd_mm = std::sqrt(variances.segment<3>(3).sum());
  certificate.scale_sd = std::sqrt(variances[6]);
  certificate.sd_mm = std::sqrt(arms_of(length).cwiseAbs2().dot(variances));
}

void find_weakest(PoseObservability& certificate, double length) {
  const Vec7 arms = arms_of(length);
  const Mat7 moved = arms.asDiagonal() * certificate.covariance * arms.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Mat7> solver(moved);
  certificate.weakest_sd_mm = std::sqrt(std::max(0.0, solver.eigenvalues()[6]));
  certificate.weakest = name_of(solver.eigenvectors().col(6).cwiseQuotient(arms), length);
}

}  // namespace incise
