#include "imaging/photo_checks.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace incise::imaging_detail {
namespace {

constexpr int kBesidePx = 12;          // reach of a line's own blur and of JPEG's blocks
constexpr int kLeastPlacePixels = 12;  // smaller places are noise

/// Returns a line's pixels, counted from `corner`.
std::vector<cv::Point> pixels_along(const std::vector<Vec2>& line, const cv::Point& corner = {}) {
  std::vector<cv::Point> points;
  for (const Vec2& p : line) points.push_back(cv::Point(cvRound(p.x()), cvRound(p.y())) - corner);
  return points;
}

/// Erases the ink of the line itself. A band lies only on the outer side of its inner border: ink on the inner side,
/// beyond the reach of blur, is something else.
void wipe_own_ink(cv::Mat& ink, const CheckedLine& checked, const cv::Point& corner) {
  const std::vector<Vec2>& line = checked.line.points_px;
  const bool is_band = checked.edge == LineEdge::Inner;
  const int width = static_cast<int>(checked.line.width_px);
  cv::polylines(ink, pixels_along(line, corner), checked.line.is_closed, cv::Scalar(0),
                (is_band ? 0 : width) + kBesidePx);
  if (!is_band) return;
  const std::size_t n = line.size();
  const Vec2 origin(corner.x, corner.y);
  const auto pixel = [&](const Vec2& p) { return cv::Point(cvRound(p.x() - origin.x()), cvRound(p.y() - origin.y())); };
  const auto fill = [&](const Vec2& a, const Vec2& out_a, const Vec2& b, const Vec2& out_b) {
    cv::fillConvexPoly(ink, std::vector<cv::Point>{pixel(a), pixel(a + out_a), pixel(b + out_b), pixel(b)},
                       cv::Scalar(0));
  };
  const auto out = [&](std::size_t i) {
    return Vec2((width + 0.5 * kBesidePx) * outward(tangent_at(line, checked.line.is_closed, i, 4)));
  };
  for (std::size_t i = 0; i + 1 < n; ++i) fill(line[i], out(i), line[i + 1], out(i + 1));
  if (checked.line.is_closed) {
    fill(line[n - 1], out(n - 1), line[0], out(0));
    return;
  }
  const double beyond = 0.5 * width + kBesidePx;  // round ends
  const Vec2 before = line[0] - beyond * tangent_at(line, false, 0, 4);
  const Vec2 behind = line[n - 1] + beyond * tangent_at(line, false, n - 1, 4);
  fill(before, out(0), line[0], out(0));
  fill(line[n - 1], out(n - 1), behind, out(n - 1));
}

/// The part of the picture that a mask fills, with a rim of one pixel, and the line in its coordinates.
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
  crop.line = pixels_along(checked.line.points_px, crop.corner);
  return crop;
}

cv::Mat drawn(const cv::Size& size, const std::vector<cv::Point>& line, bool is_closed, double thickness_px) {
  constexpr double kThickest = 32000.0;  // OpenCV's limit
  cv::Mat result(size, CV_8U, cv::Scalar(0));
  cv::polylines(result, line, is_closed, cv::Scalar(255),
                static_cast<int>(std::clamp(std::ceil(thickness_px), 1.0, kThickest)));
  return result;
}

/// Returns the pieces of ink through which the line runs, or that are at most a gap away from it.
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
  return by_piece(pieces, is_own);
}

/// A place that ink encloses.
struct Enclosed {
  double pixels = 0.0;
  double inside_ring = 0.0;  ///< its pixels inside the ring; an open line is closed by its chord
  double off_line = 0.0;     ///< its pixels that are farther from the line than the line's own ink
  Vec2 middle_px = Vec2::Zero();
  cv::Mat shape;  ///< set only if is_own_inside; in the crop: 255 on this place and everything inside it
  bool is_own_inside = false;
};

/// Returns a place with the holes filled that other ink makes in it.
cv::Mat filled(const cv::Mat& place) {
  std::vector<std::vector<cv::Point>> borders;
  cv::findContours(place, borders, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  cv::Mat result(place.size(), CV_8U, cv::Scalar(0));
  cv::fillPoly(result, borders, cv::Scalar(255));
  return result;
}

std::vector<Enclosed> enclosed_places(const CheckedLine& checked, const Crop& crop) {
  const cv::Mat own = ink_of_line(checked, crop);
  // Ink reaches half a width to either side of a centre line, and a whole width from a band's inner border.
  const bool is_band = checked.edge == LineEdge::Inner;
  const double to_side = (is_band ? 1.1 : 0.5) * checked.line.width_px + (is_band ? 4.0 : 2.0);
  const cv::Mat on_line = drawn(own.size(), crop.line, checked.line.is_closed, 2.0 * to_side);
  cv::Mat ring(own.size(), CV_8U, cv::Scalar(0));
  cv::fillPoly(ring, std::vector<std::vector<cv::Point>>{crop.line}, cv::Scalar(255));
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
  // If the ring's ink has gaps, its inside is connected to the outside, and is no enclosed place.
  const auto own_inside = std::max_element(
      result.begin(), result.end(), [](const Enclosed& a, const Enclosed& b) { return a.inside_ring < b.inside_ring; });
  const double least = checked.line.is_closed ? 0.0 : 0.5 * cv::countNonZero(ring);
  if (own_inside->inside_ring > 0.5 * own_inside->pixels && own_inside->inside_ring > least) {
    own_inside->is_own_inside = true;
    own_inside->shape = filled(places == static_cast<int>(own_inside - result.begin()));
  }
  return result;
}

/// Refuses a ring that ink encloses but whose border was not found, usually because of another mark of that colour
/// inside it.
[[noreturn]] void refuse_unclear_ring(const CheckedLine& checked, const Crop& crop, const Enclosed& inside) {
  cv::Mat other, labels, stats, middles;
  cv::bitwise_and(crop.mask, inside.shape, other);
  // The shape's rim may touch the ring's ink.
  cv::Mat core;
  cv::erode(inside.shape, core, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
  cv::bitwise_and(other, core, other);
  const int count = cv::connectedComponentsWithStats(other, labels, stats, middles, 8, CV_32S);
  int largest = 0;
  for (int i = 1; i < count; ++i) {
    const int area = stats.at<int>(i, cv::CC_STAT_AREA);
    if (area >= kLeastPlacePixels && (largest == 0 || area > stats.at<int>(largest, cv::CC_STAT_AREA))) largest = i;
  }
  const std::string color(to_string(checked.color));
  if (largest == 0) {
    const LineGap& gap = checked.line.gaps.front();
    throw DataError(checked.name, "",
                    fmt::format("a {} ring whose border is not clear over {:.1f} mm, at pixel {:.0f}, {:.0f}", color,
                                gap.length_mm, gap.from_px.x(), gap.from_px.y()),
                    "one simple ring");
  }
  const int longest = std::max(stats.at<int>(largest, cv::CC_STAT_WIDTH), stats.at<int>(largest, cv::CC_STAT_HEIGHT));
  throw DataError(checked.name, "",
                  fmt::format("a {0} mark of {1:.1f} mm inside the {0} ring, at pixel {2:.0f}, {3:.0f}", color,
                              longest * checked.mm_per_pixel, middles.at<double>(largest, 0) + crop.corner.x,
                              middles.at<double>(largest, 1) + crop.corner.y),
                  fmt::format("nothing {} there except the ring", color),
                  "A second cut? If it is not one, paint over it");
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
  wipe_own_ink(elsewhere, checked, {0, 0});
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
      fmt::format("much {0} beside the {0} ring ({1:.0f} % of that colour)", to_string(checked.color), 100.0 * share),
      "one simple ring", "A second line, or one that crosses itself? Something else of that colour?");
}

void require_simple(const CheckedLine& checked) {
  const Crop crop = crop_to_ink(checked);
  const std::vector<Enclosed> places = enclosed_places(checked, crop);
  const Enclosed* loop = nullptr;
  for (const Enclosed& place : places) {
    if (place.is_own_inside && checked.line.is_closed) continue;
    if (place.is_own_inside) refuse_unclear_ring(checked, crop, place);
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
  if (within != nullptr) {
    cv::Mat inside = cv::Mat::zeros(elsewhere.size(), elsewhere.type());
    cv::fillPoly(inside, std::vector<std::vector<cv::Point>>{pixels_along(*within, box.tl())}, cv::Scalar(255));
    cv::bitwise_and(elsewhere, inside, elsewhere);
  }
  wipe_own_ink(elsewhere, checked, box.tl());
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

void require_no_large_mark(const CheckedLine& checked, const std::vector<PhotoMark>& marks, double least_mm,
                           const char* place) {
  if (!checked.line.is_closed || marks.empty() || marks.front().longest_mm < least_mm) return;
  const PhotoMark& mark = marks.front();
  throw DataError(checked.name, "",
                  fmt::format("a {} mark of {:.1f} mm {}, at pixel {:.0f}, {:.0f}", to_string(checked.color),
                              mark.longest_mm, place, mark.at_px.x(), mark.at_px.y()),
                  fmt::format("nothing {} there except the ring", to_string(checked.color)),
                  "A second cut or tumour? If it is neither, paint over it");
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
