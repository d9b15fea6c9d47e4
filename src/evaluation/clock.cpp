#include <incise/core/error.hpp>
#include <incise/evaluation/clock.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace incise {

std::vector<double> clock_hours(const Points& points, const Vec3& center, const Vec3& approach, const Vec3& twelve) {
  const ViewFrame view = view_along(approach);
  const Vec2 up(twelve.dot(view.x), twelve.dot(view.y));
  INCISE_REQUIRE(up.norm() > 1e-9 * twelve.norm() && twelve.norm() > 0.0,
                 "expected 12 o'clock in a direction across the approach");
  const Vec2 right(up.y(), -up.x());
  std::vector<double> hours;
  hours.reserve(points.size());
  for (const Vec3& p : points) {
    const Vec2 out = view.to_view(p - center).head<2>();
    const double turn = std::atan2(out.dot(right), out.dot(up)) / (2.0 * std::numbers::pi);
    const double hour = 12.0 * (turn - std::floor(turn));
    hours.push_back(hour < 12.0 ? hour : 0.0);  // a hair left of twelve rounds up to it
  }
  return hours;
}

std::array<ClockSector, 12> errors_by_clock(std::span<const double> hours, std::span<const double> errors_mm) {
  INCISE_REQUIRE(hours.size() == errors_mm.size(),
                 fmt::format("found {} places for {} errors, expected one each", hours.size(), errors_mm.size()));
  std::array<ClockSector, 12> sectors;
  for (std::size_t k = 0; k < 12; ++k) sectors[k].hour = static_cast<int>(k) + 1;
  std::array<double, 12> sums{};
  for (std::size_t i = 0; i < hours.size(); ++i) {
    INCISE_REQUIRE(hours[i] >= 0.0 && hours[i] < 12.0, fmt::format("place {} is not in [0, 12)", i));
    const std::size_t k = (static_cast<std::size_t>(hours[i] + 0.5) + 11) % 12;
    ClockSector& sector = sectors[k];
    const double error = errors_mm[i];
    sector.min_mm = sector.points == 0 ? error : std::min(*sector.min_mm, error);
    sector.max_mm = sector.points == 0 ? error : std::max(*sector.max_mm, error);
    sums[k] += error;
    ++sector.points;
  }
  for (std::size_t k = 0; k < 12; ++k) {
    if (sectors[k].points > 0) sectors[k].mean_mm = sums[k] / static_cast<double>(sectors[k].points);
  }
  return sectors;
}

}  // namespace incise
