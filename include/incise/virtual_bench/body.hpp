#pragma once

#include <incise/core/monitor.hpp>
#include <incise/core/outcome.hpp>
#include <incise/geometry/contour.hpp>
#include <incise/geometry/surface_query.hpp>
#include <incise/imaging/phantom.hpp>
#include <incise/mechanics/tissue.hpp>
#include <incise/virtual_bench/specimen.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace incise {

/// How finely the bench computes. Part of what the bench is: results change with it.
struct BenchResolution {
  double fine_mm = 1.1;    ///< edge length of the tets round the tumour's ring, > 0
  double coarse_mm = 6.0;  ///< far from it, >= fine_mm
  double way_mm = 0.5;     ///< of the tool in a step, > 0
};
inline void describe(Visitor& v, BenchResolution& r) {
  v("fine_mm", r.fine_mm, "Edge length of the tets round the tumour's ring.", kPositive);
  v("coarse_mm", r.coarse_mm, "Far from it.", kPositive);
  v("way_mm", r.way_mm, "Of the tool in a step.", kPositive);
}

/// A virtual specimen in its holder: clamped, its tip pulled forward. mm, LPS frame of its CT. Hidden from whoever
/// plans.
struct BenchBody {
  Specimen specimen;
  BenchResolution resolution;
  std::shared_ptr<const TissueModel> tissue;  ///< stable Neo-Hookean, fibres, viscous, stiffer inside the tumour
  TissueState stretched;                      ///< equilibrium, every viscous branch relaxed
  std::vector<double> toughness_kpa;          ///< per tet: energy density at which it parts
  std::vector<BoundaryFace> skin;             ///< of the uncut body
  std::vector<EmbeddedPoint> tumor_edge;      ///< material points, counter-clockwise seen from above
  Contour tumor_edge_rest;                    ///< where they lie at rest
  TriMesh tumor_rest;                         ///< closed surface of the inclusion at rest
  Vec3 approach = -Vec3::UnitZ();             ///< as camera and surgeon look
  double stretch_force_n = 0.0;               ///< the suture's pull, without the load cell's error
  Outcome outcome =
      Outcome::NotConverged;  ///< Success, ElementInverted (in equilibrium, but tets turned inside out) or NotConverged
  double equilibrium_residual = 0.0;  ///< |free residual| over |reactions|
  std::size_t inverted_tets = 0;
  double wall_s = 0.0;
};

/// What a phantom with the specimen's shape, tumour and scanner noise is made from.
[[nodiscard]] PhantomSettings phantom_settings(const Specimen& specimen);

/// Makes the body of a specimen, holds and stretches it. The same specimen and resolution give the same bits.
/// A body that finds no equilibrium is a result: its `outcome` says so, and nothing can be read or cut.
/// @throws CaseError listing what validate(specimen) finds; Cancelled.
[[nodiscard]] BenchBody make_body(const Specimen& specimen, const BenchResolution& resolution, Workers& workers,
                                  Monitor& monitor);

/// Where the tumour's edge lies for the given positions of the mesh's vertices.
[[nodiscard]] Contour tumor_edge_at(const BenchBody& body, std::span<const Vec3> positions);

/// The skin in a configuration, closed; all vertices of the mesh are kept.
[[nodiscard]] TriMesh skin_at(const BenchBody& body, std::span<const Vec3> positions);

}  // namespace incise
