#pragma once

#include <incise/geometry/contour.hpp>

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace incise {

/// Errors of the points that lie nearest to one hour of a clock face laid over the tumour.
struct ClockSector {
  int hour = 12;           ///< 1 … 12; the sector reaches half an hour, 15 degrees, to both sides
  std::size_t points = 0;  ///< 0: no cut there, and nothing below
  std::optional<double> mean_mm;
  std::optional<double> min_mm;
  std::optional<double> max_mm;
};
inline void describe(Visitor& v, ClockSector& s) {
  v("hour", s.hour, "1 to 12; half an hour to both sides.");
  v("points", s.points, "How many; 0: no cut there.");
  v({"mean_mm", "Mean signed error.", "mm"}, s.mean_mm);
  v({"min_mm", "Least signed error.", "mm"}, s.min_mm);
  v({"max_mm", "Greatest signed error.", "mm"}, s.max_mm);
}

/// Where points lie on a clock face about `center`, as the observer sees it along the approach: hours in [0, 12),
/// clockwise, 0 = 12 o'clock.
/// @param center   any point on the line of sight through the middle of the face, mm.
/// @param twelve   direction of 12 o'clock; its part across the approach counts. @pre has one.
/// @returns one value for each of `points`; a point on the line of sight itself counts as 0.
[[nodiscard]] std::vector<double> clock_hours(const Points& points, const Vec3& center, const Vec3& approach,
                                              const Vec3& twelve);

/// Signed errors, mm, sector by sector: 1, 2, … 12. @pre equally long.
[[nodiscard]] std::array<ClockSector, 12> errors_by_clock(std::span<const double> hours,
                                                          std::span<const double> errors_mm);

}  // namespace incise
