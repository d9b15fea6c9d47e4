#pragma once

#include <incise/core/names.hpp>
#include <incise/geometry/contour.hpp>
#include <incise/imaging/marked_line.hpp>
#include <incise/imaging/photo_scale.hpp>

#include <optional>
#include <string>

namespace incise {

/// What the red line in a photograph represents.
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

/// A piece of ink that is not part of a line.
struct PhotoMark {
  Vec2 at_px = Vec2::Zero();  ///< its middle
  double longest_mm = 0.0;    ///< longer side of its bounding box
};

/// A stretch of a line that looks different from the rest.
struct OddStretch {
  Vec2 at_px = Vec2::Zero();  ///< where it differs most
  double length_mm = 0.0;     ///< along the line
  std::string what;           ///< the feature that differs, and by how much
};

/// The contours of one top-view photograph, mm, in the picture's plane: x to the right, y up, z = 0; seen along -z.
struct PhotoContours {
  Contour tumor_edge;  ///< closed, counter-clockwise, starts at its topmost point
  Contour incision;    ///< if closed, as tumor_edge; if open, starts after the widest gap and ends before it
  MarkedLine green;    ///< the same lines in pixels, with gaps and width
  MarkedLine red;
  double mm_per_pixel = 0.0;  ///< at the middle of the tumour edge
  /// Red marks inside the tumour edge that are not part of the red line, largest first: blood, or a misplaced cut. At
  /// least 8 pixels of 0.35 times the line's strength and 8 times the tissue's own spread.
  std::vector<PhotoMark> red_in_tumor;
  /// Green marks that are not part of the green line, largest first: at least 24 truly green pixels, and shorter than
  /// kSmallestTumorMm.
  std::vector<PhotoMark> green_beside;
  /// A stretch of a closed red ring, averaged over the largest gap, whose width, colour or lightness differs from the
  /// rest. Blood as thin as the line may hide an opening there.
  std::optional<OddStretch> odd_stretch;
};

/// Finds the tumour edge (green) and the incision (red) in a photograph; see find_marked_line. Where one line crosses
/// the other, the hidden part of the lower one is bridged (up to 8 mm). An open red ring is a valid result; an open
/// green ring is an error.
/// @param name  file name for messages.
/// @throws InvalidArgument if max_gap_mm is negative or not finite.
/// @throws DataError for: no red or no green line; two tumours; a line that leaves the picture, crosses itself or has a
/// loop (with its place); much other ink beside a ring; a green mark of kSmallestTumorMm or more beside the green ring,
/// or a red mark of 3 mm or more inside it; a tumour edge that is open (with the width of the opening); or one less
/// than kSmallestTumorMm or more than kLargestTumorMm across, as with a wrong scale.
[[nodiscard]] PhotoContours find_photo_contours(const ColorPicture& picture, const PhotoScale& scale,
                                                const PhotoSettings& settings, const std::filesystem::path& name);

/// Returns the photograph, slightly darkened, with the found lines drawn over it: the first line (tumour edge) cyan,
/// the others (incision) white, gaps yellow, ruler marks magenta.
[[nodiscard]] ColorPicture draw_found(const ColorPicture& picture, const std::vector<const MarkedLine*>& lines,
                                      const std::vector<Vec2>& ruler_marks_px = {});

}  // namespace incise
