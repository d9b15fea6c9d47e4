#pragma once

#include <incise/geometry/contour.hpp>

#include <optional>
#include <string>

namespace incise {

/// Returns where a contour meets itself, seen along `approach`: a point, mm, of the first segment from the start that
/// meets a segment other than its neighbours, at the height of that first segment's start. nullopt for a simple curve.
/// O(n²).
/// @pre all points finite.
[[nodiscard]] std::optional<Vec3> first_crossing_in_view(const Contour& contour, const Vec3& approach);

/// Limits of a tumour's size (extent_mm), mm: a smaller or larger one indicates a wrong scale or unit.
inline constexpr double kSmallestTumorMm = 2.0;
inline constexpr double kLargestTumorMm = 100.0;
/// Largest size of an incision, mm: room for the widest margin round the largest tumour.
inline constexpr double kLargestIncisionMm = 2.0 * kLargestTumorMm;

/// Longest side of the contour's axis-aligned bounding box, mm; 0 without points.
[[nodiscard]] double extent_mm(const Contour& contour);

/// A problem with the size of something, as the two halves of an error message.
struct SizeProblem {
  std::string found;
  std::string expected;
};
/// Checks that the size of a contour (extent_mm) is from kSmallestTumorMm to `largest_mm`. Returns nullopt if it is.
/// @param what  names it in the message: "a tumour".  @param largest_mm  one of the limits above.
[[nodiscard]] std::optional<SizeProblem> size_problem(const Contour& contour, const std::string& what,
                                                      double largest_mm);

}  // namespace incise
