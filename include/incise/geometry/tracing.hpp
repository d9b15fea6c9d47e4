#pragma once

#include <incise/geometry/contour.hpp>
#include <incise/geometry/raster.hpp>

#include <optional>
#include <vector>

namespace incise {

// Curves in the picture plane are contours in view coordinates with z = 0.

/// The longest open path along the skeleton's largest part, through pixel centres, from the end with the lower pixel
/// offset; nullopt for fewer than 2 pixels. Exact for a skeleton without loops; shortest way round where there is one.
[[nodiscard]] std::optional<Contour> longest_path(const Raster& skeleton);

/// The closed lines where a picture passes `level` (marching squares with linear interpolation); higher values lie to
/// their left, so the outline of a blob runs counter-clockwise and that of a hole clockwise. In order of their first
/// point in the picture. Values beyond the picture count as `outside`. @pre outside < level; all values finite.
[[nodiscard]] std::vector<Contour> level_lines(const ScalarRaster& raster, double level, double outside = 0.0);

/// The same where nothing is known beyond the picture: lines that meet its border end there, are open and come first;
/// at a saddle the two high corners stay apart. @pre all values finite.
[[nodiscard]] std::vector<Contour> level_lines_inside(const ScalarRaster& raster, double level);

/// Gaussian smoothing along an evenly spaced curve, twice with opposite error (2G - G²), so that a circle of radius R
/// shrinks by sigma⁴/(4R³) only instead of sigma²/(2R). Both ends of an open curve stay. sigma = 0: unchanged. Works on
/// space curves too.
[[nodiscard]] Contour smoothed(const Contour& curve, double sigma_mm);

}  // namespace incise
