#include "registration/surface_match.hpp"

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr int kNormalNeighbours = 16;
constexpr double kLeastNormalAgreement = 0.5;  // cosine of 60 degrees

PointCloud with_some_normals(PointCloud cloud, Workers& workers) {
  if (!cloud.normals.empty()) return cloud;
  return with_normals(std::move(cloud), -Vec3::UnitZ(), kNormalNeighbours, workers);
}

/// Returns the two points as a pair, if the source point lies above the target and the normals agree.
std::optional<SurfacePair> paired(const SampledSurface& source, std::size_t index, const Vec3& place,
                                  const SampledSurface& target, std::size_t near, const Similarity& t) {
  const Vec3& target_normal = target.cloud.normals[near];
  Vec3 source_normal = t.rotation * source.cloud.normals[index];
  const double agreement = source_normal.dot(target_normal);
  const bool has_side = source.has_oriented_normals && target.has_oriented_normals;
  if ((has_side ? agreement : std::abs(agreement)) < kLeastNormalAgreement) return std::nullopt;
  if (agreement < 0.0) source_normal = -source_normal;
  const double share = target_share(source, target);
  SurfacePair pair{index, place, (share * source_normal + (1.0 - share) * target_normal).normalized()};
  const Vec3 apart = place - target.cloud.points[near];
  pair.distance = pair.normal.dot(apart);
  const double limit = kEdgeSpacings * std::max(target.spacing, t.scale * source.spacing);
  if (apart.squaredNorm() - pair.distance * pair.distance > limit * limit) return std::nullopt;
  return pair;
}

}  // namespace

SampledSurface::SampledSurface(PointCloud given, Workers& workers)
    : cloud(with_some_normals(given, workers)),
      has_oriented_normals(!given.normals.empty()),
      spacing(spacing_mm(given.points)),
      roughness(roughness_mm(given.points)),
      search(given.points) {}

SampledSurface::SampledSurface(const SampledSurface& like, PointCloud moved)
    : cloud(std::move(moved)),
      has_oriented_normals(like.has_oriented_normals),
      spacing(like.spacing),
      roughness(like.roughness),
      search(cloud.points) {}

double target_share(const SampledSurface& source, const SampledSurface& target) {
  const double all = source.roughness * source.roughness + target.roughness * target.roughness;
  return all > 0.0 ? target.roughness * target.roughness / all : 0.5;
}

std::optional<SurfacePair> pair_of(const SampledSurface& source, std::size_t index, const SampledSurface& target,
                                   const Similarity& t) {
  const Vec3 place = t(source.cloud.points[index]);
  return paired(source, index, place, target, target.search.nearest(place).index, t);
}

std::vector<SurfacePair> pairs_of(const SampledSurface& source, std::span<const std::size_t> indices,
                                  const SampledSurface& target, const Similarity& t, Workers& workers) {
  return collected(indices.size(), workers, [&](std::size_t i) { return pair_of(source, indices[i], target, t); });
}

std::vector<SurfacePair> reverse_pairs_of(const SampledSurface& source, const SampledSurface& target,
                                          std::span<const std::size_t> indices, const Similarity& t, Workers& workers) {
  const Similarity back = inverse(t);
  return collected(indices.size(), workers, [&](std::size_t i) {
    const std::size_t near = source.search.nearest(back(target.cloud.points[indices[i]])).index;
    return paired(source, near, t(source.cloud.points[near]), target, indices[i], t);
  });
}

double overlap_score(const SampledSurface& source, std::span<const std::size_t> indices, const SampledSurface& target,
                     const Similarity& t, double width) {
  double sum = 0.0;
  for (const std::size_t i : indices) {
    const auto pair = pair_of(source, i, target, t);
    if (pair) sum += std::exp(-0.5 * pair->distance * pair->distance / (width * width));
  }
  return indices.empty() ? 0.0 : sum / static_cast<double>(indices.size());
}

Misfit misfit_of(const SampledSurface& source, std::span<const std::size_t> asked, const SampledSurface& target,
                 const Similarity& t, double width, double score_width, Workers& workers) {
  constexpr double kBeside = 0.1;  // in radii of the target: a point farther away is not on its surface
  const std::size_t total = source.cloud.points.size();
  const std::vector<SurfacePair> pairs = pairs_of(source, spread_indices(total, total), target, t, workers);
  Misfit misfit;
  double squares = 0.0;
  std::size_t inliers = 0;
  for (const SurfacePair& pair : pairs) {
    inliers += std::abs(pair.distance) < 1.2 * width ? 1 : 0;
    misfit.score_above += std::exp(-0.5 * std::pow(pair.distance / score_width, 2)) / static_cast<double>(pairs.size());
    if (std::abs(pair.distance) > kBeside) continue;
    misfit.distances.push_back(pair.distance);
    squares += pair.distance * pair.distance;
  }
  const auto above = static_cast<double>(misfit.distances.size());
  misfit.score = overlap_score(source, asked, target, t, score_width);
  misfit.rmse = above > 0.0 ? std::sqrt(squares / above) : 0.0;
  misfit.inlier_fraction = static_cast<double>(inliers) / static_cast<double>(total);
  misfit.fit_fraction = pairs.empty() ? 0.0 : static_cast<double>(inliers) / static_cast<double>(pairs.size());
  return misfit;
}

std::vector<std::size_t> spread_indices(std::size_t total, std::size_t count) {
  std::vector<std::size_t> indices;
  count = std::min(total, count);
  indices.reserve(count);
  for (std::size_t k = 0; k < count; ++k) indices.push_back(k * total / count);
  return indices;
}

}  // namespace incise
