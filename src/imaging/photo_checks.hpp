#pragma once

#include "imaging/line_tracing.hpp"

#include <incise/imaging/photo_contours.hpp>

namespace incise::imaging_detail {

/// A line that was found in a photograph, and where it was found: what all checks of it need.
struct CheckedLine {
  const MarkedLine& line;
  LineEdge edge;
  InkColor color;
  const cv::Mat& mask;  ///< its colour, of the whole picture
  double mm_per_pixel;
  double max_gap_mm;
  const std::filesystem::path& name;
};

/// A ring that is cut off by the picture's rim is not open: nobody knows. @throws DataError
void require_in_view(const CheckedLine& checked);

/// Ink that the ring found does not explain: a second line, or a second loop of one that crosses itself. Specks, as
/// noise paints them in the dark, are no line. @throws DataError
void require_nothing_else(const CheckedLine& checked);

/// A simple curve, whose ink encloses one place (a ring) or none (an open line). Every other place that the same ink
/// encloses is a loop, unless it lies within the line's own width: a highlight, or a burnt spot on a band. An open line
/// whose ink encloses the ring was led astray: that, too, is refused, with the mark inside the ring that did it.
/// @throws DataError naming the place
void require_simple(const CheckedLine& checked);

/// Pieces of ink beside a closed line, largest first. @param within  only inside this ring, px; null: everywhere.
[[nodiscard]] std::vector<PhotoMark> marks_beside(const CheckedLine& checked, const cv::Mat& ink,
                                                  const std::vector<Vec2>* within);

/// @param marks  largest first. @param place  for the message. @throws DataError for one of least_mm or more
void require_no_large_mark(const CheckedLine& checked, const std::vector<PhotoMark>& marks, double least_mm,
                           const char* place);

/// A mask as ink_mask gives it, in the box round a ring alone, of ink that may be too faint or too small to be part of
/// a line, but is more than the tissue's own variation.
[[nodiscard]] cv::Mat faint_ink(const InkMap& map, const std::vector<Vec2>& within);

}  // namespace incise::imaging_detail
