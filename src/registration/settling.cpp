#include "registration/settling.hpp"

#include "registration/icp.hpp"
#include "registration/levels.hpp"

#include <incise/core/median.hpp>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace incise {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

constexpr std::size_t kMostSettlingPoints = 3000;
constexpr std::size_t kMostCenters = 200;
constexpr double kSettlingCenterSpacing = 0.6;  // in units of the range
constexpr double kPatch = 3.5;          // radius of a fitted patch, in spacings of the target
constexpr std::size_t kFewestInPatch = 10;
constexpr double kRim = 0.35;            // largest distance of a patch's centroid from its point, in patch radii
constexpr double kLeastPatchAgreement = 0.3;  // cosine between a point's normal and those of its patch
constexpr double kFarthest = 0.15;       // from the target, in the clouds' unit: anything farther is another object
constexpr double kWeightWidths = 2.5;    // width of Welsch's weight, in robust standard deviations
constexpr double kSettlingPairsPerIndependent = 1.2;
constexpr double kRidge = 1e-6;

/// A source point and its distance from the target's patch above or below it.
struct Patch {
  std::size_t row = 0;    // index into Asked::cloud
  Vec3 place;             // position of the source point, without settling
  Vec3 normal;            // the source's
  double distance = 0.0;  // from the patch to `place` along the normal
  double weight = 0.0;    // falls to 0 towards the target's rim
};

/// The source points that are used, and the Gaussians of the settling.
struct Asked {
  PointCloud cloud;
  Points centers;
  Vec3 up = Vec3::Zero();  // mean normal, source frame
  Matrix basis;            // points x centres
  Matrix cost;             // centres x centres
};

Asked asked_of(const PointCloud& source, double range) {
  Asked asked;
  asked.cloud = subset(source, spread_indices(source.points.size(), kMostSettlingPoints));
  asked.centers = spread_centers(asked.cloud.points, kSettlingCenterSpacing * range, kMostCenters);
  for (const Vec3& n : source.normals) asked.up += n;
  asked.up.normalize();
  asked.basis = gaussians(asked.cloud.points, asked.centers, range);
  asked.cost = gaussians(asked.centers, asked.centers, range);
  asked.cost.diagonal().array() += kRidge;
  return asked;
}

/// Height of the target above a place along a normal, from a quadratic fitted to the target's points in the patch.
struct Height {
  double value = 0.0;
  double off_center = 0.0;  // distance of the points' centroid from the place, in patch radii
};
std::optional<Height> height_above(const SampledSurface& target, const Vec3& place, const Vec3& normal, double radius) {
  const Vec3 first = normal.unitOrthogonal();
  const Vec3 second = normal.cross(first);
  Mat6 system = Mat6::Zero();
  Vec6 right = Vec6::Zero();
  Vec2 middle = Vec2::Zero();
  double weight = 0.0;
  std::size_t count = 0;
  for (const Neighbour& near : target.search.within(place, 1.7 * radius)) {
    const Vec3 apart = target.cloud.points[near.index] - place;
    const Vec2 u(apart.dot(first), apart.dot(second));
    const double share = 1.0 - u.squaredNorm() / (radius * radius);
    const double agreement = target.cloud.normals[near.index].dot(normal);
    if (share <= 0.0 || (target.has_oriented_normals ? agreement : std::abs(agreement)) < kLeastPatchAgreement)
      continue;
    Vec6 b;
    b << 1.0, u.x(), u.y(), u.x() * u.x(), u.x() * u.y(), u.y() * u.y();
    system += share * b * b.transpose();
    right += share * apart.dot(normal) * b;
    middle += share * u;
    weight += share;
    ++count;
  }
  if (count < kFewestInPatch) return std::nullopt;
  const Vec6 fit = system.ldlt().solve(right);
  if (!fit.allFinite()) return std::nullopt;
  return Height{fit[0], middle.norm() / weight / radius};
}

class Settling {
 public:
  Settling(const SampledSurface& source, const SampledSurface& target, const Similarity& start,
           const SettlingSettings& settings, Workers& workers)
      : target_(target), settings_(settings), workers_(workers), asked_(asked_of(source.cloud, settings.range)) {
    result_.transform = start;
    weights_ = Vector::Zero(static_cast<Eigen::Index>(asked_.centers.size()));
  }

  SettledPose run() {
    while (result_.iterations < settings_.max_iterations && !result_.has_converged && !result_.is_degenerate) step();
    const Vector settled = result_.transform.scale * (asked_.basis * weights_);
    result_.settled_rms = std::sqrt(settled.squaredNorm() / static_cast<double>(settled.size()));
    result_.settled_largest = settled.cwiseAbs().maxCoeff();
    result_.settled = settled_source(settled);
    result_.apart_rms = result_.settled_rms;
    result_.apart_largest = result_.settled_largest;
    if (!result_.is_degenerate) measure_apart(settled);
    return result_;
  }

 private:
  [[nodiscard]] std::vector<Patch> patches() const {
    const Vector settled = asked_.basis * weights_;
    const double radius = kPatch * target_.spacing;
    return collected(asked_.cloud.points.size(), workers_, [&](std::size_t row) -> std::optional<Patch> {
      const Vec3& y = asked_.cloud.points[row];
      Patch patch{row, result_.transform(y), result_.transform.rotation * asked_.cloud.normals[row]};
      const Vec3 there = result_.transform(y + settled[static_cast<Eigen::Index>(row)] * asked_.up);
      const std::optional<Height> height = height_above(target_, there, patch.normal, radius);
      if (!height || height->off_center > kRim || std::abs(height->value) > kFarthest) return std::nullopt;
      patch.distance = -height->value - patch.normal.dot(there - patch.place);
      patch.weight = std::pow(1.0 - std::pow(height->off_center / kRim, 2), 2);
      return patch;
    });
  }

  [[nodiscard]] PointCloud settled_source(const Vector& raised) const {
    PointCloud cloud;
    const Vec3 up = result_.transform.rotation * asked_.up;
    for (std::size_t i = 0; i < asked_.cloud.points.size(); ++i) {
      cloud.points.push_back(result_.transform(asked_.cloud.points[i]) + raised[static_cast<Eigen::Index>(i)] * up);
      cloud.normals.push_back(result_.transform.rotation * asked_.cloud.normals[i]);
    }
    return cloud;
  }

  /// Measures the part of the settling that remains after the pose has absorbed as much of it as it can. The clouds
  /// cannot distinguish the absorbed part from a motion; only the prior on the settling's size decides between the two.
  void measure_apart(const Vector& settled) {
    const std::vector<Patch> found = patches();
    const Eigen::Index motions = settings_.scale.is_fixed() ? kMotions - 1 : kMotions;
    const Vec3 up = result_.transform.rotation * asked_.up;
    Matrix gradients(static_cast<Eigen::Index>(found.size()), motions);
    Vector raised(gradients.rows()), weight(gradients.rows());
    for (Eigen::Index i = 0; i < gradients.rows(); ++i) {
      const Patch& patch = found[static_cast<std::size_t>(i)];
      gradients.row(i) = unit_gradient(patch).transpose().head(motions);
      raised[i] = patch.normal.dot(up) * settled[static_cast<Eigen::Index>(patch.row)];
      weight[i] = patch.weight;
    }
    const Matrix weighted = gradients.transpose() * weight.asDiagonal();
    Matrix system = weighted * gradients;
    system.diagonal().array() += 1e-9 * system.trace();
    const Vector apart = raised - gradients * system.ldlt().solve(weighted * raised);
    if (!apart.allFinite() || !(weight.sum() > 0.0)) return;
    result_.apart_rms = std::sqrt(apart.cwiseAbs2().dot(weight) / weight.sum());
    result_.apart_largest = apart.cwiseProduct((weight.array() > 0.0).cast<double>().matrix()).cwiseAbs().maxCoeff();
  }

  /// One Gauss-Newton step of pose and settling together.
  void step() {
    const std::vector<Patch> found = patches();
    const auto rank = weights_.size();
    const auto rows = static_cast<Eigen::Index>(found.size());
    result_.is_degenerate = rows < 2 * kMotions;
    if (result_.is_degenerate) return;
    measure(found);
    Matrix jacobian(rows, kMotions + rank);
    Vector distance(rows);
    const Vec3 up = result_.transform.scale * (result_.transform.rotation * asked_.up);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const Patch& patch = found[static_cast<std::size_t>(i)];
      jacobian.row(i).head<kMotions>() = unit_gradient(patch).transpose();
      jacobian.row(i).tail(rank) = patch.normal.dot(up) * asked_.basis.row(static_cast<Eigen::Index>(patch.row));
      distance[i] = patch.distance;
    }
    solve(found, jacobian, distance);
  }

  void measure(const std::vector<Patch>& found) {
    result_.center = Vec3::Zero();
    for (const Patch& patch : found) result_.center += patch.place / static_cast<double>(found.size());
    double squares = 0.0;
    for (const Patch& patch : found) squares += (patch.place - result_.center).squaredNorm();
    result_.length = std::sqrt(squares / static_cast<double>(found.size()));
  }

  /// Returns pair_gradient with turns and the stretch in units of length.
  [[nodiscard]] Vec7 unit_gradient(const Patch& patch) const {
    Vec7 g = pair_gradient({.source = patch.row, .place = patch.place, .normal = patch.normal}, result_.center);
    g.head<3>() /= result_.length;
    g[6] /= result_.length;
    return g;
  }

  void solve(const std::vector<Patch>& found, const Matrix& jacobian, const Vector& distance) {
    const Eigen::Index rank = weights_.size();
    const Vector left = distance + jacobian.rightCols(rank) * weights_;
    std::vector<double> sizes(static_cast<std::size_t>(left.size()));
    for (Eigen::Index i = 0; i < left.size(); ++i) sizes[static_cast<std::size_t>(i)] = std::abs(left[i]);
    constexpr double kLeastNoise = 1e-6;  // identical clouds
    result_.noise = std::max(1.4826 * median(sizes), kLeastNoise);
    const double width = kWeightWidths * result_.noise;
    Vector weight(left.size());
    for (Eigen::Index i = 0; i < left.size(); ++i)
      weight[i] = found[static_cast<std::size_t>(i)].weight * std::exp(-0.5 * std::pow(left[i] / width, 2)) /
                  (kSettlingPairsPerIndependent * result_.noise * result_.noise);
    const double sd = 0.5 * settings_.largest;
    Matrix system = jacobian.transpose() * weight.asDiagonal() * jacobian;
    const double ridge = 1e-9 * system.topLeftCorner<kMotions, kMotions>().trace();
    system.topLeftCorner<kMotions, kMotions>().diagonal().array() += ridge;
    system.bottomRightCorner(rank, rank) += asked_.cost / (sd * sd);
    Vector right = -jacobian.transpose() * weight.cwiseProduct(distance);
    if (settings_.scale.is_fixed()) hold_scale(system, right, 0.0);
    Eigen::LDLT<Matrix> factor(system);
    Vector motion = factor.solve(right);
    bool is_scale_held = settings_.scale.is_fixed();
    const double wanted = result_.transform.scale * std::exp(motion[6] / result_.length);
    if (!is_scale_held && (wanted < settings_.scale.low || wanted > settings_.scale.high)) {
      // At the end of its range the scale is known; solve for the rest.
      const double kept = std::clamp(wanted, settings_.scale.low, settings_.scale.high);
      hold_scale(system, right, result_.length * std::log(kept / result_.transform.scale));
      factor.compute(system);
      motion = factor.solve(right);
      is_scale_held = true;
    }
    ++result_.iterations;
    result_.is_degenerate = !motion.allFinite();
    if (result_.is_degenerate) return;
    apply(motion, factor, is_scale_held);
  }

  static void hold_scale(Matrix& system, Vector& right, double change) {
    right -= change * system.col(6);
    system.row(6).setZero();
    system.col(6).setZero();
    system(6, 6) = 1.0;
    right[6] = change;
  }

  void apply(const Vector& motion, const Eigen::LDLT<Matrix>& factor, bool is_scale_held) {
    Vec7 units = Vec7::Ones();
    units.head<3>().setConstant(1.0 / result_.length);
    units[6] = 1.0 / result_.length;
    weights_ = motion.tail(weights_.size());
    result_.transform = nudged(result_.transform, units.cwiseProduct(motion.head<kMotions>()), result_.center);
    const Matrix columns = factor.solve(Matrix::Identity(motion.size(), kMotions));
    result_.covariance = units.asDiagonal() * columns.topRows<kMotions>() * units.asDiagonal();
    if (is_scale_held) {  // the entry of the scale only keeps the system solvable; it is no variance
      result_.covariance.row(6).setZero();
      result_.covariance.col(6).setZero();
    }
    result_.has_converged = result_.iterations > 2 && motion.head<kMotions>().norm() < settings_.tolerance;
  }

  static constexpr Eigen::Index kMotions = 7;

  const SampledSurface& target_;
  const SettlingSettings& settings_;
  Workers& workers_;
  Asked asked_;
  SettledPose result_;
  Vector weights_;  // of the Gaussians
};

}  // namespace

SettledPose settled_pose(const SampledSurface& source, const SampledSurface& target, const Similarity& start,
                         const SettlingSettings& settings, Workers& workers) {
  return Settling(source, target, start, settings, workers).run();
}

}  // namespace incise
