#pragma once

#include <incise/geometry/contour.hpp>
#include <incise/geometry/kerf_depth.hpp>
#include <incise/geometry/manifoldness.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <optional>
#include <vector>

namespace incise {

/// Mean and range of a list of numbers, in the numbers' unit.
struct Spread {
  double mean = 0.0;
  double min = 0.0;
  double max = 0.0;
};
inline void describe(Visitor& v, Spread& s) {
  v("mean", s.mean, "Mean value.");
  v("min", s.min, "Least value.");
  v("max", s.max, "Greatest value.");
}

/// The kerf in a layer: 1 mm of tissue at a given depth below the skin.
struct KerfLayer {
  double depth_mm = 0.0;              ///< of the layer's middle, along the approach
  bool is_within_plan = false;        ///< whether the greatest planned depth reaches the layer's middle; if not, the
                                      ///< layer is not measured
  std::optional<bool> is_closed;      ///< whether a ring closed there; absent for an open cut, or outside the plan
  std::optional<double> gap_mm;       ///< of a ring that stayed open there: width of the widest uncut bridge
  std::optional<Vec3> gap_place_mm;   ///< where that bridge is narrowest, stretched tissue before the cut, mm
  double width_mm = 0.0;              ///< mean width of the kerf there; 0 without a mid-line
  std::optional<Contour> centerline;  ///< mid-line at that depth, stretched tissue before the cut, mm
};
inline void describe(Visitor& v, KerfLayer& l) {
  v("depth_mm", l.depth_mm, "Depth of the layer's middle, along the approach.");
  v("within_plan", l.is_within_plan, "Whether the planned depth reaches the layer's middle.");
  v("closed_loop", l.is_closed, "Whether a ring closed in the layer.");
  v("gap_mm", l.gap_mm, "Width of the widest uncut bridge in a ring that stayed open in the layer.");
  v("gap_place_mm", l.gap_place_mm, "Where that bridge is narrowest, stretched tissue before the cut.");
  v("kerf_width_mm", l.width_mm, "Mean width of the kerf in the layer.");
  v.bulk("centerline", l.centerline, "The mid-line in the layer, stretched tissue before the cut.");
}

/// The kerf as a body, in the stretched tissue before the cut: all removed tets or, of a cut by points, the tissue
/// whose dose has reached 1.
struct KerfBody {
  TriMesh surface;          ///< boundary, oriented outwards, mm; sheets may touch
  double volume_mm3 = 0.0;  ///< enclosed by `surface`
  Manifoldness boundary;    ///< of `surface`
  Manifoldness live_skin;   ///< of the skin of the live tets
};
inline void describe(Visitor& v, KerfBody& b) {
  v.begin({"kerf", "Boundary of the removed tets."});
  describe(v, b.boundary);
  v({"volume_mm3", "Volume that the surface encloses.", "mm3"}, b.volume_mm3);
  v.bulk("surface", b.surface, "The boundary, oriented outwards.");
  v.end();
  v("live_skin", b.live_skin,
    "Triangles, open edges and places where sheets touch, of the skin of the remaining tissue.");
}

/// Depth of the kerf along the tool's path.
struct DepthReached {
  double planned_mm = 0.0;  ///< mean depth of the tool's tip below its entry points, along the approach
  DepthProfile profile;     ///< see depth_along; N points
  std::vector<double>
      planned_at_mm;  ///< N: planned depth of the tip there, along the approach; linear between waypoints
  Spread depth_mm;    ///< of the profile
};
inline void describe(Visitor& v, DepthReached& d) {
  describe(v, d.depth_mm);
  v({"planned", "Mean depth of the tool's tip below its entry points.", "mm"}, d.planned_mm);
  v.bulk("profile", d.profile, "Depth along the path.");
  v.bulk("planned_at_mm", d.planned_at_mm, "Planned depth at each place of the profile.");
}

/// Displacement of tissue, when it is cut, from its place in the stretched, uncut body: along the tool's direction of
/// travel (lag) and across it (drift). One entry per step in which tets or points were cut: their mean, weighted by
/// rest volume. Loose fragments do not count.
struct TissueDrag {
  std::vector<double> time_s;        ///< ascending
  std::vector<double> arclength_mm;  ///< travel of the tip along the path; on a ring it continues into the overlap
  std::vector<double> lag_mm;  ///< positive: dragged ahead; the cut tissue belongs farther back along the path
  std::vector<double>
      drift_mm;  ///< positive: pushed outwards on a ring, to the left (seen along the approach) of an open cut
  Spread lag;    ///< of lag_mm; mean weighted by rest volume
  Spread drift;  ///< of drift_mm; mean weighted by rest volume
};
inline void describe(Visitor& v, TissueDrag& d) {
  v("time_s", d.time_s, "Times of the entries, ascending.");
  v("arclength_mm", d.arclength_mm, "Travel of the tip since the plunge.");
  v("lag_mm", d.lag_mm, "Along the course; positive: dragged ahead.");
  v("drift_mm", d.drift_mm, "Across the course; positive: outwards on a ring.");
  v("lag", d.lag, "Mean, least and greatest lag_mm; the mean is weighted by rest volume.");
  v("drift", d.drift, "Mean, least and greatest drift_mm; the mean is weighted by rest volume.");
}

/// Distance from the kerf to the tumour's surface, in the stretched tissue before the cut. A place of the kerf is
/// beneath the tumour if, from the nearest point of the tumour, it lies farther along the approach than across it;
/// otherwise it is beside the tumour.
struct DeepMargin {
  double nearest_mm = 0.0;           ///< least distance in any direction; negative: depth of the kerf in the tumour
  std::optional<double> beside_mm;   ///< least distance to the kerf beside the tumour; absent: none lies beside it
  std::optional<double> beneath_mm;  ///< least distance to the kerf beneath the tumour; absent: none lies beneath it
  Spread floor_below_mm;  ///< along the path: how much deeper the kerf's bottom lies than the tumour's deepest point
};
inline void describe(Visitor& v, DeepMargin& m) {
  v({"nearest", "Least distance between kerf and tumour; negative: the kerf enters the tumour.", "mm"}, m.nearest_mm);
  v({"beside", "Least distance between the tumour and the kerf beside it.", "mm"}, m.beside_mm);
  v({"beneath", "Least distance between the tumour and the kerf beneath it.", "mm"}, m.beneath_mm);
  v({"floor_below", "How much deeper the bottom of the kerf lies than the tumour.", "mm"}, m.floor_below_mm);
}

/// Measures of a cut, apart from its mid-line and inner edge.
struct KerfMeasures {
  KerfBody body;
  std::vector<KerfLayer> layers;  ///< at IncisionSettings::layer_depths_mm
  DepthReached depth;
  std::optional<TissueDrag> drag;           ///< absent: nothing was cut, or the tip never moved along the path
  std::optional<DeepMargin> deep_margin;    ///< absent: nothing was cut, or the tumour's surface is not known
  std::optional<Contour> final_centerline;  ///< the mid-line, moved with the tissue on both sides of it, tool out, mm;
                                            ///< absent: no mid-line, or a place of it with no tissue in reach on one
                                            ///< side
  std::optional<Contour>
      inner_edge_reference;  ///< the inner edge's material points in the stretched tissue before the cut, mm
};
inline void describe(Visitor& v, KerfMeasures& k) {
  describe(v, k.body);
  v.bulk("layers", k.layers, "The kerf in the layers that were asked for.");
  v({"depth_reached_mm", "Depth reached along the path.", "mm"}, k.depth);
  v.bulk("drag", k.drag, "Lag and drift of the tissue when it was cut.");
  v.derived("lag_mm", k.drag ? std::optional(k.drag->lag) : std::nullopt, "How far tissue was dragged ahead.");
  v.derived("drift_mm", k.drag ? std::optional(k.drag->drift) : std::nullopt, "How far tissue was pushed outwards.");
  v({"deep_margin_mm", "Distance from the kerf to the tumour's surface.", "mm"}, k.deep_margin);
  v.bulk("final_centerline", k.final_centerline, "The mid-line, tool out.");
  v.bulk("inner_edge_reference", k.inner_edge_reference,
         "The inner edge's points in the stretched tissue before the cut.");
}

/// The mid-line of a ring that closed.
struct ClosedRing {
  double depth_mm = 0.0;       ///< of the layer's middle
  double half_width_mm = 0.0;  ///< of the kerf there
  Contour midline;             ///< stretched tissue before the cut, moved back along the approach onto the skin, mm
};
inline void describe(Visitor& v, ClosedRing& r) {
  v("depth_mm", r.depth_mm, "Depth of the layer's middle below the skin.");
  v("half_width_mm", r.half_width_mm, "Half the width of the kerf in the layer.");
  v("midline", r.midline,
    "The mid-line in the stretched tissue before the cut, lifted along the approach to the skin's height.");
}

/// Returns the ring of the shallowest layer in which it closed; nullopt: it closed in none.
/// @param approach  unit; the direction in which the observer looks.
[[nodiscard]] std::optional<ClosedRing> shallowest_closed_ring(const KerfMeasures& kerf, const Vec3& approach);

}  // namespace incise
