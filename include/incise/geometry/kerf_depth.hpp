#pragma once

#include <incise/geometry/kerf_contours.hpp>

#include <vector>

namespace incise {

struct KerfDepthSettings {
  double needle_diameter_mm = 1.0;  ///< > 0; depth is averaged over it, so a single deep tet does not count
  double reach_mm =
      4.0;  ///< > half the needle's diameter; a kerf farther than this from the course is not found
  double spacing_mm = 0.25;  ///< of the course's points, > 0
  double pixel_mm = 0.1;     ///< > 0, at most the needle's diameter
};

/// The depth of a kerf at the points of a course.
struct DepthProfile {
  Contour course;                    ///< N x 3, mm, on the surface: the course, evenly spaced
  std::vector<double> arclength_mm;  ///< N: from the course's first point
  std::vector<double> depth_mm;      ///< N, >= 0: below the skin, along the approach; 0 where nothing is cut
};
inline void describe(Visitor& v, DepthProfile& p) {
  v("course", p.course, "Points of the course on the surface, evenly spaced.");
  v("arclength_mm", p.arclength_mm, "Arc length from the course's first point.");
  v("depth_mm", p.depth_mm, "Depth of the kerf below the skin, along the approach; 0: nothing is cut there.");
}

/// Computes the depth that a kerf reaches below the skin along a course over it. Each line of sight gives the depth of
/// its lowest removed point below the skin. At a point of the course, the result is the greatest mean of these depths
/// over one needle diameter, searched straight across the course within `reach_mm`. So a kerf beside its path is found,
/// and one tooth of the mesh does not count as depth.
/// @param kerf    as for midline_contour; configuration: stretched, before the cut.
/// @param course  the tool's entry points, mm; at least 2.
/// @throws InvalidArgument for settings out of range, points that are not finite, a course without length.
/// @note Depth is measured along the approach, so an oblique tool reaches less deep than the depth along its axis. An
/// undercut counts as depth. The result is as rough as the mesh, because tets that are touched at a corner are removed
/// whole. O(tets + points · reach / pixel).
[[nodiscard]] DepthProfile depth_along(const KerfInput& kerf, const Contour& course,
                                       const KerfDepthSettings& settings = {});

}  // namespace incise
