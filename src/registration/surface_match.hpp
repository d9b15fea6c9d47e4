#pragma once

#include <incise/core/workers.hpp>
#include <incise/geometry/neighbours.hpp>
#include <incise/geometry/point_cloud.hpp>
#include <incise/registration/similarity.hpp>

#include <optional>
#include <span>
#include <type_traits>
#include <vector>

namespace incise {

using Vec7 = Eigen::Matrix<double, 7, 1>;  ///< a small motion: rotation vector, translation, logarithm of the scale
using Mat7 = Eigen::Matrix<double, 7, 7>;

/// Returns what find(i), an optional, finds for i in [0, count), in order.
template <class Find>
[[nodiscard]] auto collected(std::size_t count, Workers& workers, const Find& find) {
  constexpr std::size_t kInAChunk = 64;
  using Found = std::vector<typename std::invoke_result_t<Find, std::size_t>::value_type>;
  std::vector<Found> parts(Workers::chunk_count(count, kInAChunk));
  workers.for_chunks(count, kInAChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (const auto one = find(i)) parts[chunk].push_back(*one);
    }
  });
  Found all;
  for (const Found& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// A cloud prepared as a surface for comparison: points, normals, spacing, roughness and a search structure.
struct SampledSurface {
  PointCloud cloud;  ///< with normals
  bool has_oriented_normals = false;
  double spacing = 0.0;    ///< median distance to the nearest neighbour
  double roughness = 0.0;  ///< see roughness_mm: noise of its points and normals
  NeighbourSearch search;

  /// @param cloud  if it has no normals, they are fitted, and their sign has no meaning.
  SampledSurface(PointCloud cloud, Workers& workers);
  /// The same surface, moved or reflected as a whole without a change of size: keeps spacing and roughness.
  SampledSurface(const SampledSurface& like, PointCloud moved);
};

/// A source point paired with the target's surface.
struct SurfacePair {
  std::size_t source = 0;     ///< index of the source point
  Vec3 place = Vec3::Zero();  ///< position of the moved source point
  /// Weighted mean of both normals; the smoother cloud's counts more. Between two equally rough clouds it is normal to
  /// a plane halfway between two curved surfaces ([Rusinkiewicz2019]); between a model and a noisy cloud it is the
  /// model's.
  Vec3 normal = Vec3::Zero();
  double distance = 0.0;  ///< along the normal, from target to source
  double weight = 1.0;
};

/// Returns the target's squared roughness over the sum of both squares, [0, 1]: the weight of pairs found from the
/// target, where each of its rough points counts once.
[[nodiscard]] double target_share(const SampledSurface& source, const SampledSurface& target);

/// Largest lateral distance, in spacings, of a source point from its nearest target point at which it is above the
/// target's surface and not beyond its edge.
inline constexpr double kEdgeSpacings = 2.0;

/// Returns the pair of source point `index`, if the point lies above the target (not beyond its edge) and the normals
/// agree within 60 degrees, up to sign unless both clouds have oriented normals.
[[nodiscard]] std::optional<SurfacePair> pair_of(const SampledSurface& source, std::size_t index,
                                                 const SampledSurface& target, const Similarity& t);

/// Returns the pairs of the given source points, in their order; points without a pair are left out.
[[nodiscard]] std::vector<SurfacePair> pairs_of(const SampledSurface& source, std::span<const std::size_t> indices,
                                                const SampledSurface& target, const Similarity& t, Workers& workers);

/// The same in the other direction: each of the given target points is paired with its nearest source point. All points
/// of a dense, noisy target then count.
[[nodiscard]] std::vector<SurfacePair> reverse_pairs_of(const SampledSurface& source, const SampledSurface& target,
                                                        std::span<const std::size_t> indices, const Similarity& t,
                                                        Workers& workers);

/// Returns how well the surfaces coincide, [0, 1]: Σ exp(-d²/2τ²) over the pairs of the given source points, divided by
/// their number. @param width  τ.
[[nodiscard]] double overlap_score(const SampledSurface& source, std::span<const std::size_t> indices,
                                   const SampledSurface& target, const Similarity& t, double width);

/// How well a source coincides with a target in one pose. Lengths in the clouds' unit.
struct Misfit {
  double score = 0.0;        ///< overlap_score
  double score_above = 0.0;  ///< the same, divided by the number of points above the target: independent of the overlap
  double rmse = 0.0;         ///< rms of `distances`
  double inlier_fraction =
      0.0;                    ///< of the source's points: above the target, distance below 3 robust standard deviations
  double fit_fraction = 0.0;  ///< the same as a share of the points above the target
  std::vector<double>
      distances;  ///< along the normals, of the points above the target and within a tenth of its radius
};

/// Returns the misfit of pose t.
/// @param asked  source points to score.  @param width  of the robust weight at the end of ICP; 1.2 times it is 3
/// robust standard deviations.  @param score_width  see overlap_score.
/// @pre both clouds are in units of the target's radius.
[[nodiscard]] Misfit misfit_of(const SampledSurface& source, std::span<const std::size_t> asked,
                               const SampledSurface& target, const Similarity& t, double width, double score_width,
                               Workers& workers);

/// Returns `count` indices spread evenly over [0, total), or all if there are fewer.
[[nodiscard]] std::vector<std::size_t> spread_indices(std::size_t total, std::size_t count);

}  // namespace incise
