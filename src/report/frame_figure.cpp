#include "report/line_kinds.hpp"
#include "report/snapshot.hpp"
#include "report/svg.hpp"

#include <incise/report/html_report.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise {
namespace {

constexpr double kHeadPx = 44.0;
constexpr double kFootPx = 78.0;
constexpr double kLongBarMm = 10.0;
constexpr double kLetterPx = 6.6;  // wide enough for any sans-serif face of this size

struct Entry {
  std::string color;
  std::string label;
  bool is_line = false;
};

std::vector<Entry> legend_of(const ReportAnimation& animation, const ReportFrame& frame) {
  std::vector<Entry> entries;
  const auto is_kerf = [](std::uint8_t flag) { return flag != 0; };
  if (!std::all_of(frame.is_kerf.begin(), frame.is_kerf.end(), is_kerf))
    entries.push_back({hex_color(still::kTissue), "tissue"});
  if (std::any_of(frame.is_kerf.begin(), frame.is_kerf.end(), is_kerf))
    entries.push_back({hex_color(still::kKerf), "kerf"});
  if (frame.tool_tip_mm) entries.push_back({hex_color(still::kSteel), "needle"});
  for (const ReportLine& line : animation.lines)
    entries.push_back({std::string(look_of(line.kind).color), std::string(look_of(line.kind).label), true});
  return entries;
}

void draw_legend(SvgWriter& svg, const std::vector<Entry>& entries, Vec2 at, double width_px) {
  const double left = at.x();
  for (const Entry& entry : entries) {
    const double width = 46.0 + kLetterPx * static_cast<double>(entry.label.size());
    if (at.x() + width > width_px) at = {left, at.y() + 18.0};
    if (entry.is_line) {
      svg.line(at, at + Vec2(20.0, 0.0), fmt::format("stroke=\"{}\" stroke-width=\"3.2\"", entry.color));
    } else {
      svg.rectangle(at - Vec2(0.0, 6.0), {20.0, 12.0},
                    fmt::format("fill=\"{}\" stroke=\"#333\" stroke-width=\"0.6\"", entry.color));
    }
    svg.text(at + Vec2(26.0, 4.0), entry.label, "start", "font-size=\"12\"");
    at.x() += width;
  }
}

}  // namespace

std::string frame_figure_svg(const ReportAnimation& animation, std::size_t frame, const Vec3& approach, int width_px,
                             int height_px) {
  const std::string picture = frame_png(animation, frame, approach, width_px, height_px);
  const ReportFrame& moment = animation.frames[frame];
  const double px_per_mm = frame_px_per_mm(animation, frame, approach, width_px, height_px);
  const double height = kHeadPx + height_px + kFootPx;
  const std::string title = fmt::format("{} (simulated)", animation.name);
  SvgWriter svg(width_px, height, title,
                fmt::format("Obliquely from above, without perspective; {}, {:.2f} s after the tool began to plunge.",
                            moment.phase.empty() ? "a moment of the cut" : moment.phase, moment.time_s));
  svg.text({16.0, 26.0}, title, "start", "font-size=\"15\" font-weight=\"600\"");
  svg.image({0.0, kHeadPx}, {static_cast<double>(width_px), static_cast<double>(height_px)}, png_data_uri(picture));
  const double bar_px = kLongBarMm * px_per_mm;
  const Vec2 bar(16.0, kHeadPx + height_px + 18.0);
  svg.line(bar, bar + Vec2(bar_px, 0.0), "stroke=\"#111\" stroke-width=\"3\"");
  svg.text(bar + Vec2(bar_px + 6.0, 4.0), fmt::format("{} mm, across the line of sight", number_text(kLongBarMm)),
           "start", "font-size=\"12\"");
  draw_legend(svg, legend_of(animation, moment), {16.0, kHeadPx + height_px + 42.0}, width_px);
  return svg.finish();
}

}  // namespace incise
