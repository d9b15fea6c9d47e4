#include "registration/pose_search.hpp"

#include "registration/icp.hpp"
#include "registration/matching.hpp"

#include <incise/core/units.hpp>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace incise {
namespace {

// Widths of the coarse drift, in radii of the target: wide enough at first to pull a tongue over half a turn of
// the spiral of starts, narrow enough at the end for the clusters. Starts beside the centroid are narrower: a Gaussian
// that reaches the whole cloud pulls the centroids together, and the offset would be lost.
constexpr double kFirstSigma = 0.35;
constexpr double kFirstSigmaBeside = 0.18;
constexpr double kLastSigma = 0.07;
constexpr int kSteps = 18;
constexpr std::size_t kCoarsePoints = 300;
constexpr std::size_t kSearchPoints = 500;
constexpr std::size_t kFollowPoints = 400;
constexpr int kFollowSteps = 15;
constexpr std::size_t kFinePoints = 2000;
constexpr double kAlike = 0.08;             // rms distance, in radii, up to which two poses count as one
constexpr double kLeastSide = 0.3;          // length of the mean normal above which a cloud has an upper side
constexpr double kLargestSideAngle = 75.0;  // degrees between the mean normals

/// Returns the first level with enough clusters to show the shape.
const WeightedPoints& coarse_level(const std::vector<WeightedPoints>& levels) {
  for (const WeightedPoints& level : levels) {
    if (level.points.size() >= kCoarsePoints) return level;
  }
  return levels.back();
}

Vec3 mean_of(const Points& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  return sum / static_cast<double>(std::max<std::size_t>(1, points.size()));
}

/// Returns offsets of the source's centroid from the target's, in the source's frame: zero first, then to either side
/// along the source's two longer axes. If each cloud shows only a part, the centroids do not correspond: for two parts
/// of a strip with 60 % in common they are 1.4 standard deviations apart.
std::vector<Vec3> offsets_of(const Points& points) {
  Mat3 scatter = Mat3::Zero();
  for (const Vec3& p : points) scatter += p * p.transpose() / static_cast<double>(points.size());
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(scatter);
  std::vector<Vec3> offsets{Vec3::Zero()};
  for (const auto& [axis, spreads] : {std::pair(2, 0.5), std::pair(2, 1.1), std::pair(1, 0.6)}) {
    const double length = spreads * std::sqrt(std::max(0.0, axes.eigenvalues()[axis]));
    for (const double side : {-length, length}) offsets.emplace_back(side * axes.eigenvectors().col(axis));
  }
  return offsets;
}

/// First transform and width of a coarse drift.
struct Start {
  Similarity transform;
  double sigma = 0.0;
};

/// Combines every rotation with every offset.
std::vector<Start> starts_of(const SampledSurface& source, const SampledSurface& target,
                             const PoseSearchSettings& settings) {
  const bool knows_sides = source.has_oriented_normals && target.has_oriented_normals;
  const Vec3 up = mean_of(source.cloud.normals);
  const Vec3 target_up = mean_of(target.cloud.normals);
  const bool has_side = knows_sides && std::min(up.norm(), target_up.norm()) > kLeastSide;
  const double least_cosine = std::cos(units::rad_from_deg(kLargestSideAngle));
  const std::vector<Vec3> offsets = offsets_of(source.cloud.points);
  const double radius = measure_of(source.cloud.points).radius;
  // With bounds the scale starts between them; without, it is the ratio of the sizes.
  const double scale = settings.scale.high < 1e6 && settings.scale.low > 0.0
                           ? std::sqrt(settings.scale.low * settings.scale.high)
                           : std::clamp(1.0 / radius, settings.scale.low, settings.scale.high);
  std::vector<Start> starts;
  for (const Mat3& turn : even_rotations(settings.rotations)) {
    if (has_side && (turn * up).normalized().dot(target_up.normalized()) < least_cosine) continue;
    for (const Vec3& offset : offsets) {
      starts.push_back({{scale, turn, scale * (turn * offset)}, offset.isZero() ? kFirstSigma : kFirstSigmaBeside});
    }
  }
  return starts;
}

/// Runs a few steps with a width that shrinks on a schedule: it cannot stall, and every start costs the same.
Similarity coarse_drift(const WeightedPoints& source, const WeightedPoints& target, const Start& start,
                        const DriftSettings& settings, Workers& alone) {
  Similarity t = start.transform;
  double sigma = start.sigma;
  const double shrink = std::pow(kLastSigma / sigma, 1.0 / (kSteps - 1));
  for (int k = 0; k < kSteps; ++k, sigma *= shrink) {
    const MatchedTransform next = best_transform(match(source, target, t, sigma, settings, alone), settings);
    if (next.is_degenerate) break;
    t = next.transform;
  }
  return t;
}

/// Returns the best `keep` distinct poses, best first.
std::vector<Pose> distinct(std::vector<Pose> poses, std::span<const Vec3> source, std::size_t keep) {
  std::stable_sort(poses.begin(), poses.end(), [](const Pose& a, const Pose& b) { return a.score > b.score; });
  std::vector<Pose> kept;
  for (const Pose& pose : poses) {
    const bool is_new = std::none_of(kept.begin(), kept.end(), [&](const Pose& other) {
      return !differ(pose.transform, other.transform, source, kAlike);
    });
    if (is_new) kept.push_back(pose);
    if (kept.size() == keep) break;
  }
  return kept;
}

/// Improves every pose by ICP and scores it again.
void refine(std::vector<Pose>& poses, const SampledSurface& source, const SampledSurface& target,
            const IcpSettings& settings, double score_width, Workers& workers) {
  const std::vector<std::size_t> asked = spread_indices(source.cloud.points.size(), settings.max_points);
  workers.for_each(poses.size(), 1, [&](std::size_t k) {
    Workers alone(1);
    const Icp refined = icp(source, target, poses[k].transform, settings, alone);
    if (!refined.is_degenerate) poses[k].transform = refined.transform;
    poses[k].score = overlap_score(source, asked, target, poses[k].transform, score_width);
  });
}

}  // namespace

std::vector<Mat3> even_rotations(int count) {
  const double phi = std::sqrt(2.0);
  constexpr double kPsi = 1.533751168755204288118041;
  std::vector<Mat3> rotations;
  for (int i = 0; i < count; ++i) {
    const double s = i + 0.5;
    const double r = std::sqrt(s / count);
    const double R = std::sqrt(1.0 - s / count);
    const double a = 2.0 * units::kPi * s / phi;
    const double b = 2.0 * units::kPi * s / kPsi;
    rotations.push_back(
        Eigen::Quaterniond(R * std::cos(b), r * std::sin(a), r * std::cos(a), R * std::sin(b)).toRotationMatrix());
  }
  return rotations;
}

bool differ(const Similarity& a, const Similarity& b, std::span<const Vec3> source, double limit) {
  // A few points are accurate enough.
  Points few;
  for (const std::size_t i : spread_indices(source.size(), 50)) few.push_back(source[i]);
  return rms_difference_mm(a, b, few) > limit;
}

PoseSearch search_poses(const SampledSurface& source, const SampledSurface& target, const PoseSearchSettings& settings,
                        Workers& workers, Monitor& monitor) {
  const std::vector<Start> starts = starts_of(source, target, settings);
  PoseSearch search;
  search.starts = static_cast<int>(starts.size());
  const std::vector<WeightedPoints> source_levels = levels_of(source.cloud.points);
  const std::vector<WeightedPoints> target_levels = levels_of(target.cloud.points);
  const WeightedPoints& source_level = coarse_level(source_levels);
  const WeightedPoints& target_level = coarse_level(target_levels);
  DriftSettings drift;
  drift.scale = settings.scale;
  drift.outlier_weight = settings.outlier_weight;
  if (!(drift.scale.low > 0.0) || drift.scale.high > 1e6) {
    // Free scale: coarse clusters alone would let it collapse.
    const double middle = starts.empty() ? 1.0 : starts.front().transform.scale;
    drift.scale = {std::max(0.5 * middle, drift.scale.low), std::min(2.0 * middle, drift.scale.high)};
  }
  const std::vector<std::size_t> asked = spread_indices(source.cloud.points.size(), kSearchPoints);
  std::vector<Pose> poses(starts.size());
  constexpr std::size_t kAtOnce = 32;
  for (std::size_t first = 0; first < starts.size(); first += kAtOnce) {
    throw_if_cancelled(monitor, "searching poses");
    monitor.progress("searching poses", 0.6 * static_cast<double>(first) / static_cast<double>(starts.size()));
    workers.for_each(std::min(kAtOnce, starts.size() - first), 1, [&](std::size_t k) {
      Workers alone(1);
      Pose& pose = poses[first + k];
      pose.transform = coarse_drift(source_level, target_level, starts[first + k], drift, alone);
      pose.score = overlap_score(source, asked, target, pose.transform, 3.0 * settings.score_width);
    });
  }
  // Scores of rough poses rank them only roughly. Improving many of them with few points shows which deserve more work.
  poses = distinct(std::move(poses), source.cloud.points, settings.followed);
  IcpSettings improving{.scale = settings.scale,
                        .first_width = 2.0 * kLastSigma,
                        .tolerance = 5e-4,
                        .max_iterations = kFollowSteps,
                        .max_points = kFollowPoints};
  refine(poses, source, target, improving, 2.0 * settings.score_width, workers);
  poses = distinct(std::move(poses), source.cloud.points, settings.refined);
  improving.max_iterations = 40;
  improving.max_points = kFinePoints;
  refine(poses, source, target, improving, settings.score_width, workers);
  monitor.progress("searching poses", 1.0);
  search.poses = distinct(std::move(poses), source.cloud.points, settings.keep);
  return search;
}

}  // namespace incise
