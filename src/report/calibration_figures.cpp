#include "report/plot.hpp"

#include <incise/core/error.hpp>
#include <incise/report/calibration_figures.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr double kCellPx = 58.0;
constexpr double kMapLeft = 62.0;
constexpr double kMapTop = 74.0;
constexpr double kMapGap = 74.0;
constexpr double kPanelWidth = 400.0;
constexpr double kPanelHeight = 190.0;
constexpr double kPanelLeft = 62.0;
constexpr std::string_view kPhotographed = ink::kSeries[0];
constexpr std::string_view kFitted = ink::kSeries[1];
constexpr std::string_view kSimulatedAgain = ink::kSeries[2];

std::string virtual_note(bool is_virtual) {
  return is_virtual ? " (virtual specimens)" : "";
}

/// White to a deep blue-green.
Vec3 score_color(double share) {
  const Vec3 deep(0.05, 0.37, 0.45);
  return Vec3::Ones() + std::clamp(share, 0.0, 1.0) * (deep - Vec3::Ones());
}

std::string_view text_on(const Vec3& color) {
  return color.mean() < 0.55 ? "fill=\"#fff\"" : "fill=\"#111\"";
}

void hatch(SvgWriter& svg, const Vec2& corner) {
  svg.rectangle(corner, {kCellPx, kCellPx}, "fill=\"#f2f2ef\" stroke=\"#bbb\"");
  for (double at = 8.0; at < 2.0 * kCellPx; at += 8.0) {
    const double from = std::max(0.0, at - kCellPx);
    const double to = std::min(at, kCellPx);
    svg.line(corner + Vec2(from, at - from), corner + Vec2(to, at - to), "stroke=\"#b9b9b2\" stroke-width=\"1\"");
  }
}

struct CellLook {
  bool is_failure = false;
  Vec3 color = Vec3::Ones();
  std::string text;
};

/// Draws one of the two maps: speeds downwards, dullness to the right.
template <class Look>
void draw_map(SvgWriter& svg, const ScoreGrid& grid, double left, const std::string& name, const Look& look) {
  const auto columns = static_cast<double>(grid.dullnesses.size());
  svg.text({left + 0.5 * columns * kCellPx, kMapTop - 30.0}, name, "middle", "font-weight=\"600\"");
  svg.text({left + 0.5 * columns * kCellPx, kMapTop + kCellPx * static_cast<double>(grid.speeds_mm_s.size()) + 34.0},
           "dullness", "middle");
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    const std::size_t row = i / grid.dullnesses.size();
    const std::size_t column = i % grid.dullnesses.size();
    const Vec2 corner(left + kCellPx * static_cast<double>(column), kMapTop + kCellPx * static_cast<double>(row));
    const CellLook cell = look(grid.cells[i]);
    if (cell.is_failure) {
      hatch(svg, corner);
      svg.text(corner + Vec2(0.5 * kCellPx, 0.5 * kCellPx + 4.0), "failure", "middle", "fill=\"#444\"");
    } else {
      svg.rectangle(corner, {kCellPx, kCellPx}, fmt::format("fill=\"{}\" stroke=\"#fff\"", hex_color(cell.color)));
      svg.text(corner + Vec2(0.5 * kCellPx, 0.5 * kCellPx + 4.0), cell.text, "middle", text_on(cell.color));
    }
    if (row == 0) {
      const double below = kMapTop + kCellPx * static_cast<double>(grid.speeds_mm_s.size()) + 16.0;
      svg.text({corner.x() + 0.5 * kCellPx, below}, number_text(grid.dullnesses[column]), "middle");
    }
    if (column == 0)
      svg.text({left - 8.0, corner.y() + 0.5 * kCellPx + 4.0}, number_text(grid.speeds_mm_s[row]), "end");
  }
  if (!grid.chosen) return;
  const Vec2 at(left + kCellPx * static_cast<double>(*grid.chosen % grid.dullnesses.size()),
                kMapTop + kCellPx * static_cast<double>(*grid.chosen / grid.dullnesses.size()));
  svg.rectangle(at + Vec2(1.5, 1.5), {kCellPx - 3.0, kCellPx - 3.0},
                "fill=\"none\" stroke=\"#d55e00\" stroke-width=\"3\"");
}

void require_grid(const ScoreGrid& grid) {
  INCISE_REQUIRE(!grid.cells.empty() && grid.cells.size() == grid.speeds_mm_s.size() * grid.dullnesses.size(),
                 fmt::format("expected a cell for each of {} speeds and {} values of dullness, found {}",
                             grid.speeds_mm_s.size(), grid.dullnesses.size(), grid.cells.size()));
  for (const auto* values : {&grid.speeds_mm_s, &grid.dullnesses}) {
    for (const double value : *values) {
      INCISE_REQUIRE(std::isfinite(value),
                     fmt::format("expected finite speeds and values of dullness, found {}", value));
    }
  }
  INCISE_REQUIRE(!grid.chosen || *grid.chosen < grid.cells.size(), "expected the chosen cell among the cells");
  for (const ScoreGrid::Cell& cell : grid.cells) {
    INCISE_REQUIRE(std::isfinite(cell.score_percent) && std::isfinite(cell.mean_signed_mm.value_or(0.0)),
                   "expected finite scores and errors");
  }
}

struct Bounds {
  double low = 0.0;
  double high = 0.0;
  void take(const std::vector<double>& values) {
    for (const double value : values) {
      INCISE_REQUIRE(std::isfinite(value), "expected finite numbers");
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
};

void draw_values(SvgWriter& svg, const PlotArea& area, const std::vector<double>& x, const std::vector<double>& y,
                 const std::string& style) {
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < x.size(); ++i) points.push_back(area.at(x[i], y[i]));
  svg.polyline(points, false, style + " fill=\"none\"");
}

/// A profile goes once round and ends where it began.
void draw_profile(SvgWriter& svg, const PlotArea& area, const std::vector<double>& values, const std::string& style) {
  std::vector<double> degrees;
  std::vector<double> closed = values;
  closed.push_back(values.front());
  for (std::size_t i = 0; i < closed.size(); ++i) {
    degrees.push_back(360.0 * static_cast<double>(i) / static_cast<double>(values.size()));
  }
  draw_values(svg, area, degrees, closed, style);
}

void draw_specimen(SvgWriter& svg, const ProfileCurves& curves, const Vec2& corner, const Bounds& bounds) {
  const PlotArea area{corner, {kPanelWidth, kPanelHeight}, 0.0, 360.0, bounds.low, bounds.high};
  draw_y_axis(svg, area, round_ticks(bounds.low, bounds.high, 5), "signed error, mm");
  draw_x_axis(svg, area, {0.0, 90.0, 180.0, 270.0, 360.0}, "direction from the start, counter-clockwise", "°");
  svg.text({corner.x() + 0.5 * kPanelWidth, corner.y() - 8.0}, curves.name, "middle", "font-weight=\"600\"");
  draw_profile(svg, area, curves.photographed_mm, fmt::format("stroke=\"{}\" stroke-width=\"2.2\"", kPhotographed));
  if (!curves.simulated_mm.empty()) {
    draw_profile(svg, area, curves.simulated_mm,
                 fmt::format("stroke=\"{}\" stroke-width=\"1.4\" stroke-dasharray=\"5 3\"", kSimulatedAgain));
  }
  draw_profile(svg, area, curves.fitted_mm, fmt::format("stroke=\"{}\" stroke-width=\"1.8\"", kFitted));
}

void draw_marginal(SvgWriter& svg, const MarginalCurve& curve, const Vec2& corner, double width) {
  INCISE_REQUIRE(curve.values.size() == curve.density.size() && curve.values.size() >= 2,
                 fmt::format("{}: expected as many densities as values, at least 2", curve.label));
  Bounds bounds;
  bounds.take(curve.density);
  const PlotArea area{corner, {width, 0.7 * kPanelHeight}, curve.values.front(), curve.values.back(),
                      0.0,    1.08 * bounds.high};
  const double low = std::max(curve.low, area.x_low);
  const double high = std::min(curve.high, area.x_high);
  svg.rectangle({area.x(low), corner.y()}, {area.x(high) - area.x(low), area.size.y()}, "fill=\"#dbe7ef\"");
  draw_x_axis(svg, area, round_ticks(area.x_low, area.x_high, 4), curve.label);
  draw_values(svg, area, curve.values, curve.density, fmt::format("stroke=\"{}\" stroke-width=\"1.8\"", kFitted));
}

void draw_fit_legend(SvgWriter& svg, double y) {
  const auto entry = [&](double x, std::string_view color, const char* dash, const char* name) {
    svg.line({x, y}, {x + 22.0, y},
             fmt::format("stroke=\"{}\" stroke-width=\"2\" stroke-dasharray=\"{}\"", color, dash));
    svg.text({x + 28.0, y + 4.0}, name);
  };
  entry(kPanelLeft, kPhotographed, "none", "photographed");
  entry(kPanelLeft + 130.0, kFitted, "none", "fitted, bias included");
  entry(kPanelLeft + 300.0, kSimulatedAgain, "5 3", "simulated again at the fitted values, without bias");
}

}  // namespace

std::string score_heat_map_svg(const ScoreGrid& grid) {
  require_grid(grid);
  const double width = kCellPx * static_cast<double>(grid.dullnesses.size());
  const double height = kCellPx * static_cast<double>(grid.speeds_mm_s.size());
  double most_percent = 100.0;
  double most_error = 0.1;
  for (const ScoreGrid::Cell& cell : grid.cells) {
    most_percent = std::max(most_percent, cell.score_percent);
    most_error = std::max(most_error, std::abs(cell.mean_signed_mm.value_or(0.0)));
  }
  const double whole_width = kMapLeft + 2.0 * width + kMapGap + 24.0;
  SvgWriter svg(whole_width, kMapTop + height + 52.0, "Score by speed and dullness",
                "Two heat maps: score in per cent of the photographed incisions, and mean signed error");
  svg.text({0.5 * whole_width, 20.0}, "Simulated incisions by speed and dullness" + virtual_note(grid.is_virtual),
           "middle", "font-weight=\"600\" font-size=\"13\"");
  svg.text({kMapLeft - 8.0, kMapTop - 10.0}, "mm/s", "end");
  draw_map(svg, grid, kMapLeft, "score, % of the photographed", [&](const ScoreGrid::Cell& cell) {
    return CellLook{cell.is_failure, score_color(cell.score_percent / most_percent),
                    fmt::format("{:.1f}", cell.score_percent)};
  });
  draw_map(svg, grid, kMapLeft + width + kMapGap, "mean signed error of the mid-line, mm",
           [&](const ScoreGrid::Cell& cell) {
             if (!cell.mean_signed_mm) return CellLook{true, Vec3::Ones(), ""};
             return CellLook{cell.is_failure, error_color(*cell.mean_signed_mm / most_error, ErrorColors::Safe),
                             fmt::format("{:.2f}", *cell.mean_signed_mm)};
           });
  return svg.finish();
}

std::string drag_fit_svg(const std::vector<ProfileCurves>& specimens, const std::vector<MarginalCurve>& marginals,
                         bool is_virtual) {
  INCISE_REQUIRE(!specimens.empty(), "expected at least one specimen");
  Bounds bounds;
  for (const ProfileCurves& curves : specimens) {
    INCISE_REQUIRE(curves.photographed_mm.size() >= 2 && curves.fitted_mm.size() == curves.photographed_mm.size(),
                   fmt::format("{}: expected as many fitted as photographed errors, at least 2", curves.name));
    INCISE_REQUIRE(curves.simulated_mm.empty() || curves.simulated_mm.size() == curves.fitted_mm.size(),
                   fmt::format("{}: expected as many simulated as fitted errors", curves.name));
    for (const auto* list : {&curves.photographed_mm, &curves.fitted_mm, &curves.simulated_mm}) bounds.take(*list);
  }
  bounds = {bounds.low - 0.2, bounds.high + 0.2};
  constexpr double kColumn = kPanelWidth + kPanelLeft + 24.0;
  constexpr double kRow = kPanelHeight + 76.0;
  const double rows = std::ceil(0.5 * static_cast<double>(specimens.size()));
  const double width = 2.0 * kColumn;
  const double height = 70.0 + rows * kRow + 0.7 * kPanelHeight + 50.0;
  SvgWriter svg(width, height, "Fit of the drag length",
                "Photographed and fitted signed errors round the ring, and the posterior's marginals");
  svg.text({0.5 * width, 20.0}, "Signed error of the inner edge, photographed and fitted" + virtual_note(is_virtual),
           "middle", "font-weight=\"600\" font-size=\"13\"");
  draw_fit_legend(svg, 40.0);
  for (std::size_t i = 0; i < specimens.size(); ++i) {
    const Vec2 corner(kPanelLeft + kColumn * static_cast<double>(i % 2),
                      76.0 + kRow * std::floor(0.5 * static_cast<double>(i)));
    draw_specimen(svg, specimens[i], corner, bounds);
  }
  const auto count = static_cast<double>(marginals.size());
  for (std::size_t i = 0; i < marginals.size(); ++i) {
    const double step = (width - 40.0) / count;
    draw_marginal(svg, marginals[i], {30.0 + step * static_cast<double>(i), 70.0 + rows * kRow}, step - 30.0);
  }
  return svg.finish();
}

}  // namespace incise
