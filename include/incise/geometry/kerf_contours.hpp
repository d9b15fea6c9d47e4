#pragma once

#include <incise/geometry/contour.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace incise {

/// The tissue that a cut removed, in the stretched reference (before the cut), where it is measured.
struct KerfInput {
  std::vector<std::array<Vec3, 4>> removed_tets;  ///< corners, mm; either orientation
  TriMesh surface;                                ///< of the whole body before the cut, same configuration, mm
  Vec3 approach = -Vec3::UnitZ();                 ///< the direction in which the observer looks; need not be unit
  Vec3 inside_mm = Vec3::Zero();  ///< a point that a ring must enclose (seen along `approach`): the path's centroid
  bool is_closed = true;          ///< true: find a ring; false: an open cut with two ends
};

struct KerfMidlineSettings {
  double layer_top_mm = 0.0;     ///< top of the measured layer, below the surface along the approach
  double layer_bottom_mm = 2.5;  ///< bottom of that layer, > top
  double pixel_mm = 0.1;
  double min_coverage = 0.25;   ///< a pixel is cut if this share of the layer's thickness, (0, 1], is removed
  double closing_mm = 0.45;     ///< radius; uncut bridges narrower than twice this are ignored
  double max_island_mm2 = 2.0;  ///< uncut islands within the kerf up to this size are ignored
  double smoothing_mm = 0.7;    ///< standard deviation along the mid-line; evens out the grain of the mesh
  double spacing_mm = 0.25;     ///< of the result's points
};

/// The mid-line of a kerf, or how far the kerf is from a closed ring.
struct KerfMidline {
  std::optional<Contour> contour;  ///< on the surface, mm, evenly spaced; a ring runs counter-clockwise seen along
                                   ///< the approach; absent: no closed ring round `inside_mm` (or no kerf at all)
  bool is_closed = false;          ///< whether `contour` is a closed ring
  double gap_deg = 0.0;  ///< of an open ring: largest angle, seen from `inside_mm`, without kerf; 360 without any kerf
  double gap_mm = 0.0;   ///< of an open ring: width of the widest uncut bridge to the outside, even where the ends
                         ///< overlap side by side and `gap_deg` is 0; infinite if `inside_mm` is far from the kerf
  std::optional<Vec3> gap_place_mm;  ///< where that bridge is narrowest, on the surface, mm; absent: not known
  double mean_width_mm = 0.0;  ///< of the kerf across `contour`, averaged over the layer
  double area_mm2 = 0.0;       ///< of the kerf seen along the approach
};

/// Computes the mid-line of a kerf. For a ring, it is the line equally far from the tissue inside and the tissue
/// outside, moved to the middle of the removed tissue across the kerf and smoothed lightly. For an open cut, it is the
/// longest path through the kerf's skeleton, centred and smoothed likewise and extended to both ends of the kerf. Every
/// removed tet is clipped to the layer and projected along the approach exactly; disks do not replace tets.
/// @throws InvalidArgument for settings out of range or points that are not finite.
/// @note For tets of 0.8 mm that come within 0.75 mm of a circle of radius 15 mm, the mean error is 0.04 mm and the
/// bias below 0.01 mm. O(tets + pixels). Source: [Paper, III-A.1] for the use of a mid-line; departs from it: rings are
/// not found by thinning a picture.
[[nodiscard]] KerfMidline midline_contour(const KerfInput& input, const KerfMidlineSettings& settings = {});

/// The cut tissue in the final configuration (tool out, still stretched), as a camera sees it.
struct CutSurface {
  Points vertices;                    ///< mm, in the final configuration
  std::vector<Triangle> triangles;    ///< the boundary of the remaining tissue
  std::vector<std::uint8_t> is_skin;  ///< one per triangle: 1 = part of the original skin, 0 = wall of the kerf
  Vec3 approach = -Vec3::UnitZ();     ///< the direction in which the camera looks
  Vec3 inside_mm = Vec3::Zero();      ///< a point of the plug (seen along `approach`): the tumour's centroid
};

struct InnerEdgeSettings {
  double pixel_mm = 0.1;
  double opening_mm = 0.15;   ///< radius; strips of skin narrower than twice this do not join the plug to the outside
  double closing_mm = 0.15;   ///< radius; specks and slits in the skin narrower than twice this are ignored
  double smoothing_mm = 0.3;  ///< standard deviation of the blur before the edge is traced
  double spacing_mm = 0.25;   ///< of the result's points
};

/// Returns the inner edge of a ring as photographs show it: the edge of the plug's skin, closed, on the skin, mm,
/// counter-clockwise seen along the approach, evenly spaced. There is no such edge (nullopt) if the plug is still
/// connected to the skin outside, if there is no kerf, or if `inside_mm` is not on skin.
/// @throws InvalidArgument for settings out of range, points that are not finite or flags that do not match.
[[nodiscard]] std::optional<Contour> inner_edge_contour(const CutSurface& surface,
                                                        const InnerEdgeSettings& settings = {});
/// Returns the inner edge in the stretched reference, computed from the kerf: the border of the tissue that the kerf
/// encloses. To find this edge after the cut, move its points with the tissue. nullopt if there is no kerf or it is no
/// closed ring round `inside_mm`.
/// @param layer  layer of tissue in which the kerf is measured.
/// @throws InvalidArgument for settings out of range or points that are not finite.
[[nodiscard]] std::optional<Contour> inner_edge_contour(const KerfInput& kerf, const KerfMidlineSettings& layer,
                                                        const InnerEdgeSettings& settings = {});

}  // namespace incise
