#include "registration/icp.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <deque>

namespace incise {
namespace {

using Vec7 = Eigen::Matrix<double, 7, 1>;
using Mat7 = Eigen::Matrix<double, 7, 7>;

constexpr double kWidths = 2.5;             // robust standard deviations that the weight's width shrinks to
constexpr double kShrink = 0.7;             // of the width, per step at most
constexpr double kDamping = 1e-6;           // of the mean diagonal
constexpr std::size_t kFewestPairs = 12;
constexpr std::size_t kWatched = 4;         // motions by which convergence is judged
constexpr double kJitter = 10.0;            // tolerances

/// New nearest points let the pose jitter about its place: it has settled when the motions cancel.
bool has_settled(const std::deque<Vec7>& last, double tolerance) {
  Vec7 mean = Vec7::Zero();
  double largest = 0.0;
  for (const Vec7& motion : last) {
    mean += motion / static_cast<double>(last.size());
    largest = std::max(largest, motion.norm());
  }
  return mean.norm() < tolerance && largest < kJitter * tolerance;
}

double robust_sd(const std::vector<SurfacePair>& pairs, double width) {
  std::vector<double> sizes;
  for (const SurfacePair& pair : pairs) {
    if (std::abs(pair.distance) < 3.0 * width) sizes.push_back(std::abs(pair.distance));
  }
  if (sizes.empty()) return width;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return 1.4826 * *middle;
}

Vec7 solve(Mat7 system, Vec7 right, double length, bool with_scale) {
  // Unknowns in lengths: a turn or a stretch of 1 moves a point at `length` by as much.
  Vec7 units = Vec7::Ones();
  units.head<3>().setConstant(1.0 / length);
  units[6] = 1.0 / length;
  system = units.asDiagonal() * system * units.asDiagonal();
  right = units.asDiagonal() * right;
  system.diagonal().array() += kDamping * system.trace() / 7.0;
  if (!with_scale) {
    system.row(6).setZero();
    system.col(6).setZero();
    system(6, 6) = 1.0;
    right[6] = 0.0;
  }
  return units.asDiagonal() * system.ldlt().solve(right);
}

}  // namespace

Vec7 pair_gradient(const SurfacePair& pair, const Vec3& center) {
  const Vec3 arm = pair.place - center;
  Vec7 g;
  g << arm.cross(pair.normal), pair.normal, pair.normal.dot(arm);
  return g;
}

Similarity nudged(const Similarity& t, const Vec7& motion, const Vec3& center) {
  const Mat3 turn = rotation_of(motion.head<3>());
  const double stretch = std::exp(motion[6]);
  return {stretch * t.scale, turn * t.rotation, center + motion.segment<3>(3) + stretch * (turn * (t.translation_mm - center))};
}

Icp icp(const SampledSurface& source, const SampledSurface& target, const Similarity& start, const IcpSettings& settings,
        Workers& workers) {
  Icp result;
  result.transform = start;
  result.width = settings.first_width;
  const std::size_t total = source.cloud.points.size();
  const std::vector<std::size_t> indices = spread_indices(total, settings.max_points > 0 ? settings.max_points : total);
  const std::size_t target_total = target.cloud.points.size();
  const std::vector<std::size_t> target_indices = spread_indices(target_total, settings.max_points > 0 ? settings.max_points : target_total);
  std::deque<Vec7> last;  // motions, in lengths
  for (result.iterations = 0; result.iterations < settings.max_iterations;) {
    Similarity& t = result.transform;
    std::vector<SurfacePair> pairs = pairs_of(source, indices, target, t, workers);
    std::vector<SurfacePair> reverse = reverse_pairs_of(source, target, target_indices, t, workers);
    const double share = target_share(source, target);
    for (SurfacePair& pair : pairs) pair.weight = 1.0 - share;
    for (SurfacePair& pair : reverse) pair.weight = share;
    pairs.insert(pairs.end(), reverse.begin(), reverse.end());
    result.pairs = pairs.size();
    if (pairs.size() < kFewestPairs) {
      result.is_degenerate = true;
      return result;
    }
    const double wanted = kWidths * robust_sd(pairs, result.width);
    result.width = std::max(std::min(result.width, wanted), kShrink * result.width);
    const double floor = 1e-9 * target.spacing;
    result.width = std::max(result.width, floor);
    Vec3 center = Vec3::Zero();
    double sum = 0.0;
    std::vector<double> weights(pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      weights[i] = pairs[i].weight * std::exp(-0.5 * std::pow(pairs[i].distance / result.width, 2));
      center += weights[i] * pairs[i].place;
      sum += weights[i];
    }
    center /= sum;
    Mat7 system = Mat7::Zero();
    Vec7 right = Vec7::Zero();
    double squares = 0.0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Vec7 g = pair_gradient(pairs[i], center);
      system += weights[i] * g * g.transpose();
      right -= weights[i] * pairs[i].distance * g;
      squares += weights[i] * (pairs[i].place - center).squaredNorm();
    }
    const double length = std::sqrt(squares / sum);
    Vec7 motion = solve(system, right, length, !settings.scale.is_fixed());
    const double scale = t.scale * std::exp(motion[6]);
    if (scale < settings.scale.low || scale > settings.scale.high) {
      // At the border of its range the scale is known; the rest is found for it.
      const double change = std::log(std::clamp(scale, settings.scale.low, settings.scale.high) / t.scale);
      motion = solve(system, right - change * system.col(6), length, false);
      motion[6] = change;
    }
    t = nudged(t, motion, center);
    ++result.iterations;
    Vec7 lengths = motion;
    lengths.head<3>() *= length;
    lengths[6] *= length;
    last.push_back(lengths);
    if (last.size() > kWatched) last.pop_front();
    if (last.size() == kWatched && has_settled(last, settings.tolerance)) {
      result.has_converged = true;
      return result;
    }
  }
  return result;
}

}  // namespace incise
