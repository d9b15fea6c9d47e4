#pragma once

#include <incise/core/workers.hpp>
#include <incise/geometry/neighbours.hpp>
#include <incise/geometry/point_cloud.hpp>
#include <incise/registration/similarity.hpp>

#include <optional>
#include <span>
#include <vector>

namespace incise {

/// A cloud as a surface that points can be compared with: its points, their normals, and how far apart they lie.
struct SampledSurface {
  PointCloud cloud;  ///< with normals
  bool has_oriented_normals = false;
  double spacing = 0.0;    ///< median distance to the nearest neighbour
  double roughness = 0.0;  ///< see roughness_mm: how much its points and normals can be relied upon
  NeighbourSearch search;

  /// @param cloud  normals, where it has none, are fitted and have no meaningful side.
  SampledSurface(PointCloud cloud, Workers& workers);

 private:
  SampledSurface(const SampledSurface& like, PointCloud moved);
  friend SampledSurface with_cloud(const SampledSurface& like, PointCloud moved);
};

/// The same surface moved or reflected as a whole, with its size kept: what was measured of it holds on.
[[nodiscard]] SampledSurface with_cloud(const SampledSurface& like, PointCloud moved);

/// A source point beside the target's surface.
struct SurfacePair {
  std::size_t source = 0;
  Vec3 place = Vec3::Zero();  ///< of the moved source point
  /// Mean of both normals, the smoother cloud's counting more: between two equally rough ones a plane halfway between
  /// two curved surfaces
  /// ([Rusinkiewicz2019]), between a model and a noisy cloud the model's.
  Vec3 normal = Vec3::Zero();
  double distance = 0.0;  ///< along the normal, from target to source
  double weight = 1.0;
};

/// How much the target's roughness is of both together, by squares: the share with which pairs sought from the target
/// count, because there each of its rough points counts once.
[[nodiscard]] double target_share(const SampledSurface& source, const SampledSurface& target);

/// How far beside its nearest target point, in spacings, a source point may lie to be above the target's surface and
/// not beyond its edge.
inline constexpr double kEdgeSpacings = 2.0;

/// The source's point `index` beside the target, if it lies above it (not beyond its edge) and the normals agree within
/// 60 degrees; where one cloud's normals have no side, either side agrees.
[[nodiscard]] std::optional<SurfacePair> pair_of(const SampledSurface& source, std::size_t index,
                                                 const SampledSurface& target, const Similarity& t);

/// Pairs of the given source points, in their order.
[[nodiscard]] std::vector<SurfacePair> pairs_of(const SampledSurface& source, std::span<const std::size_t> indices,
                                                const SampledSurface& target, const Similarity& t, Workers& workers);

/// The same the other way: for each of the given target points its nearest source point. A dense, noisy target then
/// counts with all its points.
[[nodiscard]] std::vector<SurfacePair> reverse_pairs_of(const SampledSurface& source, const SampledSurface& target,
                                                        std::span<const std::size_t> indices, const Similarity& t,
                                                        Workers& workers);

/// How well surfaces lie on each other: Σ exp(-d²/2τ²) over the source's pairs, as a share of the source points asked.
[[nodiscard]] double overlap_score(const SampledSurface& source, std::span<const std::size_t> indices,
                                   const SampledSurface& target, const Similarity& t, double width);

/// How well a source lies on a target in one pose. Lengths in the clouds' unit.
struct Misfit {
  double score = 0.0;        ///< overlap_score
  double score_above = 0.0;  ///< the same as a share of the source points above the target: whatever the overlap
  double rmse = 0.0;         ///< of the distances below
  double inlier_fraction =
      0.0;                    ///< of the source's points: above the target, distance below 3 robust standard deviations
  double fit_fraction = 0.0;  ///< the same of the points above the target alone
  std::vector<double>
      distances;  ///< along the normals, of the points above the target and within a tenth of its radius
};

/// @param width  of the robust weight at the end of ICP; 1.2 times it is 3 robust standard deviations.
/// @param asked  the points that the score looks at. Both clouds in units of the target's radius.
[[nodiscard]] Misfit misfit_of(const SampledSurface& source, std::span<const std::size_t> asked,
                               const SampledSurface& target, const Similarity& t, double width, double score_width,
                               Workers& workers);

/// `count` numbers of [0, total), evenly spread, or all.
[[nodiscard]] std::vector<std::size_t> spread_indices(std::size_t total, std::size_t count);

}  // namespace incise
