#include "imaging/photo_checks.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace incise::imaging_detail {
namespace {

constexpr int kBesidePx = 12;          // beside a line its own blur and JPEG's blocks end
constexpr int kLeastPlacePixels = 12;  // smaller ones are grain

std::vector<cv::Point> pixels_along(const std::vector<Vec2>& line) {
  std::vector<cv::Point> points;
  points.reserve(line.size());
  for (const Vec2& p : line) points.emplace_back(cvRound(p.x()), cvRound(p.y()));
  return points;
}

/// Of the ink that belongs to the line itself, from one side to the other.
int reach_px(const CheckedLine& checked) {
  return (checked.edge == LineEdge::Inner ? 2 : 1) * static_cast<int>(checked.line.width_px) + kBesidePx;
}

/// The picture's part that a mask fills, with a rim of one pixel, and the line in its coordinates.
struct Crop {
  cv::Mat mask;
  cv::Point corner;
  std::vector<cv::Point> line;
};
Crop crop_to_ink(const CheckedLine& checked) {
  Crop crop;
  const cv::Rect box = cv::boundingRect(checked.mask);
  cv::copyMakeBorder(checked.mask(box), crop.mask, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  crop.corner = {box.x - 1, box.y - 1};
  crop.line = pixels_along(checked.line.points_px);
  for (cv::Point& p : crop.line) p -= crop.corner;
  return crop;
}

cv::Mat drawn(const cv::Size& size, const std::vector<cv::Point>& line, bool is_closed, double thickness_px) {
  constexpr double kThickest = 32000.0;  // OpenCV's limit
  cv::Mat result(size, CV_8U, cv::Scalar(0));
  cv::polylines(result, line, is_closed, cv::Scalar(255),
                static_cast<int>(std::clamp(std::ceil(thickness_px), 1.0, kThickest)));
  return result;
}

/// The pieces of ink that the line runs through or that a gap at most parts from it.
cv::Mat ink_of_line(const CheckedLine& checked, const Crop& crop) {
  const double reach = checked.line.width_px + 2.0 * checked.max_gap_mm / checked.mm_per_pixel;
  const cv::Mat near = drawn(crop.mask.size(), crop.line, checked.line.is_closed, reach);
  cv::Mat pieces;
  const int count = cv::connectedComponents(crop.mask, pieces, 8, CV_32S);
  std::vector<std::uint8_t> is_own(static_cast<std::size_t>(count), 0);
  for (int v = 0; v < pieces.rows; ++v) {
    const auto* piece = pieces.ptr<int>(v);
    const auto* at = near.ptr<std::uint8_t>(v);
    for (int u = 0; u < pieces.cols; ++u) {
      if (at[u] != 0) is_own[static_cast<std::size_t>(piece[u])] = 255;
    }
  }
  is_own[0] = 0;
  cv::Mat own(pieces.size(), CV_8U);
  for (int v = 0; v < pieces.rows; ++v) {
    const auto* piece = pieces.ptr<int>(v);
    auto* to = own.ptr<std::uint8_t>(v);
    for (int u = 0; u < pieces.cols; ++u) to[u] = is_own[static_cast<std::size_t>(piece[u])];
  }
  return own;
}

/// A place that ink encloses.
struct Enclosed {
  double pixels = 0.0;
  double inside_ring = 0.0;  ///< of its pixels
  double off_line = 0.0;     ///< of its pixels: farther from the line than its own ink lies
  Vec2 middle_px = Vec2::Zero();
};

std::vector<Enclosed> enclosed_places(const CheckedLine& checked, const Crop& crop) {
  const cv::Mat own = ink_of_line(checked, crop);
  // From the centre line the ink lies half a width to either side, from a band's inner border a whole one.
  const bool is_band = checked.edge == LineEdge::Inner;
  const double to_side = (is_band ? 1.1 : 0.5) * checked.line.width_px + (is_band ? 4.0 : 2.0);
  const cv::Mat on_line = drawn(own.size(), crop.line, checked.line.is_closed, 2.0 * to_side);
  cv::Mat ring(own.size(), CV_8U, cv::Scalar(0));
  if (checked.line.is_closed) cv::fillPoly(ring, std::vector<std::vector<cv::Point>>{crop.line}, cv::Scalar(255));
  cv::Mat places, stats, middles;
  const int count = cv::connectedComponentsWithStats(cv::Mat(own == 0), places, stats, middles, 4, CV_32S);
  std::vector<Enclosed> result(static_cast<std::size_t>(count));
  for (int v = 0; v < places.rows; ++v) {
    const auto* place = places.ptr<int>(v);
    const auto* is_inside = ring.ptr<std::uint8_t>(v);
    const auto* is_on_line = on_line.ptr<std::uint8_t>(v);
    for (int u = 0; u < places.cols; ++u) {
      Enclosed& at = result[static_cast<std::size_t>(place[u])];
      at.inside_ring += is_inside[u] != 0 ? 1.0 : 0.0;
      at.off_line += is_on_line[u] == 0 ? 1.0 : 0.0;
    }
  }
  for (int i = 1; i < count; ++i) {
    Enclosed& at = result[static_cast<std::size_t>(i)];
    at.pixels = stats.at<int>(i, cv::CC_STAT_AREA);
    at.middle_px = Vec2(middles.at<double>(i, 0) + crop.corner.x, middles.at<double>(i, 1) + crop.corner.y);
  }
  const auto outside = static_cast<std::size_t>(places.at<int>(0, 0));
  result[outside] = {};
  result[0] = {};  // the ink
  return result;
}

}  // namespace

void require_in_view(const CheckedLine& checked) {
  const std::optional<Vec2> end = end_at_rim_px(checked.line, checked.mask.cols, checked.mask.rows);
  if (!end) return;
  throw DataError(checked.name, "",
                  fmt::format("a {} line that runs out of the picture, at pixel {:.0f}, {:.0f}",
                              to_string(checked.color), end->x(), end->y()),
                  "the whole line in view");
}

void require_nothing_else(const CheckedLine& checked) {
  constexpr double kMostElse = 0.4;     // share of the ink: blood is less
  constexpr double kLeastPiece = 0.05;  // of the ring's own ink
  if (!checked.line.is_closed) return;
  cv::Mat elsewhere = checked.mask.clone(), labels, stats, centers;
  cv::polylines(elsewhere, pixels_along(checked.line.points_px), true, cv::Scalar(0), reach_px(checked));
  const double own = cv::countNonZero(checked.mask) - cv::countNonZero(elsewhere);
  double other = 0.0;
  const int count = cv::connectedComponentsWithStats(elsewhere, labels, stats, centers, 8, CV_32S);
  for (int i = 1; i < count; ++i) {
    const double area = stats.at<int>(i, cv::CC_STAT_AREA);
    if (area >= kLeastPiece * own) other += area;
  }
  const double share = other / std::max(1.0, own + other);
  if (share <= kMostElse) return;
  throw DataError(
      checked.name, "",
      fmt::format("much {0} beside the {0} ring ({1:.0f} % of it)", to_string(checked.color), 100.0 * share),
      "one simple ring", "A second line, or one that crosses itself? Something else of that colour?");
}

void require_simple(const CheckedLine& checked) {
  const std::vector<Enclosed> places = enclosed_places(checked, crop_to_ink(checked));
  // The ring's own inside; with gaps in its ink it is part of the outside, and no place at all.
  const auto own = std::max_element(places.begin(), places.end(),
                                    [](const Enclosed& a, const Enclosed& b) { return a.inside_ring < b.inside_ring; });
  const Enclosed* loop = nullptr;
  for (const Enclosed& place : places) {
    if (checked.line.is_closed && &place == &*own && place.inside_ring > 0.5 * place.pixels) continue;
    if (place.pixels < kLeastPlacePixels || place.off_line < kLeastPlacePixels) continue;
    if (loop == nullptr || place.pixels > loop->pixels) loop = &place;
  }
  if (loop == nullptr) return;
  const double across_mm = 2.0 * std::sqrt(loop->pixels / std::numbers::pi) * checked.mm_per_pixel;
  throw DataError(checked.name, "",
                  fmt::format("a {} line that crosses itself: it encloses {} place, {:.2f} mm across, at pixel {:.0f}, "
                              "{:.0f}",
                              to_string(checked.color), checked.line.is_closed ? "a second" : "a", across_mm,
                              loop->middle_px.x(), loop->middle_px.y()),
                  "one simple curve");
}

std::vector<PhotoMark> marks_beside(const CheckedLine& checked, const cv::Mat& ink, const std::vector<Vec2>* within) {
  if (!checked.line.is_closed && within == nullptr) return {};
  cv::Rect box(0, 0, ink.cols, ink.rows);
  if (within != nullptr) box &= cv::boundingRect(pixels_along(*within));
  cv::Mat elsewhere = ink(box).clone(), labels, stats, centers;
  const auto in_box = [&](const std::vector<Vec2>& line) {
    std::vector<cv::Point> points = pixels_along(line);
    for (cv::Point& p : points) p -= box.tl();
    return points;
  };
  if (within != nullptr) {
    cv::Mat inside = cv::Mat::zeros(elsewhere.size(), elsewhere.type());
    cv::fillPoly(inside, std::vector<std::vector<cv::Point>>{in_box(*within)}, cv::Scalar(255));
    cv::bitwise_and(elsewhere, inside, elsewhere);
  }
  cv::polylines(elsewhere, in_box(checked.line.points_px), checked.line.is_closed, cv::Scalar(0), reach_px(checked));
  const int count = cv::connectedComponentsWithStats(elsewhere, labels, stats, centers, 8, CV_32S);
  std::vector<PhotoMark> marks;
  for (int i = 1; i < count; ++i) {
    const int longest = std::max(stats.at<int>(i, cv::CC_STAT_WIDTH), stats.at<int>(i, cv::CC_STAT_HEIGHT));
    marks.push_back(
        {{centers.at<double>(i, 0) + box.x, centers.at<double>(i, 1) + box.y}, longest * checked.mm_per_pixel});
  }
  std::stable_sort(marks.begin(), marks.end(),
                   [](const PhotoMark& a, const PhotoMark& b) { return a.longest_mm > b.longest_mm; });
  return marks;
}

void require_no_large_mark(const CheckedLine& checked, const std::vector<PhotoMark>& marks, const char* place) {
  constexpr double kLongestSpeckMm = 3.0;
  if (!checked.line.is_closed || marks.empty() || marks.front().longest_mm < kLongestSpeckMm) return;
  const PhotoMark& mark = marks.front();
  throw DataError(checked.name, "",
                  fmt::format("a {} mark of {:.1f} mm {}, at pixel {:.0f}, {:.0f}", to_string(checked.color),
                              mark.longest_mm, place, mark.at_px.x(), mark.at_px.y()),
                  fmt::format("no {} there but the ring", to_string(checked.color)),
                  "A second cut or tumour? Paint over it if it is neither");
}

cv::Mat faint_ink(const InkMap& map, const std::vector<Vec2>& within) {
  constexpr double kFaintest = 0.35;  // of the line's own strength
  constexpr double kNoises = 8.0;
  constexpr double kGreyIsNoInk = 0.06;
  constexpr int kLeastPixels = 8;  // JPEG's ringing beside a thin line leaves pieces of 4
  const double level = std::max({kFaintest, kNoises * map.noise / map.contrast, kGreyIsNoInk / map.contrast});
  cv::Mat result(map.likelihood.size(), CV_8U, cv::Scalar(0));
  const cv::Rect box = cv::boundingRect(pixels_along(within)) & cv::Rect(0, 0, result.cols, result.rows);
  without_specks(map.likelihood(box) > level, kLeastPixels).copyTo(result(box));
  return result;
}

}  // namespace incise::imaging_detail
