#pragma once

#include <incise/core/names.hpp>
#include <incise/geometry/picture.hpp>
#include <incise/geometry/types.hpp>

#include <array>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace incise {

/// Maps pixels to the plane that a picture shows, in mm, x to the right and y up. Straight lines stay straight.
struct PhotoScale {
  Mat3 T_plane_picture = Mat3::Identity();  ///< homography: (x, y, 1) ~ T (u, v, 1)
  [[nodiscard]] Vec2 plane_mm(const Vec2& pixel) const;
  /// Returns the side, mm, of a square with the area of one pixel at this place.
  [[nodiscard]] double mm_per_pixel(const Vec2& pixel) const;
};

/// Returns a uniform scale with its origin at the lower left pixel. @throws InvalidArgument unless both are above 0.
[[nodiscard]] PhotoScale scale_from_mm_per_pixel(double mm_per_pixel, int picture_height);

/// Returns the uniform scale given by the distance between two pixels. @throws InvalidArgument if they are less than 10
/// pixels apart or distance_mm is not above 0.
[[nodiscard]] PhotoScale scale_from_two_points(const Vec2& a, const Vec2& b, double distance_mm, int picture_height);

/// Returns the homography that corrects perspective, from the corners of a rectangle of known size; its lower left
/// corner becomes the origin.
/// @param corners  pixels: lower left, lower right, upper right, upper left.
/// @throws InvalidArgument if three corners are collinear, the order is crossed or reversed, or a side is not above 0.
[[nodiscard]] PhotoScale scale_from_rectangle(const std::array<Vec2, 4>& corners, double width_mm, double height_mm);

enum class RulerKind {
  Ticks,  ///< a comb of evenly spaced, parallel, dark, colourless lines on a light ground
  Bar,    ///< a solid straight bar, black or white
};
inline constexpr std::array<std::string_view, 2> kRulerKindNames{"ticks", "bar"};
[[nodiscard]] constexpr Names names_of(RulerKind) {
  return kRulerKindNames;
}
/// A value and its standard error.
struct RulerFigure {
  double value = 0.0;
  double error = 0.0;  ///< > 0
};
/// What a ruler's row of ticks shows about the camera. All figures are 0 if the camera looks straight down and its lens
/// is corrected. They are also 0 if a distant camera leans exactly along or across the ruler.
struct RulerShape {
  RulerFigure spacing_change;   ///< from the first to the last tick, relative to the spacing: perspective
  RulerFigure convergence_deg;  ///< angle between the first and the last tick: perspective
  RulerFigure skew_deg;         ///< angle of the ticks from the normal of their row: foreshortening
  RulerFigure end_stretch;      ///< spacing at both ends relative to the middle, minus 1: lens distortion
  RulerFigure bow;              ///< deviation of the row from a straight line, over its length: lens distortion
};

/// A ruler or scale bar found in a picture.
struct Ruler {
  double mm_per_pixel = 0.0;
  double error_percent = 0.0;  ///< standard error of the scale; of a bar: half the range of its measured lengths
  std::vector<Vec2> marks_px;  ///< middles of the ticks in order, or the two ends of the bar
  std::optional<RulerShape> shape;  ///< only for ticks
};

/// Finds a ruler or scale bar.
/// @param length_mm  distance between the finest ticks (absent: 1 mm), or length of the bar (required).
/// @param name       file name for messages.
/// @throws DataError if there is no ruler (fewer than 8 evenly spaced ticks; no solid bar). For ticks, also if ticks of
/// two spacings are in view (with spacings and places), if fainter or shorter marks lie between the ticks, or if
/// length_mm is absent and every second tick is longer, as on a scale of halves. For a bar, also if a second bar is at
/// least a quarter as long (with lengths and places), or if ticks are in view: the bar may be the ruler's body, or one
/// of its ticks.
/// @throws InvalidArgument for a bar without a length, or a length that is not above 0.
[[nodiscard]] Ruler find_ruler(const ColorPicture& picture, RulerKind kind, std::optional<double> length_mm,
                               const std::filesystem::path& name);

}  // namespace incise
