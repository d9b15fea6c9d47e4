#include "report/plot.hpp"
#include "report/svg.hpp"

#include <incise/core/error.hpp>
#include <incise/report/figures.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise {
namespace {

constexpr double kPictureWidth = 400.0;
constexpr double kPictureHeight = 424.0;
constexpr double kEdge = 14.0;  // between text and the figure's border
constexpr double kShortBarMm = 5.0;
constexpr std::string_view kText = "font-size=\"12.5\"";  // a phone shows the figure at 0.9 of its size
constexpr std::string_view kTumorStroke = "stroke-width=\"2.6\" stroke-linejoin=\"round\"";
constexpr std::string_view kIntendedStroke = "stroke-width=\"1.6\" stroke-linejoin=\"round\"";
constexpr std::string_view kCorrectedStroke = "stroke-width=\"1.8\" stroke-dasharray=\"6 3\" stroke-linejoin=\"round\"";

/// Map from the picture plane, in mm, to the page, in px; y of the view points up.
struct Picture {
  ViewFrame view;
  Vec2 center_mm = Vec2::Zero();
  Vec2 center_px = Vec2::Zero();
  double px_per_mm = 1.0;

  [[nodiscard]] Vec2 at(const Vec3& p) const {
    const Vec3 q = view.to_view(p);
    return {center_px.x() + px_per_mm * (q.x() - center_mm.x()), center_px.y() - px_per_mm * (q.y() - center_mm.y())};
  }
  [[nodiscard]] std::vector<Vec2> at(const Contour& contour) const {
    std::vector<Vec2> points;
    for (const Vec3& p : contour.points) points.push_back(at(p));
    return points;
  }
};

Picture picture_of(const ReportIncision& incision, const FigureStyle& style, const Vec2& corner, const Vec2& size) {
  Picture picture{.view = view_along(style.approach)};
  Eigen::AlignedBox2d box;
  for (const Vec3& p : style.shown_mm) box.extend(Vec2(picture.view.to_view(p).head<2>()));
  for (const Contour* contour :
       {&incision.tumor_edge, &incision.intended_path, &incision.corrected_path, &incision.incision}) {
    for (const Vec3& p : contour->points) box.extend(Vec2(picture.view.to_view(p).head<2>()));
  }
  const Vec2 extent = box.sizes().cwiseMax(1.0);
  picture.center_mm = box.center();
  picture.center_px = corner + 0.5 * size;
  picture.px_per_mm = std::min(size.x() / extent.x(), size.y() / extent.y());
  return picture;
}

void draw_path(SvgWriter& svg, const Picture& picture, const Contour& path, std::string_view color,
               std::string_view more) {
  if (path.points.size() < 2) return;
  svg.polyline(picture.at(path), path.is_closed, fmt::format("fill=\"none\" stroke=\"{}\" {}", color, more));
}

/// Draws one broad stroke along each run of points that are too close or have reached the edge.
void draw_marks(SvgWriter& svg, const std::vector<Vec2>& points, const ReportIncision& incision) {
  const std::size_t n = points.size();
  const bool is_closed = incision.incision.is_closed;
  const auto color_of = [&](std::size_t i) {
    const double error = incision.signed_error_mm[i];
    return error > incision.close_error_mm()      ? std::string_view()
           : error <= incision.reached_error_mm() ? ink::kReached
                                                  : ink::kTooClose;
  };
  const auto draw = [&](const std::vector<Vec2>& line, std::string_view color, bool is_ring) {
    svg.polyline(line, is_ring,
                 fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"13\" stroke-linejoin=\"round\"", color));
  };
  // On a ring, the search for runs starts where the mark changes.
  std::size_t start = 0;
  while (is_closed && start < n && color_of(start) == color_of((start + n - 1) % n)) ++start;
  if (start == n) {
    if (!color_of(0).empty()) draw(points, color_of(0), true);
    return;
  }
  for (std::size_t k = 0; k < n;) {
    const std::size_t first = (start + k) % n;
    const std::string_view color = color_of(first);
    std::vector<Vec2> line;
    if (is_closed || first > 0) line.push_back(0.5 * (points[(first + n - 1) % n] + points[first]));
    std::size_t i = first;
    for (; k < n && color_of((start + k) % n) == color; ++k) line.push_back(points[i = (start + k) % n]);
    if (is_closed || i + 1 < n) line.push_back(0.5 * (points[i] + points[(i + 1) % n]));
    if (!color.empty() && line.size() > 1) draw(line, color, false);
  }
}

/// Each point's half segments carry its colour; broad strokes below mark what is too close or has reached the edge.
void draw_incision(SvgWriter& svg, const Picture& picture, const ReportIncision& incision, double limit_mm,
                   ErrorColors colors) {
  const std::vector<Vec2> points = picture.at(incision.incision);
  const std::size_t n = points.size();
  const bool is_closed = incision.incision.is_closed;
  draw_marks(svg, points, incision);
  svg.polyline(points, is_closed, "fill=\"none\" stroke=\"#333\" stroke-width=\"6\" stroke-linejoin=\"round\"");
  for (std::size_t i = 0; i < n; ++i) {
    // Each piece runs on under the next one, so that no seam shows between them.
    std::vector<Vec2> line;
    if (is_closed || i > 0) line.push_back(0.5 * (points[(i + n - 1) % n] + points[i]));
    line.push_back(points[i]);
    if (is_closed || i + 1 < n) line.push_back(points[(i + 1) % n]);
    const std::string color = hex_color(error_color(incision.signed_error_mm[i] / limit_mm, colors));
    svg.polyline(line, false,
                 fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"4.4\" stroke-linejoin=\"round\"", color));
  }
}

void draw_color_bar(SvgWriter& svg, const Vec2& corner, const Vec2& size, double limit_mm, ErrorColors colors) {
  constexpr int kSteps = 60;
  for (int k = 0; k < kSteps; ++k) {
    const double share = 2.0 * (k + 0.5) / kSteps - 1.0;
    svg.rectangle(corner + Vec2(size.x() * k / kSteps, 0.0), {size.x() / kSteps + 0.6, size.y()},
                  fmt::format("fill=\"{}\" shape-rendering=\"crispEdges\"", hex_color(error_color(share, colors))));
  }
  svg.rectangle(corner, size, "fill=\"none\" stroke=\"#333\" stroke-width=\"0.8\"");
  const double bottom = corner.y() + size.y();
  for (const double tick : round_ticks(-limit_mm, limit_mm, 6)) {
    const double x = corner.x() + size.x() * 0.5 * (1.0 + tick / limit_mm);
    svg.line({x, bottom}, {x, bottom + 4.0}, "stroke=\"#333\"");
    svg.text({x, bottom + 17.0}, number_text(tick), "middle", kText);
  }
  svg.text({corner.x(), bottom + 34.0}, "closer", "start", kText);
  svg.text({corner.x() + 0.5 * size.x(), bottom + 34.0}, "error, mm", "middle", kText);
  svg.text({corner.x() + size.x(), bottom + 34.0}, "farther", "end", kText);
}

/// The name of the axis end that points nearly along a picture direction; empty: none does.
std::string end_name(const Vec3& direction, const std::array<std::string, 6>& names) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(2 * axis);
    if (direction[axis] > 0.9) return names[k + 1];
    if (direction[axis] < -0.9) return names[k];
  }
  return "";
}

void draw_orientation(SvgWriter& svg, const ViewFrame& view, const Vec2& at, const std::array<std::string, 6>& names) {
  constexpr double kArm = 13.0;
  constexpr std::string_view kStyle = "stroke=\"#777\" stroke-width=\"1.2\"";
  svg.line(at - Vec2(kArm, 0.0), at + Vec2(kArm, 0.0), kStyle);
  svg.line(at - Vec2(0.0, kArm), at + Vec2(0.0, kArm), kStyle);
  svg.text(at + Vec2(kArm + 4.0, 4.0), end_name(view.x, names), "start", kText);
  svg.text(at - Vec2(kArm + 4.0, -4.0), end_name(-view.x, names), "end", kText);
  svg.text(at - Vec2(0.0, kArm + 5.0), end_name(view.y, names), "middle", kText);
  svg.text(at + Vec2(0.0, kArm + 13.0), end_name(-view.y, names), "middle", kText);
}

struct LegendEntry {
  std::string style;
  std::string label;
};

void draw_legend_row(SvgWriter& svg, const std::vector<LegendEntry>& entries, Vec2 at) {
  for (const LegendEntry& entry : entries) {
    svg.line(at, at + Vec2(20.0, 0.0), entry.style);
    svg.text(at + Vec2(25.0, 4.0), entry.label, "start", kText);
    at.x() += 35.0 + 7.1 * static_cast<double>(entry.label.size());  // wide enough for any sans-serif face
  }
}

/// Paths in one row, marks in the next.
void draw_legend(SvgWriter& svg, const ReportIncision& incision, const Vec2& corner) {
  std::vector<LegendEntry> paths;
  const auto add = [&](const Contour& path, std::string_view color, std::string_view more, const char* label) {
    if (!path.points.empty()) paths.push_back({fmt::format("stroke=\"{}\" {}", color, more), label});
  };
  add(incision.tumor_edge, ink::kTumorEdge, kTumorStroke, "tumour edge");
  add(incision.intended_path, ink::kIntended, kIntendedStroke, "intended path");
  add(incision.corrected_path, ink::kCorrected, kCorrectedStroke, "corrected path");
  draw_legend_row(svg, paths, corner);
  const std::string close = fmt::format("closer than {} mm", number_text(incision.close_margin_mm));
  draw_legend_row(svg,
                  {{fmt::format("stroke=\"{}\" stroke-width=\"9\"", ink::kTooClose), close},
                   {fmt::format("stroke=\"{}\" stroke-width=\"9\"", ink::kReached), "tumour edge reached"}},
                  corner + Vec2(0.0, 20.0));
}

std::string description_of(const ReportIncision& incision) {
  const auto [low, high] = std::minmax_element(incision.signed_error_mm.begin(), incision.signed_error_mm.end());
  return fmt::format(
      "{} points of the {}; mean absolute error {} mm; signed error from {} to {} mm against a target of {} mm.",
      incision.signed_error_mm.size(), incision.measured_contour.empty() ? "incision" : incision.measured_contour,
      number_text(incision.mean_abs_error_mm), number_text(*low), number_text(*high), number_text(incision.target_mm));
}

}  // namespace

FigureStyle common_style(std::span<const ReportIncision> incisions, const Vec3& approach,
                         const std::array<std::string, 6>& axis_names) {
  FigureStyle style{.error_limit_mm = common_error_limit_mm(incisions),
                    .approach = approach,
                    .axis_names = axis_names,
                    .shown_mm = {}};
  for (const ReportIncision& incision : incisions) {
    for (const Contour* contour :
         {&incision.tumor_edge, &incision.intended_path, &incision.corrected_path, &incision.incision}) {
      style.shown_mm.insert(style.shown_mm.end(), contour->points.begin(), contour->points.end());
    }
  }
  return style;
}

std::string contour_figure_svg(const ReportIncision& incision, const FigureStyle& style) {
  require_drawable(incision);
  const double limit_mm = error_limit_of(style, {&incision, 1});
  SvgWriter svg(kPictureWidth, kPictureHeight, fmt::format("{}: contours seen along the approach", incision.name),
                description_of(incision));
  svg.text({kEdge, 24.0}, incision.name, "start", "font-size=\"15\" font-weight=\"600\"");
  svg.text({kEdge, 42.0}, fmt::format("mean |error| {:.2f} mm", incision.mean_abs_error_mm), "start", kText);

  const Picture picture = picture_of(incision, style, {30.0, 60.0}, {340.0, 246.0});
  draw_path(svg, picture, incision.tumor_edge, ink::kTumorEdge, kTumorStroke);
  draw_incision(svg, picture, incision, limit_mm, style.colors);
  draw_path(svg, picture, incision.intended_path, ink::kIntended, kIntendedStroke);
  draw_path(svg, picture, incision.corrected_path, ink::kCorrected, kCorrectedStroke);
  if (!incision.intended_path.points.empty()) {
    const Vec2 start = picture.at(incision.intended_path.points.front());
    svg.circle(start, 4.5, "fill=\"#fff\" stroke=\"#111\" stroke-width=\"1.6\"");
    svg.text(start + Vec2(0.0, -9.0), "start", "middle",
             "font-size=\"12.5\" stroke=\"#fff\" stroke-width=\"3\" paint-order=\"stroke\"");
  }
  draw_orientation(svg, picture.view, {364.0, 36.0}, style.axis_names);

  const double bar_px = kShortBarMm * picture.px_per_mm;
  svg.line({kEdge, 336.0}, {kEdge + bar_px, 336.0}, "stroke=\"#111\" stroke-width=\"3\"");
  svg.text({kEdge, 354.0}, fmt::format("{} mm", number_text(kShortBarMm)), "start", kText);
  draw_color_bar(svg, {146.0, 324.0}, {236.0, 12.0}, limit_mm, style.colors);
  draw_legend(svg, incision, {kEdge, 390.0});
  return svg.finish();
}

}  // namespace incise
