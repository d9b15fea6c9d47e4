#pragma once

#include <incise/geometry/contour.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace incise {

/// What a cut took away, in the configuration in which it is measured: stretched, before the cut.
struct KerfInput {
  std::vector<std::array<Vec3, 4>> removed_tets;  ///< corners, mm; either orientation
  TriMesh surface;                                ///< of the whole body before the cut, same configuration, mm
  Vec3 approach = -Vec3::UnitZ();                 ///< the direction in which the observer looks; need not be unit
  Vec3 inside_mm = Vec3::Zero();  ///< a point that a ring has to enclose (seen along `approach`): the path's centroid
  bool is_closed = true;          ///< true: a ring is looked for; false: an open cut with two ends
};

struct KerfMidlineSettings {
  double layer_top_mm = 0.0;     ///< the layer that counts, measured below the surface along the approach
  double layer_bottom_mm = 2.5;  ///< > top
  double pixel_mm = 0.1;
  double min_coverage = 0.25;   ///< share of the layer's thickness, (0, 1], that is gone where a pixel counts as cut
  double closing_mm = 0.45;     ///< radius: uncut bridges narrower than twice this are overlooked
  double max_island_mm2 = 2.0;  ///< uncut islands within the kerf up to this size are overlooked
  double smoothing_mm = 0.7;    ///< standard deviation along the mid-line; evens out the grain of the mesh
  double spacing_mm = 0.25;     ///< of the result's points
};

/// The middle of a kerf, or how far it is from a closed ring.
struct KerfMidline {
  std::optional<Contour> contour;  ///< on the surface, mm, counter-clockwise against the approach, evenly spaced;
                                   ///< absent: no closed ring round `inside_mm` (or no kerf at all)
  bool is_closed = false;          ///< whether `contour` is a closed ring
  double gap_deg = 0.0;  ///< ring wanted but open: the largest angle at `inside_mm` without kerf; 360 without any
  double gap_mm = 0.0;   ///< ring wanted but open: width of the widest uncut bridge to the outside; also found where
                         ///< the ends overlap side by side and `gap_deg` is 0
  std::optional<Vec3> gap_place_mm;  ///< where that bridge is narrowest, on the surface, mm; absent: not known
  double mean_width_mm = 0.0;  ///< of the kerf across `contour`, averaged over the layer
  double area_mm2 = 0.0;       ///< of the kerf seen along the approach
};

/// The kerf's mid-line: the points as far from the tissue inside as from that outside, moved to the middle of what was
/// removed across the kerf and smoothed lightly; for an open cut the longest mid-line path, carried on to the kerf's
/// two ends. Every removed tet is cut to the layer and seen along the approach exactly; no disks stand for tets.
/// @throws InvalidArgument for settings out of range or points that are not finite.
/// @note On tets of 0.8 mm that come within 0.75 mm of a circle of radius 15 mm: 0.04 mm off on average, bias below
/// 0.01 mm. O(tets + pixels). Source: [Paper, III-A.1] for the use of a mid-line; departs from it: rings are not found
/// by thinning a picture.
[[nodiscard]] KerfMidline midline_contour(const KerfInput& input, const KerfMidlineSettings& settings = {});

/// The cut tissue as a camera sees it: tool out, still stretched.
struct CutSurface {
  Points vertices;                    ///< mm, in that configuration
  std::vector<Triangle> triangles;    ///< the boundary of what is left
  std::vector<std::uint8_t> is_skin;  ///< one per triangle: 1 = part of the original skin, 0 = wall of the kerf
  Vec3 approach = -Vec3::UnitZ();     ///< the direction in which the camera looks
  Vec3 inside_mm = Vec3::Zero();      ///< a point of the plug (seen along `approach`): the tumour's centroid
};

struct InnerEdgeSettings {
  double pixel_mm = 0.1;
  double opening_mm = 0.15;   ///< radius: strips of skin narrower than twice this do not hold the plug to the outside
  double closing_mm = 0.15;   ///< radius: the same for specks and slits in the skin
  double smoothing_mm = 0.3;  ///< standard deviation of the blur under which the edge is read
  double spacing_mm = 0.25;   ///< of the result's points
};

/// The edge of the plug, the skin inside the ring, as photographs show it: closed, on the skin, mm, counter-clockwise
/// against the approach, evenly spaced. nullopt when the plug still hangs together with the skin outside, when there is
/// no kerf, or when `inside_mm` is not on skin: then there is no such edge.
/// @throws InvalidArgument for settings out of range, points that are not finite or flags that do not match.
[[nodiscard]] std::optional<Contour> inner_edge_contour(const CutSurface& surface,
                                                        const InnerEdgeSettings& settings = {});
/// The same edge in the tissue before the cut, from the kerf: the border of what it leaves inside. Where the plug's
/// tissue lies after the cut, only the tissue knows. @param layer  in which the kerf is looked at.
/// @returns nullopt where the kerf is no closed ring round `inside_mm`, or there is none. @throws InvalidArgument for
/// settings out of range or points that are not finite.
[[nodiscard]] std::optional<Contour> inner_edge_contour(const KerfInput& kerf, const KerfMidlineSettings& layer,
                                                        const InnerEdgeSettings& settings = {});

}  // namespace incise
