#pragma once

#include <incise/geometry/contour.hpp>
#include <incise/geometry/picture.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace incise::testing {

using Rgb = std::array<double, 3>;  ///< sRGB, [0, 255]

/// A line painted on the tissue, in mm of the picture's plane (x right, y up, origin at the lower left pixel).
struct PaintedLine {
  Contour course;  ///< where it runs; z is not looked at
  double width_mm = 0.15;
  Rgb color{30, 160, 60};
  /// A band that lies outside of a closed course, whose inner border is the course itself; else the course is its
  /// middle.
  bool is_outside = false;
  /// Stretches left out: start and length along the course, mm. Ends are cut square.
  std::vector<std::pair<double, double>> gaps_mm;
};

/// A photograph to be drawn.
struct PaintedPhoto {
  int width = 1200;
  int height = 1200;
  double mm_per_pixel = 0.03;
  Rgb tissue{186, 112, 100};
  /// Where the tissue ends: outside lies a sheet of paper, as wide as the picture. Absent: tissue everywhere.
  std::optional<Contour> specimen;
  Rgb sheet{246, 246, 242};
  double mottle = 0.10;            ///< share by which the tissue's colour wanders
  double shading = 0.35;           ///< share of the light lost towards one corner
  double blur_px = 0.9;            ///< standard deviation of the lens
  double noise = 4.0;              ///< standard deviation, grey levels
  int glare_spots = 12;            ///< wet highlights, of 4 to 12 pixels radius
  std::vector<PaintedLine> lines;  ///< later ones over earlier ones
  std::uint64_t seed = 1;
};

/// Draws the photograph: tissue, lines (square pixels, in linear light), shading, highlights, lens, noise. The same
/// seed gives the same picture. About 0.1 s for a million pixels.
/// @pre as encode_png; a course of at least 2 points, closed where it is_outside and for a specimen.
[[nodiscard]] ColorPicture paint_photo(const PaintedPhoto& photo);

}  // namespace incise::testing
