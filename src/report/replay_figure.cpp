#include "report/plot.hpp"
#include "report/svg.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/contour.hpp>
#include <incise/report/replay_figure.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace incise {
namespace {

constexpr double kWidth = 860.0, kHeight = 400.0;
constexpr double kPicture = 320.0;  // side of the square with the path
constexpr double kScaleBarMm = 5.0;
constexpr std::string_view kWorstMark = "fill=\"none\" stroke=\"#555\" stroke-width=\"1.4\"";
constexpr std::size_t kMostPoints = 1500;  // of a curve: more than the picture has pixels

void require_drawable(const ReplayPicture& p) {
  const std::size_t n = p.tip_mm.size();
  INCISE_REQUIRE(n >= 2, fmt::format("expected at least 2 samples, found {}", n));
  INCISE_REQUIRE(p.time_s.size() == n && p.tip_speed_mm_s.size() == n && p.deviation_mm.size() == n,
                 "expected one time, speed and deviation for each place");
  for (std::size_t i = 0; i < n; ++i) {
    INCISE_REQUIRE(p.tip_mm[i].allFinite() && std::isfinite(p.time_s[i]) && std::isfinite(p.tip_speed_mm_s[i]) &&
                       std::isfinite(p.deviation_mm[i]),
                   fmt::format("expected finite numbers, found a non-finite one at sample {}", i));
  }
}

/// Returns the stride through `count` points that draws at most kMostPoints.
std::size_t stride_of(std::size_t count) {
  return (count + kMostPoints - 1) / kMostPoints;
}

std::size_t worst_of(const ReplayPicture& picture) {
  const auto worst = std::max_element(picture.deviation_mm.begin(), picture.deviation_mm.end());
  return static_cast<std::size_t>(worst - picture.deviation_mm.begin());
}

void draw_paths(SvgWriter& svg, const ReplayPicture& picture) {
  const ViewFrame view = view_along(picture.approach);
  Eigen::AlignedBox2d box;
  for (const Vec3& p : picture.tip_mm) box.extend(Vec2(view.to_view(p).head<2>()));
  const double side = std::max(1.2 * box.sizes().maxCoeff(), 2.0 * kScaleBarMm);
  const Vec2 corner = box.center() - Vec2::Constant(0.5 * side);
  const auto at = [&](const Vec3& p) {
    const Vec2 q = (view.to_view(p).head<2>() - corner) / side * kPicture;
    return Vec2(20.0 + q.x(), 44.0 + kPicture - q.y());
  };
  const auto draw = [&](const Points& points, std::string_view style) {
    std::vector<Vec2> line;
    for (std::size_t i = 0; i < points.size(); i += stride_of(points.size())) line.push_back(at(points[i]));
    if (!points.empty()) line.push_back(at(points.back()));
    svg.polyline(line, false, style);
  };
  if (!picture.intended_mm.empty())
    draw(picture.intended_mm, fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"4\"", ink::kIntended));
  draw(picture.tip_mm, fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"", ink::kKerf));
  const double bar = kScaleBarMm / side * kPicture;
  svg.line({24.0, 384.0}, {24.0 + bar, 384.0}, "stroke=\"#111\" stroke-width=\"3\"");
  svg.text({30.0 + bar, 388.0}, fmt::format("{} mm", number_text(kScaleBarMm)));
  if (picture.intended_mm.empty()) return svg.text({20.0, 30.0}, "tip; no intended path to compare it with");
  const std::size_t worst = worst_of(picture);
  svg.circle(at(picture.tip_mm[worst]), 8.0, kWorstMark);
  svg.text({20.0, 20.0}, "tip (colour) over the intended path (black)");
  svg.text({20.0, 36.0}, fmt::format("at most {:.2g} mm off in the cut (circle)", picture.deviation_mm[worst]));
}

/// The horizontal axis of a curve.
struct Course {
  std::string name;
  std::vector<double> at;
};

void draw_curve(SvgWriter& svg, const Course& course, const std::vector<double>& values, const Vec2& corner,
                double height, std::string_view name, std::optional<std::size_t> mark = {}) {
  const double high = rounded_up(std::max(1e-3, 1.05 * *std::max_element(values.begin(), values.end())));
  const PlotArea area{.corner = corner,
                      .size = {420.0, height},
                      .x_low = course.at.front(),
                      .x_high = course.at.back(),
                      .y_low = 0.0,
                      .y_high = high};
  draw_y_axis(svg, area, round_ticks(0.0, high, 4), name);
  draw_x_axis(svg, area, round_ticks(area.x_low, area.x_high, 6), course.name);
  std::vector<Vec2> line;
  for (std::size_t i = 0; i < values.size(); i += stride_of(values.size()))
    line.push_back(area.at(course.at[i], values[i]));
  svg.polyline(line, false, fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"", ink::kSeries[1]));
  if (mark) svg.circle(area.at(course.at[*mark], values[*mark]), 5.0, kWorstMark);
}

}  // namespace

std::string replay_figure_svg(const ReplayPicture& picture) {
  require_drawable(picture);
  SvgWriter svg(
      kWidth, kHeight, "The program as the player ran it",
      "The tip's path over the intended one, its speed over time and its deviation along the way, while it cuts.");
  draw_paths(svg, picture);
  draw_curve(svg, {"time, s", picture.time_s}, picture.tip_speed_mm_s, {420.0, 44.0}, 110.0, "tip speed, mm/s");
  if (picture.intended_mm.empty()) return svg.finish();
  draw_curve(svg, {"path of the tip, mm", arclengths_mm(picture.tip_mm)}, picture.deviation_mm, {420.0, 226.0}, 110.0,
             "deviation, mm", worst_of(picture));
  return svg.finish();
}

}  // namespace incise
