#include "report/plot.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr std::string_view kRule = "stroke=\"#d9d9d4\" stroke-width=\"1\"";
constexpr std::string_view kAxis = "stroke=\"#555\" stroke-width=\"1\"";
constexpr double kYNameOffset = 54.0;  // distance of the name from the axis; the numbers are between them

/// Linear interpolation in a table of colours that are evenly spaced over [0, 1].
template <std::size_t N>
Vec3 interpolated(const std::array<std::array<double, 3>, N>& table, double t) {
  const double position = std::clamp(t, 0.0, 1.0) * static_cast<double>(N - 1);
  const std::size_t low = std::min(static_cast<std::size_t>(position), N - 2);
  const double f = position - static_cast<double>(low);
  Vec3 color;
  for (int c = 0; c < 3; ++c) {
    const auto k = static_cast<std::size_t>(c);
    color[c] = (1.0 - f) * table[low][k] + f * table[low + 1][k];
  }
  return color;
}

bool all_finite(const Points& points) {
  return std::all_of(points.begin(), points.end(), [](const Vec3& p) { return p.allFinite(); });
}

}  // namespace

std::vector<double> round_ticks(double low, double high, int count) {
  INCISE_REQUIRE(high > low && count > 0, "expected a range of positive length");
  const double step = rounded_up((high - low) / count * 0.999);
  std::vector<double> ticks;
  const auto first = static_cast<long>(std::ceil(low / step - 1e-9));
  const auto last = static_cast<long>(std::floor(high / step + 1e-9));
  for (long k = first; k <= last; ++k) ticks.push_back(static_cast<double>(k) * step);
  return ticks;
}

double rounded_up(double value) {
  INCISE_REQUIRE(std::isfinite(value) && value > 0.0, "expected a positive number");
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= value * (1.0 - 1e-12)) return factor * decade;
  }
  return 10.0 * decade;
}

Vec3 error_color(double share, ErrorColors colors) {
  // Both tables run from closer (-1) to farther (+1). The safe one differs in lightness and in blue against yellow at
  // once, and its middle stays dark enough to be seen on white.
  static constexpr std::array<std::array<double, 3>, 5> kSafe{
      {{0.09, 0.20, 0.55}, {0.33, 0.55, 0.80}, {0.72, 0.72, 0.70}, {0.89, 0.56, 0.22}, {0.55, 0.17, 0.02}}};
  static constexpr std::array<std::array<double, 3>, 9> kJet{{{0.0, 0.0, 0.5},
                                                              {0.0, 0.0, 1.0},
                                                              {0.0, 0.5, 1.0},
                                                              {0.0, 1.0, 1.0},
                                                              {0.5, 1.0, 0.5},
                                                              {1.0, 1.0, 0.0},
                                                              {1.0, 0.5, 0.0},
                                                              {1.0, 0.0, 0.0},
                                                              {0.5, 0.0, 0.0}}};
  const double t = 0.5 * (share + 1.0);
  return colors == ErrorColors::Jet ? interpolated(kJet, t) : interpolated(kSafe, t);
}

std::vector<Vec2> legend_places(std::span<const double> widths, const Vec2& first, double right, double first_right) {
  std::vector<Vec2> places;
  Vec2 at = first;
  for (const double width : widths) {
    const double edge = at.y() > first.y() ? right : first_right;
    if (at.x() > first.x() && at.x() + width > edge) at = {first.x(), at.y() + kLegendRow};
    places.push_back(at);
    at.x() += width;
  }
  return places;
}

void draw_y_axis(SvgWriter& svg, const PlotArea& area, const std::vector<double>& ticks, std::string_view name) {
  const double right = area.corner.x() + area.size.x();
  for (const double tick : ticks) {
    svg.line({area.corner.x(), area.y(tick)}, {right, area.y(tick)}, kRule);
    svg.text({area.corner.x() - 7.0, area.y(tick) + 4.0}, number_text(tick), "end");
  }
  const Vec2 middle(area.corner.x() - kYNameOffset, area.corner.y() + 0.5 * area.size.y());
  svg.text(middle, name, "middle", fmt::format("transform=\"rotate(-90 {:.2f} {:.2f})\"", middle.x(), middle.y()));
}

void draw_x_axis(SvgWriter& svg, const PlotArea& area, const std::vector<double>& ticks, std::string_view name,
                 std::string_view tick_suffix) {
  const double bottom = area.corner.y() + area.size.y();
  svg.line({area.corner.x(), bottom}, {area.corner.x() + area.size.x(), bottom}, kAxis);
  for (const double tick : ticks) {
    svg.line({area.x(tick), bottom}, {area.x(tick), bottom + 5.0}, kAxis);
    svg.text({area.x(tick), bottom + 19.0}, number_text(tick) + std::string(tick_suffix), "middle");
  }
  svg.text({area.corner.x() + 0.5 * area.size.x(), bottom + 39.0}, name, "middle");
}

void require_drawable(const ReportIncision& incision) {
  INCISE_REQUIRE(incision.incision.points.size() >= 2,
                 fmt::format("incision \"{}\": expected a contour of at least 2 points, found {}", incision.name,
                             incision.incision.points.size()));
  INCISE_REQUIRE(incision.signed_error_mm.size() == incision.incision.points.size(),
                 fmt::format("incision \"{}\": expected one error per point, found {} for {} points", incision.name,
                             incision.signed_error_mm.size(), incision.incision.points.size()));
  for (const double error : incision.signed_error_mm) {
    INCISE_REQUIRE(std::isfinite(error), fmt::format("incision \"{}\": an error is not finite", incision.name));
  }
  for (const Contour* contour :
       {&incision.tumor_edge, &incision.intended_path, &incision.corrected_path, &incision.incision}) {
    INCISE_REQUIRE(all_finite(contour->points),
                   fmt::format("incision \"{}\": a contour has a coordinate that is not finite", incision.name));
  }
}

double common_error_limit_mm(std::span<const ReportIncision> incisions) {
  double largest = 0.0;
  for (const ReportIncision& incision : incisions) {
    for (const double error : incision.signed_error_mm) largest = std::max(largest, std::abs(error));
  }
  return largest > 0.5 ? std::ceil(2.0 * largest) / 2.0 : 0.5;
}

double error_limit_of(const FigureStyle& style, std::span<const ReportIncision> incisions) {
  INCISE_REQUIRE(std::isfinite(style.error_limit_mm) && style.error_limit_mm >= 0.0,
                 "expected an error limit that is not negative");
  return std::max(style.error_limit_mm, common_error_limit_mm(incisions));
}

}  // namespace incise
