#pragma once

#include <incise/geometry/contour.hpp>

#include <string>

namespace incise {

/// How a photograph lies against the simulation. Its axes are known but for a small turn; where it lies is not.
struct PictureMatchSettings {
  double turn_sd_deg = 10.0;    ///< standard deviation of that turn, > 0; a rounder edge tells less, and this the more
  double most_turn_deg = 40.0;  ///< a turn beyond this is no small one; (0, 180)
  double edge_sd_mm = 0.3;      ///< by which the two edges differ at a place for other reasons, > 0
  double doubtful_turn_deg = 10.0;  ///< a photograph of the same specimen is turned by less, > 0
};

/// The rigid motion in the picture plane that lays the photographed tumour edge onto the simulated one.
struct PictureMatch {
  double turn_deg = 0.0;         ///< of the photograph, counter-clockwise against the approach
  Vec2 shift_mm = Vec2::Zero();  ///< after the turn about the photographed edge's middle, in the simulation's view
  double rms_mm = 0.0;           ///< of the distances between the edges that is left
  bool is_doubtful = false;      ///< it fits worse, or turned farther, than photographs of the same specimen do
  std::string objection;         ///< why the photograph cannot be of this specimen as it lies; empty: it may be
};

/// Lays a photographed tumour edge onto the simulated one: least squares of the distances between the curves, with the
/// prior that turns are small. Middles lie on one another. A picture that fits twice as well mirrored, or turned far,
/// is objected to, where it fits badly (beyond edge_sd_mm) as it is: no error of a mirrored picture means anything.
/// Photographs of the bench's specimens lie 0.12 to 0.18 mm off their own simulation, at turns below 2 degrees, and 0.41
/// to 0.67 mm off another specimen's: what exceeds edge_sd_mm or doubtful_turn_deg is doubtful.
/// @param photographed  closed, mm, seen along `photo_approach`.  @param simulated  closed, mm, seen along `approach`.
/// @throws InvalidArgument for contours of fewer than 3 points, or settings out of range.
/// @note 0.01 s.
[[nodiscard]] PictureMatch match_picture(const Contour& photographed, const Vec3& photo_approach,
                                         const Contour& simulated, const Vec3& approach,
                                         const PictureMatchSettings& settings = {});

}  // namespace incise
