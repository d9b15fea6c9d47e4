#pragma once

#include "imaging/line_tracing.hpp"

#include <incise/imaging/photo_contours.hpp>

namespace incise::imaging_detail {

/// A line found in a photograph, with everything that its checks need.
struct CheckedLine {
  const MarkedLine& line;
  LineEdge edge;
  InkColor color;
  const cv::Mat& mask;  ///< ink of its colour in the whole picture
  double mm_per_pixel;
  double max_gap_mm;
  const std::filesystem::path& name;
};

/// Refuses a line that leaves the picture: whether such a ring is closed is unknown. @throws DataError
void require_in_view(const CheckedLine& checked);

/// Refuses much ink outside the ring found: a second line, or a second loop of a line that crosses itself. Specks, as
/// from noise in dark areas, do not count. @throws DataError
void require_nothing_else(const CheckedLine& checked);

/// Refuses a line that is not a simple curve. The ink of a ring must enclose one place, that of an open line none.
/// Every other enclosed place is a loop, unless it lies within the line's own width (a highlight, or a burnt spot on a
/// band). Also refuses an open line whose ink encloses a ring: usually a mark inside the ring misled the search.
/// @throws DataError naming the place
void require_simple(const CheckedLine& checked);

/// Returns the pieces of ink beside a line, largest first; none for an open line unless `within` is given.
/// @param within  only inside this ring, px; null: everywhere.
[[nodiscard]] std::vector<PhotoMark> marks_beside(const CheckedLine& checked, const cv::Mat& ink,
                                                  const std::vector<Vec2>* within);

/// Refuses marks of `least_mm` or more beside a closed line.
/// @param marks  largest first. @param place  for the message. @throws DataError
void require_no_large_mark(const CheckedLine& checked, const std::vector<PhotoMark>& marks, double least_mm,
                           const char* place);

/// Returns a mask like that of ink_mask, only in the box round a ring, of ink that may be too faint or too small for a
/// line but exceeds the tissue's own variation.
[[nodiscard]] cv::Mat faint_ink(const InkMap& map, const std::vector<Vec2>& within);

}  // namespace incise::imaging_detail
