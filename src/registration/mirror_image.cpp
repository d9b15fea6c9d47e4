#include "registration/mirror_image.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace incise {
namespace {

constexpr std::size_t kFollowed = 2;  // poses that the search returns
constexpr std::size_t kTried = 40;    // poses of its coarse stage that are improved
constexpr std::size_t kRefined = 8;   // and refined
constexpr std::size_t kFewPoints = 2000;

Vec3 reflected(Vec3 v) {
  v.x() = -v.x();
  return v;
}

PointCloud reflected(PointCloud cloud) {
  for (Vec3& p : cloud.points) p = reflected(p);
  for (Vec3& n : cloud.normals) n = reflected(n);
  return cloud;
}

/// Returns the proper pose after a reflection in each principal plane, as poses of the source reflected in x: the two
/// reflections together are a rotation.
std::vector<Similarity> reflected_in_principal_planes(const Similarity& proper, const Points& points) {
  Mat3 scatter = Mat3::Zero();
  for (const Vec3& p : points) scatter += p * p.transpose();  // about the source's centroid, which is the origin
  const Mat3 axes = Eigen::SelfAdjointEigenSolver<Mat3>(scatter).eigenvectors();
  const Mat3 in_x = Vec3(-1.0, 1.0, 1.0).asDiagonal();
  std::vector<Similarity> poses;
  for (int k = 0; k < 3; ++k) {
    const Mat3 in_plane = Mat3::Identity() - 2.0 * axes.col(k) * axes.col(k).transpose();
    poses.push_back({proper.scale, proper.rotation * in_plane * in_x, proper.translation_mm});
  }
  return poses;
}

}  // namespace

Misfit mirror_image_misfit(const SampledSurface& source, const SampledSurface& target, const Similarity& proper,
                           const std::optional<PoseSearchSettings>& search, const IcpSettings& finish,
                           double score_width, Workers& workers, Monitor& monitor) {
  const SampledSurface mirror(source, reflected(source.cloud));
  std::vector<Similarity> starts = reflected_in_principal_planes(proper, source.cloud.points);
  if (search) {
    PoseSearchSettings few = *search;
    few.rotations = std::max(8, few.rotations / 2);  // usually one of the principal planes gives the best pose
    few.followed = kTried;
    few.refined = kRefined;
    few.keep = kFollowed;
    StopOnly quiet(monitor);
    for (const Pose& pose : search_poses(mirror, target, few, workers, quiet).poses) starts.push_back(pose.transform);
  }
  const std::vector<std::size_t> asked = spread_indices(mirror.cloud.points.size(), kScorePoints);
  IcpSettings rough = finish;
  rough.max_points = kFewPoints;
  rough.tolerance = 1e-3;
  Similarity best;
  double best_score = -1.0;
  for (const Similarity& start : starts) {
    const Icp done = icp(mirror, target, start, rough, workers);
    const double score = done.is_degenerate ? 0.0 : overlap_score(mirror, asked, target, done.transform, score_width);
    if (score <= best_score) continue;
    best_score = score;
    best = done.transform;
  }
  const Icp done = icp(mirror, target, best, finish, workers);
  return done.is_degenerate ? Misfit{}
                            : misfit_of(mirror, asked, target, done.transform, done.width, score_width, workers);
}

}  // namespace incise
