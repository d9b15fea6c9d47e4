#pragma once

#include <incise/core/names.hpp>
#include <incise/geometry/picture.hpp>
#include <incise/geometry/types.hpp>

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace incise {

enum class InkColor { Red, Green };
inline constexpr std::array<std::string_view, 2> kInkColorNames{"red", "green"};
[[nodiscard]] constexpr Names names_of(InkColor) {
  return kInkColorNames;
}

/// The part of a painted line that is taken as its contour.
enum class LineEdge {
  Middle,  ///< the centre line of a thin line
  Inner,   ///< the border of a painted band, on the side of the ring's middle
};
inline constexpr std::array<std::string_view, 2> kLineEdgeNames{"middle", "inner"};
[[nodiscard]] constexpr Names names_of(LineEdge) {
  return kLineEdgeNames;
}

struct LineSettings {
  LineEdge edge = LineEdge::Middle;
  double mm_per_pixel = 0.03;  ///< scale near the line, > 0
  double max_gap_mm = 1.0;     ///< a ring with a longer gap is open, >= 0
};

/// A stretch where the line is not seen.
struct LineGap {
  Vec2 from_px = Vec2::Zero();
  Vec2 to_px = Vec2::Zero();
  double length_mm = 0.0;
  bool is_hidden = false;  ///< covered by the other colour over at most 8 mm: not counted as an opening
  bool is_glare = false;   ///< covered by a highlight: counted as an opening, because what lies under it is unknown
};

/// A line found in a picture, as sub-pixel points in order, about two pixels apart.
struct MarkedLine {
  /// A ring runs counter-clockwise on the screen, and so also after the change to y upwards. An open ring starts after
  /// its widest gap and ends before it; other gaps are bridged.
  std::vector<Vec2> points_px;
  bool is_closed = false;
  std::vector<LineGap> gaps;                ///< longest first, including those bridged in a closed ring
  double width_px = 0.0;                    ///< median width of the line; for an inner edge, ink area over length
  double contrast = 0.0;                    ///< strength of the ink minus the tissue's
  double longest_unseen_mm = 0.0;           ///< as max_gap_mm(), but including single unseen points
  double gap_tolerance_mm = 0.0;            ///< uncertainty of a gap's length, added to the largest allowed gap
  [[nodiscard]] double max_gap_mm() const;  ///< longest gap that is not hidden; 0 if there is none
};

/// Returns the end of an open line that lies at the picture's rim: the line leaves the picture there, so whether the
/// ring is closed is unknown. Returns nullopt for a closed line, or if both ends are in view.
[[nodiscard]] std::optional<Vec2> end_at_rim_px(const MarkedLine& line, int width_px, int height_px);

/// Finds the ring of a colour or, if no ink encloses anything, the longest open line.
///
/// Colour: OKLab chroma over lightness along the hue of the ink, minus the median of the surroundings. Uneven light
/// divides out, and reddish tissue becomes the zero. Ring: a disc wider than the largest gap rolls along the inside of
/// the ink; a place that it cannot leave is enclosed. Contour: along the normal, the centre of mass of the colour or,
/// for an inner edge, the place where the colour reaches half the band's level; four passes. docs/models/photograph.md
/// @param name  file name for messages.
/// @throws InvalidArgument if settings are out of range; DataError if there is no line of that colour, more than one
/// ring, or a ring that crosses itself.
[[nodiscard]] MarkedLine find_marked_line(const ColorPicture& picture, InkColor color, const LineSettings& settings,
                                          const std::filesystem::path& name);

}  // namespace incise
