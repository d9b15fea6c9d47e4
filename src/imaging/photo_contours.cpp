#include "imaging/odd_stretch.hpp"
#include "imaging/photo_checks.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/contour_checks.hpp>
#include <incise/imaging/photo_contours.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr double kLargestBloodMm = 3.0;    // a longer red mark in the tumour is neither blood nor noise
constexpr double kGreenerThanGrey = 0.08;  // strength of true green: rims of paper, cloth and char are grey
constexpr double kRimOfCoverPx = 4.0;      // a line's blur hides a little more than its mask

Contour in_plane(const MarkedLine& line, const PhotoScale& scale) {
  Contour contour{.points = {}, .is_closed = line.is_closed};
  for (const Vec2& p : line.points_px) {
    const Vec2 q = scale.plane_mm(p);
    contour.points.emplace_back(q.x(), q.y(), 0.0);
  }
  if (!contour.is_closed) return contour;
  return start_farthest_along(counter_clockwise(contour, -Vec3::UnitZ()), Vec3::UnitY());
}

cv::Mat widened(const cv::Mat& mask) {
  if (mask.empty()) return {};
  const int width = 2 * static_cast<int>(kRimOfCoverPx) + 1;
  cv::Mat result;
  cv::dilate(mask, result, cv::getStructuringElement(cv::MORPH_ELLIPSE, {width, width}));
  return result;
}

void require_size(const Contour& edge, const std::filesystem::path& name) {
  if (const auto problem = size_problem(edge, "a tumour", kLargestTumorMm)) {
    throw DataError(name, "", problem->found, problem->expected, "Is the scale right?");
  }
}

void require_closed(const MarkedLine& green, const std::filesystem::path& name) {
  if (!green.is_closed) {
    // Gaps are sorted: the first that is not hidden is the widest.
    const auto widest =
        std::find_if(green.gaps.begin(), green.gaps.end(), [](const LineGap& g) { return !g.is_hidden; });
    const bool is_glare = widest != green.gaps.end() && widest->is_glare;
    throw DataError(name, "",
                    fmt::format("an open tumour edge: the green line has a gap of {:.2f} mm", green.max_gap_mm()),
                    "a closed green line round the tumour",
                    is_glare ? "A highlight hides it there: light the tissue from another side." : "");
  }
}

void require_no_crossing(const Contour& contour, InkColor color, const std::filesystem::path& name) {
  const auto at = first_crossing_in_view(contour, -Vec3::UnitZ());
  if (!at) return;
  throw DataError(
      name, "",
      fmt::format("a {} line that crosses itself at x {:.2f}, y {:.2f} mm", to_string(color), at->x(), at->y()),
      "one simple curve");
}

Vec2 middle_of(const std::vector<Vec2>& points) {
  Vec2 sum = Vec2::Zero();
  for (const Vec2& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

}  // namespace

PhotoContours find_photo_contours(const ColorPicture& picture, const PhotoScale& scale, const PhotoSettings& settings,
                                  const std::filesystem::path& name) {
  INCISE_REQUIRE(settings.max_gap_mm >= 0.0 && std::isfinite(settings.max_gap_mm),
                 fmt::format("expected max_gap_mm of 0 or more, found {}", settings.max_gap_mm));
  using namespace imaging_detail;
  hold_opencv_threads();
  PhotoContours result;
  const InkStrengths strengths = ink_strengths(picture);
  // Scale at the middle of the picture; with perspective, lengths of gaps elsewhere are slightly wrong.
  result.mm_per_pixel = scale.mm_per_pixel({0.5 * picture.width, 0.5 * picture.height});
  const InkMap green = ink_map(strengths, InkColor::Green, result.mm_per_pixel);
  const InkMap red = ink_map(strengths, InkColor::Red, result.mm_per_pixel);
  const cv::Mat green_mask = green.is_present ? ink_mask(green) : cv::Mat();
  const cv::Mat red_mask = red.is_present ? ink_mask(red) : cv::Mat();

  LineSettings line{.edge = LineEdge::Middle, .mm_per_pixel = result.mm_per_pixel, .max_gap_mm = settings.max_gap_mm};
  result.green = trace_marked_line(green, green_mask, strengths.glare, widened(red_mask), InkColor::Green, line, name);
  const CheckedLine edge{result.green,    line.edge, InkColor::Green, green_mask, line.mm_per_pixel,
                         line.max_gap_mm, name};
  require_in_view(edge);
  result.tumor_edge = in_plane(result.green, scale);
  require_size(result.tumor_edge, name);  // first, because a wrong scale also makes gaps wrong
  require_simple(edge);
  require_nothing_else(edge);
  require_closed(result.green, name);
  require_no_crossing(result.tumor_edge, InkColor::Green, name);
  require_no_large_mark(edge, marks_beside(edge, green_mask, nullptr), kSmallestTumorMm, "beside the green ring");
  const cv::Mat truly_green = without_specks(green_mask & (strengths.green > kGreenerThanGrey), 24);
  result.green_beside = marks_beside(edge, truly_green, nullptr);
  result.mm_per_pixel = scale.mm_per_pixel(middle_of(result.green.points_px));

  line.mm_per_pixel = result.mm_per_pixel;
  line.edge = settings.red == RedLine::Kerf ? LineEdge::Inner : LineEdge::Middle;
  result.red = trace_marked_line(red, red_mask, strengths.glare, widened(green_mask), InkColor::Red, line, name);
  const CheckedLine cut{result.red, line.edge, InkColor::Red, red_mask, line.mm_per_pixel, line.max_gap_mm, name};
  require_in_view(cut);
  require_simple(cut);
  require_nothing_else(cut);
  require_no_large_mark(cut, marks_beside(cut, red_mask, &result.green.points_px), kLargestBloodMm,
                        "inside the tumour's edge");
  result.incision = in_plane(result.red, scale);
  require_no_crossing(result.incision, InkColor::Red, name);
  result.red_in_tumor = marks_beside(cut, faint_ink(red, result.green.points_px), &result.green.points_px);
  cv::Mat covered = strengths.glare.clone();
  if (!green_mask.empty()) covered |= widened(green_mask);
  result.odd_stretch = odd_stretch_of(picture, red, result.red, covered, line);
  return result;
}

ColorPicture draw_found(const ColorPicture& picture, const std::vector<const MarkedLine*>& lines,
                        const std::vector<Vec2>& ruler_marks_px) {
  constexpr int kShift = 4;  // OpenCV draws at sixteenths of a pixel
  const cv::Scalar first(0, 230, 255), others(255, 255, 255), gaps(255, 230, 0), marks(255, 0, 255);
  ColorPicture result = picture;
  for (std::uint8_t& value : result.rgb) value = static_cast<std::uint8_t>(value * 3 / 4);
  cv::Mat pixels = imaging_detail::pixels_of(result);
  const int thickness = std::max(1, std::min(picture.width, picture.height) / 900);
  const auto draw = [&](const std::vector<Vec2>& line, bool is_closed, const cv::Scalar& color) {
    std::vector<cv::Point> points;
    for (const Vec2& p : line) points.emplace_back(cvRound(p.x() * (1 << kShift)), cvRound(p.y() * (1 << kShift)));
    cv::polylines(pixels, points, is_closed, color, thickness, cv::LINE_AA, kShift);
  };
  for (std::size_t i = 0; i < lines.size(); ++i)
    draw(lines[i]->points_px, lines[i]->is_closed, i == 0 ? first : others);
  for (const MarkedLine* line : lines) {
    for (const LineGap& gap : line->gaps) draw({gap.from_px, gap.to_px}, false, gaps);
  }
  const double arm = 0.004 * std::max(picture.width, picture.height);
  for (const Vec2& p : ruler_marks_px) {
    draw({p - Vec2(arm, 0), p + Vec2(arm, 0)}, false, marks);
    draw({p - Vec2(0, arm), p + Vec2(0, arm)}, false, marks);
  }
  return result;
}

}  // namespace incise
