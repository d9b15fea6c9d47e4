#pragma once

#include <incise/geometry/contour.hpp>

#include <string>

namespace incise {

/// What is known of a photograph before it is matched: its axes, but for a small turn. Its position is not known.
struct PictureMatchSettings {
  double turn_sd_deg = 10.0;    ///< standard deviation of that turn, > 0; the rounder the edge, the more this counts
  double most_turn_deg = 40.0;  ///< greatest turn that counts as small, (0, 180)
  double edge_sd_mm = 0.3;      ///< standard deviation of the distance between the two edges for other reasons, > 0
  double doubtful_turn_deg = 10.0;  ///< photographs of the same specimen are turned by less, > 0
};

/// Rigid motion in the picture plane that maps the photographed tumour edge onto the simulated one.
struct PictureMatch {
  double turn_deg = 0.0;         ///< of the photograph, counter-clockwise seen along the approach
  Vec2 shift_mm = Vec2::Zero();  ///< after the turn about the photographed edge's middle, in the simulation's view
  double rms_mm = 0.0;           ///< root mean square of the remaining distances between the edges
  bool is_doubtful = false;      ///< it fits worse, or is turned farther, than photographs of the same specimen
  std::string objection;         ///< why the photograph cannot show this specimen in this orientation; empty: it can
};

/// Fits a photographed tumour edge to the simulated one: least squares of the distances between the curves, with a
/// prior that turns are small. The centroids of the two curves coincide. If the edges lie more than edge_sd_mm apart,
/// the picture is also tried mirrored and at every turn; if one of these fits at least twice as well, the match has an
/// objection, because the errors of such a picture mean nothing.
/// A match beyond edge_sd_mm or doubtful_turn_deg is doubtful: photographs of the bench's specimens lie 0.12 to 0.18 mm
/// off their own simulation, at turns below 2 degrees, and 0.41 to 0.67 mm off another specimen's.
/// @param photographed  closed, mm, seen along `photo_approach`.  @param simulated  closed, mm, seen along `approach`.
/// @throws InvalidArgument for contours that are open or have fewer than 3 points, or settings out of range.
/// @note Takes about 0.01 s.
[[nodiscard]] PictureMatch match_picture(const Contour& photographed, const Vec3& photo_approach,
                                         const Contour& simulated, const Vec3& approach,
                                         const PictureMatchSettings& settings = {});

}  // namespace incise
