#include "imaging/line_tracing.hpp"

#include <incise/core/error.hpp>
#include <incise/imaging/marked_line.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace incise {
namespace imaging_detail {
namespace {

constexpr double kPointStepPx = 2.0;  // between the points of a line
constexpr double kLeastDiscPx = 2.0;
constexpr double kDiscOfGap = 0.65;         // radius of the rolling disc over the gap that it must not pass
constexpr double kWidestHiddenMm = 8.0;     // a painted band that crosses the other line hides at most this much of it
constexpr double kLeastRingRadiusMm = 0.6;  // the inside of a tumour of 2 mm with a line of 12 pixels
constexpr double kLeastLineMm = 3.0;        // a ring too small to be a tumour passes: it is refused later
constexpr double kGapToleranceMm = 0.18;    // uncertainty of a gap's length: its ends are blurred,
constexpr double kGapTolerancePx = 2.0;     // and the points of the line are this far apart
constexpr int kPasses = 4;

struct Start {
  Line line;
  bool is_ring = false;
};

[[noreturn]] void refuse(const std::filesystem::path& name, const std::string& found, const std::string& expected,
                         const std::string& hint = "") {
  throw DataError(name, "", found, expected, hint);
}

void require_one_ring(const RollingResult& rolled, InkColor color, double mm_per_pixel,
                      const std::filesystem::path& name) {
  if (rolled.rings < 2) return;
  const std::string sizes = fmt::format("{:.1f} and {:.1f} mm across", 2.0 * rolled.radius_px * mm_per_pixel,
                                        2.0 * rolled.second_radius_px * mm_per_pixel);
  if (rolled.rings_touch) {
    refuse(name, fmt::format("a {} line that crosses itself (it encloses places {})", to_string(color), sizes),
           "one simple ring");
  }
  refuse(name, fmt::format("{} {} rings ({})", rolled.rings, to_string(color), sizes), "one",
         color == InkColor::Green ? "Two tumours? Cut the picture so that it shows one."
                                  : "Cut the picture so that it shows one incision.");
}

/// Returns the ring that the ink encloses, tried with wider and wider discs or, if there is none, the longest line.
Start start_of(const cv::Mat& mask, InkColor color, const LineSettings& settings, const std::filesystem::path& name) {
  const double gap_px = std::max(settings.max_gap_mm, 0.3) / settings.mm_per_pixel;
  std::array<double, 3> discs{std::max(kLeastDiscPx, kDiscOfGap * gap_px),
                              std::max(2.0 * kLeastDiscPx, 2.0 * kDiscOfGap * gap_px),
                              std::max(4.0 * kLeastDiscPx, 4.0 * kDiscOfGap * gap_px)};
  const double bridge_px = discs.front();
  // The opening of a band may be narrow only at its outer end: a disc that enters it would follow its walls as the
  // border.
  if (settings.edge == LineEdge::Inner) std::swap(discs[0], discs[1]);
  // A disc as large as the picture cannot roll, and a picture with a rim for it might not fit into memory.
  const double largest = 0.5 * std::max(mask.cols, mask.rows);
  if (bridge_px > largest) {
    refuse(name, fmt::format("a picture {:.3g} mm wide", mask.cols * settings.mm_per_pixel),
           fmt::format("one much wider than the largest gap, {} mm", settings.max_gap_mm), "Is the scale right?");
  }
  for (double& disc : discs) disc = std::min(disc, largest);
  const std::optional<MaskWindow> window = window_of(mask, static_cast<int>(discs.back()) + 3);
  if (!window) return {};
  const double extent = 0.5 * std::max(window->mask.cols, window->mask.rows) - discs.back();
  RollingResult best;
  for (const double disc : discs) {
    const RollingResult rolled = roll_inside(*window, disc);
    if (rolled.inner_border.size() < 8 || rolled.radius_px * settings.mm_per_pixel < kLeastRingRadiusMm) continue;
    // A wider disc counts only if the narrower ones found nothing but small loops.
    if (rolled.radius_px < 2.0 * best.radius_px) continue;
    best = rolled;
    require_one_ring(rolled, color, settings.mm_per_pixel, name);
    if (rolled.radius_px > 0.5 * extent) break;
  }
  if (!best.inner_border.empty()) return {best.inner_border, true};
  return {longest_way(*window, bridge_px), false};
}

RefinedLine refined(Start& start, const InkMap& map, const cv::Mat& mask, const cv::Mat& glare,
                    const LineSettings& settings) {
  const double length = length_px(start.line, start.is_ring);
  const double band = std::max(2.0, cv::countNonZero(mask) / length);
  RefineSettings pass{.edge = settings.edge, .width_px = band, .reach_px = 0.0, .reject_outliers = false};
  if (settings.edge == LineEdge::Inner && !start.is_ring) {  // the way runs along the middle of the band
    for (std::size_t i = 0; i < start.line.size(); ++i)
      start.line[i] -= 0.5 * band * outward(tangent_at(start.line, false, i, 8));
  }
  RefinedLine result{resampled(start.line, start.is_ring, kPointStepPx), {}, band};
  for (int k = 0; k < kPasses; ++k) {
    pass.reach_px = settings.edge == LineEdge::Inner ? (k < 2 ? 20.0 : 14.0)
                                                     : (k < 2 ? 1.3 * band + 8.0 : 0.8 * result.width_px + 6.0);
    pass.reject_outliers = k >= 2;
    if (k > 0) result.points = resampled(result.points, start.is_ring, kPointStepPx);
    result = refine(result.points, start.is_ring, map.likelihood, glare, pass);
    smooth(result.points, start.is_ring, k + 1 < kPasses ? 4 : 2);
    if (settings.edge == LineEdge::Middle && result.width_px > 0.0) pass.width_px = result.width_px;
  }
  return result;
}

/// A run of unseen points. On a ring it may pass the start.
struct Run {
  std::size_t first = 0;
  std::size_t count = 0;
};
std::vector<Run> unseen_runs(const std::vector<bool>& is_seen, bool is_closed) {
  const std::size_t n = is_seen.size();
  std::vector<Run> runs;
  std::size_t begin = 0;
  if (is_closed) {  // start at a seen point
    begin = static_cast<std::size_t>(std::find(is_seen.begin(), is_seen.end(), true) - is_seen.begin());
    if (begin == n) return {{0, n}};
  }
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = (begin + k) % n;
    if (is_seen[i]) continue;
    const bool continues = k > 0 && !is_seen[(i + n - 1) % n] && !runs.empty();
    if (continues) {
      ++runs.back().count;
    } else {
      runs.push_back({i, 1});
    }
  }
  return runs;
}

LineGap gap_of(const Run& run, const Line& line, const cv::Mat& hidden, const cv::Mat& glare, double mm_per_pixel) {
  const std::size_t n = line.size();
  LineGap gap{.from_px = line[run.first], .to_px = line[(run.first + run.count - 1) % n]};
  double length = kPointStepPx;
  std::size_t under = 0, burnt = 0;
  for (std::size_t k = 0; k < run.count; ++k) {
    const Vec2& p = line[(run.first + k) % n];
    if (k > 0) length += (p - line[(run.first + k - 1) % n]).norm();
    under += covers(hidden, p) ? 1 : 0;
    burnt += covers(glare, p) ? 1 : 0;
  }
  gap.length_mm = length * mm_per_pixel;
  gap.is_hidden = 2 * under >= run.count && gap.length_mm <= kWidestHiddenMm;
  gap.is_glare = 2 * burnt >= run.count;
  return gap;
}

void open_behind(Line& line, const Run& gap) {
  const std::size_t n = line.size();
  Line open;
  for (std::size_t k = gap.count; k < n; ++k) open.push_back(line[(gap.first + k) % n]);
  line = open;
}

void trim_unseen_ends(RefinedLine& line) {
  const auto first = std::find(line.is_seen.begin(), line.is_seen.end(), true) - line.is_seen.begin();
  const auto last = line.is_seen.rend() - std::find(line.is_seen.rbegin(), line.is_seen.rend(), true);
  if (first >= last) {
    line = {};
    return;
  }
  line.points = Line(line.points.begin() + first, line.points.begin() + last);
  line.is_seen = std::vector<bool>(line.is_seen.begin() + first, line.is_seen.begin() + last);
}

}  // namespace

MarkedLine trace_marked_line(const InkMap& map, const cv::Mat& mask, const cv::Mat& glare, const cv::Mat& hidden,
                             InkColor color, const LineSettings& settings, const std::filesystem::path& name) {
  const std::string none = fmt::format("no {} line", to_string(color));
  const std::string expected = fmt::format("a {} line on the tissue", to_string(color));
  if (!map.is_present) {
    refuse(name,
           fmt::format("{} (the strongest {} is {:.3f} above its surroundings)", none, to_string(color), map.contrast),
           expected,
           fmt::format("Brown, black and faint lines are not detected: draw the line {} and thicker.",
                       color == InkColor::Red ? "bright red" : "bright green"));
  }
  Start start = start_of(mask, color, settings, name);
  if (start.line.size() < 2 || length_px(start.line, start.is_ring) * settings.mm_per_pixel < kLeastLineMm) {
    refuse(name, fmt::format("{} longer than {} mm", none, kLeastLineMm), expected, "Is the scale right?");
  }
  RefinedLine line = refined(start, map, mask, glare, settings);
  if (!start.is_ring) trim_unseen_ends(line);
  if (line.points.size() < 4) refuse(name, fmt::format("{}, only spots", none), expected);

  MarkedLine result{
      .points_px = line.points, .is_closed = start.is_ring, .width_px = line.width_px, .contrast = map.contrast};
  std::vector<Run> runs = unseen_runs(line.is_seen, start.is_ring);
  std::stable_sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.count > b.count; });
  result.gap_tolerance_mm = kGapToleranceMm + kGapTolerancePx * settings.mm_per_pixel;
  const double allowed_mm = settings.max_gap_mm + result.gap_tolerance_mm;
  std::optional<Run> opening;
  for (const Run& run : runs) {
    const LineGap gap = gap_of(run, line.points, hidden, glare, settings.mm_per_pixel);
    if (run.count > 1) result.gaps.push_back(gap);
    if (!gap.is_hidden) result.longest_unseen_mm = std::max(result.longest_unseen_mm, gap.length_mm);
    if (!opening && !gap.is_hidden && gap.length_mm > allowed_mm) opening = run;
  }
  if (start.is_ring && opening) {
    result.is_closed = false;
    open_behind(result.points_px, *opening);
  }
  if (!start.is_ring) {
    const double across = (line.points.front() - line.points.back()).norm() * settings.mm_per_pixel;
    result.gaps.push_back({.from_px = line.points.back(), .to_px = line.points.front(), .length_mm = across});
    result.longest_unseen_mm = std::max(result.longest_unseen_mm, across);
  }
  std::stable_sort(result.gaps.begin(), result.gaps.end(),
                   [](const LineGap& a, const LineGap& b) { return a.length_mm > b.length_mm; });
  return result;
}

}  // namespace imaging_detail

std::optional<Vec2> end_at_rim_px(const MarkedLine& line, int width_px, int height_px) {
  if (line.is_closed || line.points_px.empty()) return std::nullopt;
  const double near = 6.0 + line.width_px;
  for (const Vec2& end : {line.points_px.front(), line.points_px.back()}) {
    if (end.x() < near || end.y() < near || end.x() > width_px - 1 - near || end.y() > height_px - 1 - near) return end;
  }
  return std::nullopt;
}

double MarkedLine::max_gap_mm() const {
  double longest = 0.0;
  for (const LineGap& gap : gaps) {
    if (!gap.is_hidden) longest = std::max(longest, gap.length_mm);
  }
  return longest;
}

MarkedLine find_marked_line(const ColorPicture& picture, InkColor color, const LineSettings& settings,
                            const std::filesystem::path& name) {
  INCISE_REQUIRE(settings.mm_per_pixel > 0.0 && std::isfinite(settings.mm_per_pixel),
                 fmt::format("expected mm_per_pixel above 0, found {}", settings.mm_per_pixel));
  INCISE_REQUIRE(settings.max_gap_mm >= 0.0 && std::isfinite(settings.max_gap_mm),
                 fmt::format("expected max_gap_mm of 0 or more, found {}", settings.max_gap_mm));
  imaging_detail::hold_opencv_threads();
  const imaging_detail::InkStrengths strengths = imaging_detail::ink_strengths(picture);
  const imaging_detail::InkMap map = imaging_detail::ink_map(strengths, color, settings.mm_per_pixel);
  return imaging_detail::trace_marked_line(map, map.is_present ? imaging_detail::ink_mask(map) : cv::Mat(),
                                           strengths.glare, {}, color, settings, name);
}

}  // namespace incise
