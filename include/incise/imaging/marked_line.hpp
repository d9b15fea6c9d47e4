#pragma once

#include <incise/core/names.hpp>
#include <incise/geometry/picture.hpp>
#include <incise/geometry/types.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

enum class InkColor { Red, Green };
inline constexpr std::array<std::string_view, 2> kInkColorNames{"red", "green"};
[[nodiscard]] constexpr Names names_of(InkColor) {
  return kInkColorNames;
}

/// Which part of a painted line is its contour.
enum class LineEdge {
  Middle,  ///< the centre line of a thin line
  Inner,   ///< the border towards the middle of the ring: of a painted band
};
inline constexpr std::array<std::string_view, 2> kLineEdgeNames{"middle", "inner"};
[[nodiscard]] constexpr Names names_of(LineEdge) {
  return kLineEdgeNames;
}

struct LineSettings {
  LineEdge edge = LineEdge::Middle;
  double mm_per_pixel = 0.03;  ///< near the line, > 0
  double max_gap_mm = 1.0;     ///< a ring with a longer gap is open, >= 0
};

/// A place where the line is not to be seen.
struct LineGap {
  Vec2 from_px = Vec2::Zero();
  Vec2 to_px = Vec2::Zero();
  double length_mm = 0.0;
  bool is_hidden = false;  ///< the other colour lies over it: not counted as an opening
  bool is_glare = false;   ///< a highlight lies over it: counts as an opening, for nobody can see what is under it
};

/// A line found in a picture, with sub-pixel points in order, about two pixels apart.
struct MarkedLine {
  /// A ring: counter-clockwise as seen on a screen, so also counter-clockwise once y runs up. An open ring
  /// starts behind its widest gap and ends before it; other gaps are bridged.
  std::vector<Vec2> points_px;
  bool is_closed = false;
  std::vector<LineGap> gaps;                ///< longest first, those bridged in a closed ring included
  double width_px = 0.0;                    ///< median width of the painted line
  double contrast = 0.0;                    ///< of ink to tissue, chroma over lightness
  double longest_unseen_mm = 0.0;  ///< as max_gap_mm, single points that were not seen included
  double gap_tolerance_mm = 0.0;   ///< by which a gap may be longer than it is said to be, and is still bridged
  [[nodiscard]] double max_gap_mm() const;  ///< longest that is not hidden; 0 without one
};

/// Where an open line runs out of a picture: the end that lies at its rim. Nobody knows whether such a ring is open.
/// @returns nothing for a closed line, or one whose ends are in view
[[nodiscard]] std::optional<Vec2> end_at_rim_px(const MarkedLine& line, int width_px, int height_px);

/// Finds the one ring (or, when nothing encloses anything, the one open line) of a colour.
///
/// Colour: OKLab chroma over lightness along the hue of the ink, less the median around: uneven light divides out, and
/// reddish tissue is the zero. Ring: a disc of half the largest gap rolls along the inside of the mask; where it
/// cannot pass, the ring is closed. Contour: the centre of mass of the colour across the line, or the place where half
/// of the band's colour is reached, both along the normal; repeated until it rests. docs/models/photograph.md
/// @param picture  finite size; @param name  stands for the file in messages.
/// @throws InvalidArgument for settings out of range; DataError where no line of that colour is found, or more than one
/// ring, or a ring that crosses itself.
[[nodiscard]] MarkedLine find_marked_line(const ColorPicture& picture, InkColor color, const LineSettings& settings,
                                          const std::filesystem::path& name);

}  // namespace incise
