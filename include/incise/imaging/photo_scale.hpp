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

/// From a picture to the plane that it shows, in mm, x to the right and y up. Straight lines stay straight.
struct PhotoScale {
  Mat3 T_plane_picture = Mat3::Identity();  ///< homography: (x, y, 1) ~ T (u, v, 1)
  [[nodiscard]] Vec2 plane_mm(const Vec2& pixel) const;
  /// Side of a square as large as one pixel at this place.
  [[nodiscard]] double mm_per_pixel(const Vec2& pixel) const;
};

/// One scale everywhere; the origin is the picture's lower left pixel. @throws InvalidArgument unless both are above 0.
[[nodiscard]] PhotoScale scale_from_mm_per_pixel(double mm_per_pixel, int picture_height);

/// From two pixels whose distance is known. @throws InvalidArgument for points less than 10 pixels apart.
[[nodiscard]] PhotoScale scale_from_two_points(const Vec2& a, const Vec2& b, double distance_mm, int picture_height);

/// Perspective correction: four pixels that are the corners of a rectangle of known size, in order round it, starting
/// at the corner that becomes the lower left: lower left, lower right, upper right, upper left.
/// @throws InvalidArgument where three of them lie on a line, they are crossed, or run the other way round.
[[nodiscard]] PhotoScale scale_from_rectangle(const std::array<Vec2, 4>& corners, double width_mm, double height_mm);

enum class RulerKind {
  Ticks,  ///< a comb of parallel dark lines on something light and colourless, evenly spaced
  Bar,    ///< a solid straight bar without colour
};
inline constexpr std::array<std::string_view, 2> kRulerKindNames{"ticks", "bar"};
[[nodiscard]] constexpr Names names_of(RulerKind) {
  return kRulerKindNames;
}
/// A figure and its standard error.
struct RulerFigure {
  double value = 0.0;
  double error = 0.0;  ///< > 0
};
/// What a ruler's row of ticks tells of the camera. All are 0 where the camera looks straight down through a corrected
/// lens; a camera that looks along or across the ruler from far away leaves them at 0, too.
struct RulerShape {
  RulerFigure spacing_change;   ///< between the first and the last tick, share of the spacing: perspective
  RulerFigure convergence_deg;  ///< angle between the first and the last tick: perspective
  RulerFigure skew_deg;         ///< of the ticks from the normal of their row: foreshortening
  RulerFigure end_stretch;      ///< of the spacing at both ends over the middle's, share: lens
  RulerFigure bow;              ///< of the row from a straight line, share of its length: lens
};

/// A ruler or scale bar found in a picture.
struct Ruler {
  double mm_per_pixel = 0.0;
  double error_percent = 0.0;  ///< standard error of the scale
  std::vector<Vec2> marks_px;  ///< the ticks' middles in order, or the bar's two ends
  std::optional<RulerShape> shape;  ///< of ticks
};

/// Finds a ruler. @param length_mm  from tick to tick (of the finest ticks), or of the whole bar; without it ticks
/// stand for millimetres.
/// @throws DataError where none is found (fewer than 8 evenly spaced ticks; no solid bar), naming what was seen; where
/// a second bar is at least a quarter as long as the longest, with lengths and places; where ticks of two spacings are
/// in view, on one ruler or on two, with spacings and places; where fainter or shorter marks lie between the ticks that
/// were found; where no length is given and every second tick is longer, as on a scale of halves; for a bar, where
/// ticks are in view: the bar may be the ruler's body, or a tick.
/// @throws InvalidArgument for a bar without its length, or a length that is not above 0.
[[nodiscard]] Ruler find_ruler(const ColorPicture& picture, RulerKind kind, std::optional<double> length_mm,
                               const std::filesystem::path& name);

}  // namespace incise
