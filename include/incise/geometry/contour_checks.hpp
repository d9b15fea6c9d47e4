#pragma once

#include <incise/core/problem.hpp>
#include <incise/geometry/contour.hpp>

#include <optional>
#include <string>

namespace incise {

/// Returns where a contour meets itself, seen along `approach`: a point, mm, of the first segment from the start that
/// meets a segment other than its neighbours, at the height of that first segment's start. nullopt for a simple curve.
/// O(n²).
/// @pre all points finite.
[[nodiscard]] std::optional<Vec3> first_crossing_in_view(const Contour& contour, const Vec3& approach);

/// Limits of a tumour's size, the longest side of its bounding box, mm: a smaller or larger one indicates a wrong scale
/// or unit.
inline constexpr double kSmallestTumorMm = 2.0;
inline constexpr double kLargestTumorMm = 100.0;
/// Largest size of an incision, mm: room for the widest margin round the largest tumour.
inline constexpr double kLargestIncisionMm = 2.0 * kLargestTumorMm;

/// Checks that the size of a contour (the longest side of its axis-aligned bounding box; 0 without points) is from
/// kSmallestTumorMm to `largest_mm`. Returns nullopt if it is, otherwise what was found and expected.
/// @param what  names it in the message: "a tumour".  @param largest_mm  one of the limits above.
[[nodiscard]] std::optional<Problem> size_problem(const Contour& contour, const std::string& what, double largest_mm);

}  // namespace incise
