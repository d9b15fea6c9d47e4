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
#include <span>
#include <vector>

namespace incise {

/// Resolution of the bench's computation. It is a part of the bench: results depend on it.
struct BenchResolution {
  double fine_mm = 1.1;    ///< edge length of the tets round the tumour's ring, > 0
  double coarse_mm = 6.0;  ///< edge length far from it, >= fine_mm
  double way_mm = 0.5;     ///< greatest travel of the tool in a step, at its mean speed, > 0
};
inline void describe(Visitor& v, BenchResolution& r) {
  v("fine_mm", r.fine_mm, "Edge length of the tets round the tumour's ring.", kPositive);
  v("coarse_mm", r.coarse_mm, "Edge length of the tets far from the ring.", kPositive);
  v("way_mm", r.way_mm, "Travel of the tool in a step.", kPositive);
}

/// A virtual specimen in its holder: clamped, its tip pulled forward. Lengths in mm, LPS frame of its CT. Hidden from
/// the planner.
struct BenchBody {
  Specimen specimen;
  BenchResolution resolution;
  std::shared_ptr<const TissueModel> tissue;  ///< stable Neo-Hookean, fibres, viscous, stiffer inside the tumour
  TissueState stretched;                      ///< equilibrium, every viscous branch relaxed
  std::vector<double> toughness_kpa;          ///< per tet: energy density at which it parts
  std::vector<BoundaryFace> skin;             ///< of the uncut body
  std::vector<EmbeddedPoint> tumor_edge;      ///< material points, counter-clockwise seen from above
  Contour tumor_edge_rest;                    ///< positions of these points at rest
  Vec3 approach = -Vec3::UnitZ();             ///< unit; the direction in which camera and surgeon look
  double stretch_force_n = 0.0;               ///< the suture's pull, without the load cell's error
  Outcome outcome =
      Outcome::NotConverged;  ///< Success, ElementInverted (in equilibrium, but tets turned inside out) or NotConverged
  double equilibrium_residual = 0.0;  ///< norm of the free residual divided by the norm of the reactions
  std::size_t inverted_tets = 0;
};

/// Appends the boundary of the tissue that is left and, for each of its triangles, 1 if it is part of the uncut skin.
/// @param is_live  per tet: 0 where it was removed.
void add_faces(const BenchBody& body, std::span<const std::uint8_t> is_live, std::vector<Triangle>& triangles,
               std::vector<std::uint8_t>& is_skin);

/// Returns the settings of the phantom with the specimen's shape, tumour and scanner noise.
[[nodiscard]] PhantomSettings phantom_settings(const Specimen& specimen);

/// Makes the body of a specimen, clamps and stretches it. The same specimen and resolution give the same bits.
/// A body without equilibrium is returned, with its `outcome`; do not read or cut it.
/// @throws CaseError naming the first parameter out of range; Error for a tumour edge off the tissue; Cancelled.
[[nodiscard]] BenchBody make_body(const Specimen& specimen, const BenchResolution& resolution, Workers& workers,
                                  Monitor& monitor);

/// Returns the tumour's edge for given positions of the mesh's vertices: closed, mm.
[[nodiscard]] Contour tumor_edge_at(const BenchBody& body, std::span<const Vec3> positions);

/// Returns the closed skin of the uncut body for given positions, with all vertices of the mesh.
[[nodiscard]] TriMesh skin_at(const BenchBody& body, std::span<const Vec3> positions);

}  // namespace incise
