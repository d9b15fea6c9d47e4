#include "imaging/line_tracing.hpp"

#include <incise/core/error.hpp>
#include <incise/imaging/photo_contours.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

using imaging_detail::InkMap;

constexpr double kSmallestTumorMm = 2.0;
constexpr double kLargestTumorMm = 100.0;
constexpr double kRimOfCoverPx = 4.0;  // a line's blur hides a little more than its mask

Contour in_plane(const MarkedLine& line, const PhotoScale& scale) {
  Contour contour{.points = {}, .is_closed = line.is_closed};
  for (const Vec2& p : line.points_px) {
    const Vec2 q = scale.plane_mm(p);
    contour.points.emplace_back(q.x(), q.y(), 0.0);
  }
  if (!contour.is_closed) return contour;
  return start_farthest_along(counter_clockwise(contour, -Vec3::UnitZ()), Vec3::UnitY());
}

double extent_mm(const Contour& contour) {
  Box3 box;
  for (const Vec3& p : contour.points) box.extend(p);
  return box.sizes().maxCoeff();
}

cv::Mat widened(const cv::Mat& mask) {
  if (mask.empty()) return {};
  const int width = 2 * static_cast<int>(kRimOfCoverPx) + 1;
  cv::Mat result;
  cv::dilate(mask, result, cv::getStructuringElement(cv::MORPH_ELLIPSE, {width, width}));
  return result;
}

/// The size comes first: where the scale is wrong, so is the length of a gap.
void require_tumor(const MarkedLine& green, const Contour& edge, const std::filesystem::path& name) {
  const double extent = extent_mm(edge);
  if (extent < kSmallestTumorMm || extent > kLargestTumorMm) {
    throw DataError(name, "", fmt::format("a tumour {:.4g} mm across", extent),
                    fmt::format("{} to {} mm", kSmallestTumorMm, kLargestTumorMm), "Is the scale right?");
  }
  if (!green.is_closed) {
    // The widest gap that is not hidden is the first of them.
    const auto widest =
        std::find_if(green.gaps.begin(), green.gaps.end(), [](const LineGap& g) { return !g.is_hidden; });
    const bool is_glare = widest != green.gaps.end() && widest->is_glare;
    throw DataError(name, "",
                    fmt::format("an open tumour edge: the green line has a gap of {:.2f} mm", green.max_gap_mm()),
                    "a closed green line round the tumour",
                    is_glare ? "A highlight hides it there: light the tissue from another side." : "");
  }
}

/// A ring that is cut off by the picture's rim is not open: nobody knows.
void require_in_view(const MarkedLine& line, const char* color, const ColorPicture& picture,
                     const std::filesystem::path& name) {
  const std::optional<Vec2> end = end_at_rim_px(line, picture.width, picture.height);
  if (!end) return;
  throw DataError(
      name, "",
      fmt::format("a {} line that runs out of the picture, at pixel {:.0f}, {:.0f}", color, end->x(), end->y()),
      "the whole line in view");
}

/// Ink that the ring found does not explain: a second line, or a second loop of one that crosses itself. Specks, as
/// noise paints them in the dark, are no line.
void require_nothing_else(const MarkedLine& line, LineEdge edge, const cv::Mat& mask, const char* color,
                          const std::filesystem::path& name) {
  constexpr double kMostElse = 0.4;     // share of the ink: blood is less
  constexpr double kLeastPiece = 0.05;  // of the ring's own ink
  constexpr int kBesidePx = 12;
  if (!line.is_closed) return;
  const int reach = (edge == LineEdge::Inner ? 2 : 1) * static_cast<int>(line.width_px) + kBesidePx;
  cv::Mat elsewhere = mask.clone(), labels, stats, centers;
  std::vector<cv::Point> points;
  for (const Vec2& p : line.points_px) points.emplace_back(cvRound(p.x()), cvRound(p.y()));
  cv::polylines(elsewhere, points, true, cv::Scalar(0), reach);
  const double own = cv::countNonZero(mask) - cv::countNonZero(elsewhere);
  double other = 0.0;
  const int count = cv::connectedComponentsWithStats(elsewhere, labels, stats, centers, 8, CV_32S);
  for (int i = 1; i < count; ++i) {
    const double area = stats.at<int>(i, cv::CC_STAT_AREA);
    if (area >= kLeastPiece * own) other += area;
  }
  const double share = other / std::max(1.0, own + other);
  if (share <= kMostElse) return;
  throw DataError(name, "", fmt::format("much {0} beside the {0} ring ({1:.0f} % of it)", color, 100.0 * share),
                  "one simple ring", "A second line, or one that crosses itself? Something else of that colour?");
}

/// Pieces of ink away from the ring, longest side of each, mm: what neither blood nor the picture's grain leaves.
void require_no_marks(const MarkedLine& ring, LineEdge edge, const cv::Mat& mask, const std::vector<Vec2>* within,
                      double mm_per_pixel, const char* color, const char* place, const std::filesystem::path& name) {
  constexpr double kLongestSpeckMm = 3.0;
  constexpr int kBesidePx = 12;
  if (!ring.is_closed) return;
  cv::Mat elsewhere = mask.clone();
  const auto pixels_of_line = [](const std::vector<Vec2>& line) {
    std::vector<cv::Point> points;
    for (const Vec2& p : line) points.emplace_back(cvRound(p.x()), cvRound(p.y()));
    return points;
  };
  if (within != nullptr) {
    cv::Mat inside = cv::Mat::zeros(mask.size(), mask.type());
    cv::fillPoly(inside, std::vector<std::vector<cv::Point>>{pixels_of_line(*within)}, cv::Scalar(255));
    cv::bitwise_and(elsewhere, inside, elsewhere);
  }
  const int reach = (edge == LineEdge::Inner ? 2 : 1) * static_cast<int>(ring.width_px) + kBesidePx;
  cv::polylines(elsewhere, pixels_of_line(ring.points_px), true, cv::Scalar(0), reach);
  cv::Mat labels, stats, centers;
  const int count = cv::connectedComponentsWithStats(elsewhere, labels, stats, centers, 8, CV_32S);
  for (int i = 1; i < count; ++i) {
    const int longest = std::max(stats.at<int>(i, cv::CC_STAT_WIDTH), stats.at<int>(i, cv::CC_STAT_HEIGHT));
    const double longest_mm = longest * mm_per_pixel;
    if (longest_mm < kLongestSpeckMm) continue;
    throw DataError(name, "",
                    fmt::format("a {} mark of {:.1f} mm {}, at pixel {:.0f}, {:.0f}", color, longest_mm, place,
                                centers.at<double>(i, 0), centers.at<double>(i, 1)),
                    fmt::format("no {} there but the ring", color),
                    "A second cut or tumour? Paint over it if it is neither");
  }
}

Vec2 middle_of(const std::vector<Vec2>& points) {
  Vec2 sum = Vec2::Zero();
  for (const Vec2& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

}  // namespace

std::string_view to_string(RedLine red) {
  return red == RedLine::Annotation ? "annotation" : "kerf";
}

PhotoContours find_photo_contours(const ColorPicture& picture, const PhotoScale& scale, const PhotoSettings& settings,
                                  const std::filesystem::path& name) {
  imaging_detail::hold_opencv_threads();
  PhotoContours result;
  const imaging_detail::InkStrengths strengths = imaging_detail::ink_strengths(picture);
  // The line's scale is that of the picture's middle; with perspective, gaps elsewhere are judged a little off.
  result.mm_per_pixel = scale.mm_per_pixel({0.5 * picture.width, 0.5 * picture.height});
  const InkMap green = imaging_detail::ink_map(strengths, InkColor::Green, result.mm_per_pixel);
  const InkMap red = imaging_detail::ink_map(strengths, InkColor::Red, result.mm_per_pixel);
  const cv::Mat green_mask = green.is_present ? imaging_detail::ink_mask(green) : cv::Mat();
  const cv::Mat red_mask = red.is_present ? imaging_detail::ink_mask(red) : cv::Mat();

  LineSettings line{.edge = LineEdge::Middle, .mm_per_pixel = result.mm_per_pixel, .max_gap_mm = settings.max_gap_mm};
  result.green = imaging_detail::trace_marked_line(green, green_mask, strengths.glare, widened(red_mask),
                                                   InkColor::Green, line, name);
  require_in_view(result.green, "green", picture, name);
  require_nothing_else(result.green, line.edge, green_mask, "green", name);
  result.tumor_edge = in_plane(result.green, scale);
  require_tumor(result.green, result.tumor_edge, name);
  require_no_marks(result.green, LineEdge::Middle, green_mask, nullptr, result.mm_per_pixel, "green",
                   "beside the green ring", name);
  result.mm_per_pixel = scale.mm_per_pixel(middle_of(result.green.points_px));

  line.mm_per_pixel = result.mm_per_pixel;
  line.edge = settings.red == RedLine::Kerf ? LineEdge::Inner : LineEdge::Middle;
  result.red =
      imaging_detail::trace_marked_line(red, red_mask, strengths.glare, widened(green_mask), InkColor::Red, line, name);
  require_in_view(result.red, "red", picture, name);
  require_nothing_else(result.red, line.edge, red_mask, "red", name);
  require_no_marks(result.red, line.edge, red_mask, &result.green.points_px, line.mm_per_pixel, "red",
                   "inside the tumour's edge", name);
  result.incision = in_plane(result.red, scale);
  return result;
}

ColorPicture draw_over(const ColorPicture& picture, const std::vector<OverlayLine>& lines) {
  constexpr int kShift = 4;  // OpenCV draws at sixteenths of a pixel
  ColorPicture result = picture;
  for (std::uint8_t& value : result.rgb) value = static_cast<std::uint8_t>(value * 3 / 4);
  cv::Mat pixels = imaging_detail::pixels_of(result);
  const int thickness = std::max(1, std::min(picture.width, picture.height) / 900);
  for (const OverlayLine& line : lines) {
    std::vector<cv::Point> points;
    for (const Vec2& p : line.points_px)
      points.emplace_back(cvRound(p.x() * (1 << kShift)), cvRound(p.y() * (1 << kShift)));
    cv::polylines(pixels, points, line.is_closed, cv::Scalar(line.rgb[0], line.rgb[1], line.rgb[2]), thickness,
                  cv::LINE_AA, kShift);
  }
  return result;
}

ColorPicture draw_found(const ColorPicture& picture, const std::vector<const MarkedLine*>& lines,
                        const std::vector<Vec2>& ruler_marks_px) {
  constexpr std::array<std::uint8_t, 3> kFirst{0, 230, 255}, kSecond{255, 255, 255}, kGap{255, 230, 0},
      kMark{255, 0, 255};
  std::vector<OverlayLine> drawn;
  for (std::size_t i = 0; i < lines.size(); ++i)
    drawn.push_back({lines[i]->points_px, lines[i]->is_closed, i == 0 ? kFirst : kSecond});
  for (const MarkedLine* line : lines) {
    for (const LineGap& gap : line->gaps) drawn.push_back({{gap.from_px, gap.to_px}, false, kGap});
  }
  const double arm = 0.004 * std::max(picture.width, picture.height);
  for (const Vec2& p : ruler_marks_px) {
    drawn.push_back({{p - Vec2(arm, 0), p + Vec2(arm, 0)}, false, kMark});
    drawn.push_back({{p - Vec2(0, arm), p + Vec2(0, arm)}, false, kMark});
  }
  return draw_over(picture, drawn);
}

}  // namespace incise
