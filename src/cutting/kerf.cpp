#include "kerf.hpp"

#include "parted_tissue.hpp"
#include "point_kerf.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/kerf_contours.hpp>
#include <incise/geometry/surface_query.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace incise {
namespace {

constexpr double kBeyondWallMm =
    4.0;  // the search for live tissue beside the mid-line ends this far behind the kerf's mean wall, which is rough

constexpr double kEdgeOnSkinMm = 0.5;  // points of the tumour edge may lie this far outside the flat faces

/// The layer in which the inner edge of a cut by points is read: nodes below the body's border, where the kerf is
/// rounded.
constexpr KerfMidlineSettings kEdgeLayer{.layer_top_mm = 0.2, .layer_bottom_mm = 0.8, .min_coverage = 0.5};

/// The middle of the tumour or, without one, of the path: a point inside the ring.
Vec3 inside_of(const Contour& tumor_edge, const ToolPath& path) {
  return curve_centroid(tumor_edge.points.empty() ? entry_contour(path) : tumor_edge);
}

KerfInput kerf_input(const TissueModel& model, const TissueState& stretched, const ToolPath& path,
                     const IncisionSettings& settings, const CutRecord& record, const PointKerf* by_points) {
  KerfInput kerf;
  if (by_points != nullptr) {
    kerf.removed_tets = by_points->tets();
  } else {
    for (const Removal& removal : record.removals)
      kerf.removed_tets.push_back(corners_of(stretched.positions, model.mesh.tets[removal.tet.index()]));
  }
  kerf.surface = skin_of(model.mesh, stretched.positions);
  kerf.approach = settings.approach;
  kerf.inside_mm = inside_of(path.tumor_edge, path);
  kerf.is_closed = path.is_closed;
  return kerf;
}

bool has_edge(const ToolPath& path) {
  return path.tumor_edge.points.size() >= 3;
}

void require_on_tissue(bool is_on_tissue, std::size_t i) {
  INCISE_REQUIRE(is_on_tissue,
                 fmt::format("point {} of the tumour edge lies farther than {} mm from the tissue", i, kEdgeOnSkinMm));
}

/// Returns the positions after the cut of a curve's material points in the stretched tissue.
Contour carried(const Contour& curve, const std::function<std::optional<Vec3>(const Vec3&, double)>& place_after) {
  Contour moved{{}, curve.is_closed};
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const std::optional<Vec3> place = place_after(curve.points[i], kEdgeOnSkinMm);
    require_on_tissue(place.has_value(), i);
    moved.points.push_back(*place);
  }
  return moved;
}

CutSurface cut_surface(const TetMesh& mesh, const TissueState& tissue, const IncisionSettings& settings,
                       const Vec3& inside) {
  CutSurface surface;
  surface.vertices = tissue.positions;
  surface.approach = settings.approach;
  surface.inside_mm = inside;
  const std::vector<std::uint8_t> uncut = skin_faces(mesh);
  for (const BoundaryFace& face : boundary_faces(mesh, tissue.is_live)) {
    bool is_skin = false;
    for (int f = 0; f < 4; ++f) {
      const bool is_uncut = (uncut[face.tet.index()] >> f & 1) != 0;
      is_skin = is_skin || (is_uncut && face_of(mesh.tets[face.tet.index()], f) == face.corners);
    }
    surface.triangles.push_back(face.corners);
    surface.is_skin.push_back(is_skin ? 1 : 0);
  }
  return surface;
}

void measure_midline(const KerfInput& kerf, const KerfMidlineSettings& midline_settings, IncisionResult& result) {
  const KerfMidline midline = midline_contour(kerf, midline_settings);
  result.centerline = midline.contour;
  result.kerf_width_mm = midline.mean_width_mm;
  if (!kerf.is_closed) return;
  result.is_closed_loop = midline.is_closed;
  if (!midline.is_closed && std::isfinite(midline.gap_mm)) result.gap_mm = midline.gap_mm;
  result.gap_deg = midline.gap_deg;
}

/// Measures the tumour edge after the cut, and the inner edge of a ring, for a cut by points.
void measure_final_edges(const KerfInput& kerf, const PartedTissue& tissue, const ToolPath& path,
                         IncisionResult& result) {
  if (!has_edge(path)) return;
  result.final_tumor_edge =
      carried(path.tumor_edge, [&](const Vec3& p, double mm) { return tissue.place_after(p, mm); });
  if (!path.is_closed) return;
  result.kerf.inner_edge_reference = inner_edge_contour(kerf, kEdgeLayer);
  if (!result.kerf.inner_edge_reference) return;
  result.inner_edge = carried_with_live(*result.kerf.inner_edge_reference, 0.0, kerf.approach, kerf.surface,
                                        [&](const Vec3& p, double mm) { return tissue.displacement(p, mm); });
}

/// The same for a cut by whole tets.
void measure_final_edges(const TissueModel& model, const TissueState& stretched, const ToolPath& path,
                         const IncisionSettings& settings, double bridge_mm, IncisionResult& result) {
  if (!has_edge(path)) return;
  const TissueState& tissue = result.final_state.tissue;
  const TetLocator locator(model.mesh, stretched.positions);
  result.final_tumor_edge = carried(path.tumor_edge, [&](const Vec3& p, double tolerance_mm) -> std::optional<Vec3> {
    const auto point = locator.locate(p, tolerance_mm);
    if (!point) return std::nullopt;
    return position_of(*point, model.mesh, tissue.positions);
  });
  if (!path.is_closed) return;
  InnerEdgeSettings edge_settings;
  edge_settings.opening_mm = bridge_mm;
  result.inner_edge = inner_edge_contour(
      cut_surface(model.mesh, tissue, settings, inside_of(result.final_tumor_edge, path)), edge_settings);
  if (!result.inner_edge) return;
  result.kerf.inner_edge_reference =
      carried_with_live(*result.inner_edge, 0.0, settings.approach, skin_of(model.mesh, tissue.positions),
                        displacement_of_live(model.mesh, tissue.is_live, tissue.positions, stretched.positions));
}

}  // namespace

std::optional<ClosedRing> shallowest_closed_ring(const KerfMeasures& kerf, const Vec3& approach) {
  for (const KerfLayer& layer : kerf.layers) {
    if (!layer.centerline || !layer.is_closed.value_or(false)) continue;
    ClosedRing ring{layer.depth_mm, 0.5 * layer.width_mm, *layer.centerline};
    for (Vec3& p : ring.midline.points) p -= layer.depth_mm * approach;
    return ring;
  }
  return std::nullopt;
}

void require_measurable(const TissueModel& model, const TissueState& stretched, const ToolPath& path,
                        const IncisionSettings& settings) {
  if (!settings.tumor_surface.triangles.empty()) require_volume(settings.tumor_surface);
  if (!has_edge(path)) return;
  const TetLocator locator(model.mesh, stretched.positions);
  for (std::size_t i = 0; i < path.tumor_edge.points.size(); ++i)
    require_on_tissue(locator.locate(path.tumor_edge.points[i], kEdgeOnSkinMm).has_value(), i);
}

void measure_kerf(const TissueModel& model, const TissueState& stretched, const ToolPath& path,
                  const IncisionSettings& settings, IncisionResult& result, Workers& workers) {
  KerfMidlineSettings midline_settings;
  midline_settings.layer_bottom_mm = settings.midline_layer_mm;
  const CutState& state = result.final_state;
  const TissueState& tissue = state.tissue;
  std::optional<PointLattice> lattice;  // of a cut by points
  std::optional<PointKerf> by_points;
  std::optional<PartedTissue> parted;
  if (settings.cut.rule == CutRule::Lattice) {
    lattice = lattice_of(model, state.points);
    by_points.emplace(model, *lattice, state.points, stretched.positions);
    parted.emplace(model, *lattice, stretched.positions, state);
  }
  const KerfInput kerf = kerf_input(model, stretched, path, settings, state.record, by_points ? &*by_points : nullptr);
  KerfMeasures& measures = result.kerf;
  measures.layers.resize(settings.layer_depths_mm.size());
  // No task reads what another writes. The slow measures are separate tasks, to share them among threads.
  std::vector<std::function<void()>> tasks{
      [&] { measure_midline(kerf, midline_settings, result); },
      [&] {
        measures.body = kerf_body(split_mesh(model.mesh, state.splits),
                                  split_positions(stretched.positions, state.splits), tissue.is_live);
        if (!by_points) return;
        measures.body.surface = by_points->surface();
        measures.body.volume_mm3 = enclosed_volume_mm3(measures.body.surface);
        measures.body.boundary = manifoldness_of(measures.body.surface.triangles);
      },
      [&] { measures.depth = depth_reached(kerf, path, settings); },
      [&] {
        measures.drag = tissue_drag(model, lattice ? &*lattice : nullptr, stretched.positions, path, settings, state);
      },
      // Bridges too narrow to count for the mid-line do not hold the plug either.
      [&] {
        if (parted) return measure_final_edges(kerf, *parted, path, result);
        measure_final_edges(model, stretched, path, settings, midline_settings.closing_mm, result);
      }};
  for (std::size_t i = 0; i < measures.layers.size(); ++i) {
    tasks.emplace_back([&, i] { measures.layers[i] = kerf_layer(kerf, path, settings.layer_depths_mm[i]); });
  }
  workers.for_each(tasks.size(), 1, [&](std::size_t i) { tasks[i](); });
  measures.deep_margin = deep_margin(measures.body, measures.depth, settings);
  if (!result.centerline) return;
  const LiveDisplacement displacement =
      parted ? [&](const Vec3& p, double mm) { return parted->displacement(p, mm); }
             : displacement_of_live(model.mesh, tissue.is_live, stretched.positions, tissue.positions);
  measures.final_centerline = carried_with_live(*result.centerline, 0.5 * result.kerf_width_mm + kBeyondWallMm,
                                                settings.approach, kerf.surface, displacement);
}

}  // namespace incise
