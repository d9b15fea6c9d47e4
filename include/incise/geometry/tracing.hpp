#pragma once

#include <incise/geometry/contour.hpp>
#include <incise/geometry/raster.hpp>

#include <optional>
#include <vector>

namespace incise {

// Curves in the picture plane are contours in view coordinates with z = 0.

/// Returns the longest open path along the skeleton's largest part, through pixel centres, from the end with the lower
/// pixel offset; nullopt for fewer than 2 pixels. Exact for a skeleton without loops; in a loop, the path takes the
/// shorter way round.
[[nodiscard]] std::optional<Contour> longest_path(const Raster& skeleton);

/// Returns the closed lines where a picture passes `level` (marching squares with linear interpolation), in order of
/// their first point in the picture. Higher values lie to their left, so the outline of a blob runs counter-clockwise
/// and the outline of a hole clockwise. Values beyond the picture count as `outside`. @pre outside < level; all values
/// finite.
[[nodiscard]] std::vector<Contour> level_lines(const ScalarRaster& raster, double level, double outside = 0.0);

/// Returns the same lines if nothing is known beyond the picture. Lines that meet its border end there, are open and
/// come first. At a saddle, the two high corners stay apart. @pre all values finite.
[[nodiscard]] std::vector<Contour> level_lines_inside(const ScalarRaster& raster, double level);

/// Returns an evenly spaced curve after Gaussian smoothing along it, twice with opposite error (2G - G²): a circle of
/// radius R shrinks only by sigma⁴/(4R³) instead of sigma²/(2R). Both ends of an open curve stay in place. Works on
/// space curves too. A sigma_mm of 0 changes nothing.
[[nodiscard]] Contour smoothed(const Contour& curve, double sigma_mm);

}  // namespace incise
