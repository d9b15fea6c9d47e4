#pragma once

#include <incise/geometry/contour.hpp>

#include <optional>
#include <string>

namespace incise {

/// Where a contour meets itself, seen along `approach`: on the first segment, counted from the start, that meets one
/// that is not its neighbour; mm, at the height of that segment's start. Absent for a simple curve. O(n²).
/// @pre all points finite.
[[nodiscard]] std::optional<Vec3> first_crossing_in_view(const Contour& contour, const Vec3& approach);

/// What a tumour may measure across: a smaller or a larger one is a wrong scale or a wrong unit.
inline constexpr double kSmallestTumorMm = 2.0;
inline constexpr double kLargestTumorMm = 100.0;
/// An incision leaves room for the widest margin round the largest tumour.
inline constexpr double kLargestIncisionMm = 2.0 * kLargestTumorMm;

/// Longest side of the box round a contour, along the axes, mm; 0 without points.
[[nodiscard]] double extent_mm(const Contour& contour);

/// What is wrong with the size of something, as two halves of an error message.
struct SizeProblem {
  std::string found;
  std::string expected;
};
/// @param what  "a tumour"; @param largest_mm  one of the limits above. Absent: the size is possible.
[[nodiscard]] std::optional<SizeProblem> size_problem(const Contour& contour, const std::string& what,
                                                      double largest_mm);

}  // namespace incise
