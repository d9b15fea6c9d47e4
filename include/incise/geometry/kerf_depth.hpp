#pragma once

#include <incise/geometry/kerf_contours.hpp>

#include <vector>

namespace incise {

struct KerfDepthSettings {
  double needle_diameter_mm = 1.0;  ///< > 0: single tets that reach deeper do not make a cut deep
  double reach_mm =
      4.0;  ///< > half the needle's diameter: a kerf farther than this from the course is not seen from there
  double spacing_mm = 0.25;  ///< of the course's points, > 0
  double pixel_mm = 0.1;     ///< > 0, at most the needle's diameter
};

/// How deep a kerf goes at the points of a course.
struct DepthProfile {
  Contour course;                    ///< N x 3, mm, on the surface: the course, evenly spaced
  std::vector<double> arclength_mm;  ///< N: from the course's first point
  std::vector<double> depth_mm;      ///< N, >= 0: below the skin, along the approach; 0 where nothing is cut
};
inline void describe(Visitor& v, DepthProfile& p) {
  v("course", p.course, "On the surface, evenly spaced.");
  v("arclength_mm", p.arclength_mm, "From the course's first point.");
  v("depth_mm", p.depth_mm, "Of the kerf below the skin, along the approach; 0: nothing is cut there.");
}

/// The depth that a kerf reaches below the skin along a course over it. In each line of sight the depth is that of the
/// lowest removed point below the skin. At a point of the course the answer is the greatest mean of these over one
/// needle diameter, looked for straight across the course within reach: so a kerf that lies beside its path is found,
/// and one tooth of the mesh does not count as depth.
/// @param kerf    as for midline_contour; configuration: stretched, before the cut.
/// @param course  the tool's entry points, mm; at least 2.
/// @throws InvalidArgument for settings out of range, points that are not finite, a course of no length.
/// @note Counted along the approach: a tool held obliquely reaches less deep than its own depth. The kerf may undercut;
/// that is not separated from depth. As rough as the mesh: tets that are touched at a corner go whole. O(tets + points ·
/// reach / pixel).
[[nodiscard]] DepthProfile depth_along(const KerfInput& kerf, const Contour& course,
                                       const KerfDepthSettings& settings = {});

}  // namespace incise
