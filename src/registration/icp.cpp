#include "registration/icp.hpp"

#include <incise/core/median.hpp>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <deque>

namespace incise {
namespace {

constexpr double kWidths = 2.5;       // final width of the weight, in robust standard deviations
constexpr double kShrink = 0.7;       // smallest factor by which the width changes per step
constexpr double kLeastWidth = 1e-6;  // of the target's spacing: for identical clouds
constexpr double kDamping = 1e-6;     // of the mean diagonal
constexpr std::size_t kFewestPairs = 12;
constexpr std::size_t kWatched = 4;  // motions by which convergence is judged
constexpr double kJitter = 10.0;     // largest single motion at convergence, in tolerances

/// Whether the last motions cancel: changing nearest points let even a converged pose jitter.
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
  return 1.4826 * median(sizes);
}

Vec7 solve(Mat7 system, Vec7 right, double length, bool with_scale) {
  // Unknowns as lengths: a turn or stretch of 1 in these units moves a point at distance `length` by 1.
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

/// The robust sums of one Gauss-Newton step.
struct NormalEquations {
  Mat7 system = Mat7::Zero();
  Vec7 right = Vec7::Zero();
  Vec3 center = Vec3::Zero();  // of turns and stretches
  double length = 0.0;         // rms distance of the points from the centre
  double weight = 0.0;
};

NormalEquations equations_of(const std::vector<SurfacePair>& pairs, double width) {
  NormalEquations e;
  std::vector<double> weights(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    weights[i] = pairs[i].weight * std::exp(-0.5 * std::pow(pairs[i].distance / width, 2));
    e.center += weights[i] * pairs[i].place;
    e.weight += weights[i];
  }
  if (!(e.weight > 0.0)) return e;
  e.center /= e.weight;
  double squares = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Vec7 g = pair_gradient(pairs[i], e.center);
    e.system += weights[i] * g * g.transpose();
    e.right -= weights[i] * pairs[i].distance * g;
    squares += weights[i] * (pairs[i].place - e.center).squaredNorm();
  }
  e.length = std::sqrt(squares / e.weight);
  return e;
}

/// Solves the equations for the motion, with the scale kept in its range.
Vec7 bounded_motion(const NormalEquations& e, double scale, const ScaleRange& range) {
  const Vec7 motion = solve(e.system, e.right, e.length, !range.is_fixed());
  const double wanted = scale * std::exp(motion[6]);
  if (wanted >= range.low && wanted <= range.high) return motion;
  // At the end of its range the scale is known; solve for the rest.
  const double change = std::log(std::clamp(wanted, range.low, range.high) / scale);
  Vec7 bounded = solve(e.system, e.right - change * e.system.col(6), e.length, false);
  bounded[6] = change;
  return bounded;
}

/// Returns pairs found from both clouds; those found from the rougher one count more.
std::vector<SurfacePair> mutual_pairs(const SampledSurface& source, std::span<const std::size_t> of_source,
                                      const SampledSurface& target, std::span<const std::size_t> of_target,
                                      const Similarity& t, Workers& workers) {
  const double share = target_share(source, target);
  std::vector<SurfacePair> pairs = pairs_of(source, of_source, target, t, workers);
  for (SurfacePair& pair : pairs) pair.weight = 1.0 - share;
  for (SurfacePair& pair : reverse_pairs_of(source, target, of_target, t, workers)) {
    pair.weight = share;
    pairs.push_back(pair);
  }
  return pairs;
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
  return {stretch * t.scale, turn * t.rotation,
          center + motion.segment<3>(3) + stretch * (turn * (t.translation_mm - center))};
}

Icp icp(const SampledSurface& source, const SampledSurface& target, const Similarity& start,
        const IcpSettings& settings, Workers& workers) {
  Icp result;
  Similarity& t = result.transform;
  t = start;
  result.width = settings.first_width;
  const auto indices = [&settings](std::size_t total) {
    return spread_indices(total, settings.max_points > 0 ? settings.max_points : total);
  };
  const std::vector<std::size_t> of_source = indices(source.cloud.points.size());
  const std::vector<std::size_t> of_target = indices(target.cloud.points.size());
  std::deque<Vec7> last;  // motions, in lengths
  while (result.iterations < settings.max_iterations) {
    const std::vector<SurfacePair> pairs = mutual_pairs(source, of_source, target, of_target, t, workers);
    const double wanted = std::max(kWidths * robust_sd(pairs, result.width), kLeastWidth * target.spacing);
    result.width = std::max(std::min(result.width, wanted), kShrink * result.width);
    const NormalEquations e = equations_of(pairs, result.width);
    // Too little within reach of the robust weight to find a motion.
    result.is_degenerate = pairs.size() < kFewestPairs || !(e.weight > 1.0);
    if (result.is_degenerate) return result;
    Vec7 motion = bounded_motion(e, t.scale, settings.scale);
    result.is_degenerate = !motion.allFinite();
    if (result.is_degenerate) return result;
    t = nudged(t, motion, e.center);
    ++result.iterations;
    motion.head<3>() *= e.length;
    motion[6] *= e.length;
    last.push_back(motion);
    if (last.size() > kWatched) last.pop_front();
    if (last.size() == kWatched && has_settled(last, settings.tolerance)) {
      result.has_converged = true;
      return result;
    }
  }
  return result;
}

}  // namespace incise
