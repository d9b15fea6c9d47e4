#include "report/plot.hpp"
#include "report/svg.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/contour.hpp>
#include <incise/report/registration_figure.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr double kViewWidth = 860.0;
constexpr double kViewHeight = 470.0;
constexpr std::size_t kMostPointsDrawn = 3000;
constexpr std::string_view kTargetColor = "#6b6b6b";
constexpr std::string_view kSourceColor = "#0072b2";

/// Points of one cloud in the picture plane of a view, as one path of dots.
std::string dots(const Points& points, const ViewFrame& view, bool from_side, const PlotArea& area) {
  const std::size_t step = std::max<std::size_t>(1, points.size() / kMostPointsDrawn);
  std::string data;
  for (std::size_t i = 0; i < points.size(); i += step) {
    const Vec3 q = view.to_view(points[i]);
    const Vec2 at = area.at(q.x(), from_side ? q.z() : q.y());
    INCISE_REQUIRE(at.allFinite(), fmt::format("point {} is not finite", i));
    data += fmt::format("M{:.1f} {:.1f}h0", at.x(), at.y());
  }
  return data;
}

void draw_view(SvgWriter& svg, const RegistrationFigure& figure, const ViewFrame& view, bool from_side,
               const Vec2& corner, const Vec2& size) {
  Eigen::AlignedBox2d box;
  for (const Points* cloud : {&figure.target_mm, &figure.moved_source_mm}) {
    for (const Vec3& p : *cloud) {
      const Vec3 q = view.to_view(p);
      box.extend(Vec2(q.x(), from_side ? q.z() : q.y()));
    }
  }
  const double mm_per_px = std::max({box.sizes().x() / size.x(), box.sizes().y() / size.y(), 1e-9});
  const Vec2 half = 0.5 * mm_per_px * size;
  const PlotArea area{corner,
                      size,
                      box.center().x() - half.x(),
                      box.center().x() + half.x(),
                      box.center().y() - half.y(),
                      box.center().y() + half.y()};
  constexpr std::string_view kDot =
      "fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\" stroke-linecap=\"round\" stroke-opacity=\"0.55\"";
  svg.path(dots(figure.target_mm, view, from_side, area), fmt::format(kDot, kTargetColor));
  svg.path(dots(figure.moved_source_mm, view, from_side, area), fmt::format(kDot, kSourceColor));
  const double bar_mm = rounded_up(0.1 * 2.0 * half.x());
  const Vec2 at = corner + Vec2(0.0, size.y() + 8.0);
  svg.line(at, at + Vec2(bar_mm / mm_per_px, 0.0), "stroke=\"#111\" stroke-width=\"2\"");
  svg.text(at + Vec2(bar_mm / mm_per_px + 6.0, 4.0), number_text(bar_mm) + " mm", "start", "font-size=\"12\"");
}

void draw_histogram(SvgWriter& svg, const std::vector<double>& residuals, const Vec2& corner, const Vec2& size) {
  constexpr std::size_t kBins = 41;
  std::vector<double> sizes;
  for (const double r : residuals) {
    INCISE_REQUIRE(std::isfinite(r), "a residual is not finite");
    sizes.push_back(std::abs(r));
  }
  std::sort(sizes.begin(), sizes.end());
  // Leaves out the largest 2 %; the outermost bars count them.
  const double limit = rounded_up(std::max(1e-6, sizes[sizes.size() * 98 / 100]));
  std::vector<double> counts(kBins, 0.0);
  for (const double r : residuals) {
    const double place = std::clamp((r / limit + 1.0) / 2.0 * kBins, 0.0, kBins - 1.0);
    counts[static_cast<std::size_t>(place)] += 100.0 / static_cast<double>(residuals.size());
  }
  const double top = *std::max_element(counts.begin(), counts.end());
  const PlotArea area{corner, size, -limit, limit, 0.0, 1.08 * top};
  draw_y_axis(svg, area, round_ticks(0.0, 1.08 * top, 5), "points, %");
  draw_x_axis(svg, area, round_ticks(-limit, limit, 5), "distance along the normal, mm");
  for (std::size_t k = 0; k < kBins; ++k) {
    const double from = -limit + 2.0 * limit * static_cast<double>(k) / kBins;
    const Vec2 upper = area.at(from, counts[k]);
    const Vec2 lower = area.at(from + 2.0 * limit / kBins, 0.0);
    svg.rectangle(upper, {std::max(0.5, lower.x() - upper.x() - 1.0), std::max(0.0, lower.y() - upper.y())},
                  fmt::format("fill=\"{}\"", kSourceColor));
  }
}

}  // namespace

std::string registration_figure_svg(const RegistrationFigure& figure) {
  INCISE_REQUIRE(!figure.target_mm.empty() && !figure.moved_source_mm.empty(), "expected points of both clouds");
  const ViewFrame view = view_along(figure.approach);
  SvgWriter svg(kViewWidth, kViewHeight, figure.title,
                fmt::format("{} Target: {} points, source: {} points.", figure.subtitle, figure.target_mm.size(),
                            figure.moved_source_mm.size()));
  svg.text({16.0, 26.0}, figure.title, "start", "font-size=\"15\" font-weight=\"600\"");
  svg.text({16.0, 44.0}, figure.subtitle, "start", "fill=\"#555\"");
  svg.text({16.0, 66.0}, "target", "start", fmt::format("font-size=\"12\" fill=\"{}\"", kTargetColor));
  svg.text({70.0, 66.0}, "source, moved", "start", fmt::format("font-size=\"12\" fill=\"{}\"", kSourceColor));
  draw_view(svg, figure, view, false, {16.0, 78.0}, {400.0, 240.0});
  draw_view(svg, figure, view, true, {16.0, 350.0}, {400.0, 90.0});
  if (!figure.residuals_mm.empty()) draw_histogram(svg, figure.residuals_mm, {500.0, 90.0}, {330.0, 290.0});
  return svg.finish();
}

}  // namespace incise
