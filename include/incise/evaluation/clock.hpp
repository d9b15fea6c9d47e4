#pragma once

#include <incise/geometry/contour.hpp>

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace incise {

/// Signed errors of the points that lie nearest to one hour of a clock face over the tumour.
struct ClockSector {
  int hour = 12;           ///< 1 … 12; the sector extends half an hour, 15 degrees, to either side
  std::size_t points = 0;  ///< 0: no cut there, and the errors are absent
  std::optional<double> mean_mm;
  std::optional<double> min_mm;
  std::optional<double> max_mm;
};
inline void describe(Visitor& v, ClockSector& s) {
  v("hour", s.hour, "Hour, 1 to 12; the sector extends half an hour to either side.");
  v("points", s.points, "Number of points; 0: no cut there.");
  v({"mean_mm", "Mean signed error.", "mm"}, s.mean_mm);
  v({"min_mm", "Least signed error.", "mm"}, s.min_mm);
  v({"max_mm", "Greatest signed error.", "mm"}, s.max_mm);
}

/// Returns the clock position of each point, as the observer sees it along the approach: hours in [0, 12), clockwise, 0
/// = 12 o'clock. A point on the line of sight through `center` gets 0.
/// @param points   mm.
/// @param center   any point on the line of sight through the middle of the clock face, mm, same frame.
/// @param twelve   direction of 12 o'clock; only its part across the approach counts.
/// @throws InvalidArgument if `twelve` has no part across the approach.
[[nodiscard]] std::vector<double> clock_hours(const Points& points, const Vec3& center, const Vec3& approach,
                                              const Vec3& twelve);

/// Returns the signed errors, mm, by sector: hours 1, 2, … 12.
/// @param hours  clock position of each error, [0, 12).
/// @throws InvalidArgument for different lengths, or an hour out of range.
[[nodiscard]] std::array<ClockSector, 12> errors_by_clock(std::span<const double> hours,
                                                          std::span<const double> errors_mm);

}  // namespace incise
