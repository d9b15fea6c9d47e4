#pragma once

#include <incise/core/names.hpp>
#include <incise/geometry/contour.hpp>
#include <incise/imaging/marked_line.hpp>
#include <incise/imaging/photo_scale.hpp>

#include <optional>
#include <string>

namespace incise {

/// What the red line in a photograph is.
enum class RedLine {
  Annotation,  ///< a thin line whose centre line is the kerf's inner edge
  Kerf,        ///< a painted band whose inner border is the inner edge
};
inline constexpr std::array<std::string_view, 2> kRedLineNames{"annotation", "kerf"};
[[nodiscard]] constexpr Names names_of(RedLine) {
  return kRedLineNames;
}

struct PhotoSettings {
  RedLine red = RedLine::Annotation;
  double max_gap_mm = 1.0;  ///< a ring with a longer gap is open, >= 0
};

/// A piece of ink that belongs to no line.
struct PhotoMark {
  Vec2 at_px = Vec2::Zero();  ///< its middle
  double longest_mm = 0.0;    ///< longer side of the box round it
};

/// A stretch of a line that looks unlike the rest of it.
struct OddStretch {
  Vec2 at_px = Vec2::Zero();  ///< where it is oddest
  double length_mm = 0.0;     ///< along the line
  std::string what;           ///< which feature is off, and by how much
};

/// The curves of one top-view photograph, mm in the picture's plane (x to the right, y up, z = 0): seen along -z.
struct PhotoContours {
  Contour tumor_edge;  ///< closed, counter-clockwise, from its topmost point on
  Contour incision;    ///< as tumor_edge where it is closed; open: from behind the widest gap to before it
  MarkedLine green;    ///< the same in pixels, with gaps and width
  MarkedLine red;
  double mm_per_pixel = 0.0;  ///< at the tumour
  /// Red inside the tumour's edge that is not the red line, largest first: blood, or a cut that went astray. From 8
  /// pixels of a third of the line's strength and 8 times the tissue's own spread.
  std::vector<PhotoMark> red_in_tumor;
  /// Green that is not the green line, largest first, from 24 truly green pixels to less than kSmallestTumorMm.
  std::vector<PhotoMark> green_beside;
  /// Of a closed red ring: a stretch longer than the largest gap in width, colour or lightness unlike the rest. Blood
  /// as thin as the line may close an opening there.
  std::optional<OddStretch> odd_stretch;
};

/// Measures red and green lines of a photograph; see find_marked_line. Where one line crosses the other, the hidden
/// part of the lower one is bridged (up to 8 mm). An open red ring is a result; an open green one is not.
/// @throws DataError: no red, no green, two tumours, a line that crosses itself or has a loop (with its place), green
/// of kSmallestTumorMm or more beside the green ring or red of 3 mm or more inside it, a tumour edge that is open (with
/// the width of the opening), or less than kSmallestTumorMm or more than kLargestTumorMm across ("is the scale
/// right?").
[[nodiscard]] PhotoContours find_photo_contours(const ColorPicture& picture, const PhotoScale& scale,
                                                const PhotoSettings& settings, const std::filesystem::path& name);

/// One drawn line of an overlay.
struct OverlayLine {
  std::vector<Vec2> points_px;
  bool is_closed = false;
  std::array<std::uint8_t, 3> rgb{255, 255, 255};
};
/// The picture with lines drawn over it, anti-aliased; darkened a little, so that they stand out.
[[nodiscard]] ColorPicture draw_over(const ColorPicture& picture, const std::vector<OverlayLine>& lines);

/// What was found, drawn over the photograph: tumour edge cyan, incision white, gaps yellow, ruler marks magenta.
[[nodiscard]] ColorPicture draw_found(const ColorPicture& picture, const std::vector<const MarkedLine*>& lines,
                                      const std::vector<Vec2>& ruler_marks_px = {});

}  // namespace incise
