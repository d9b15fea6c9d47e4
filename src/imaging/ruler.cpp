#include "imaging/opencv.hpp"

#include <incise/core/error.hpp>
#include <incise/imaging/photo_scale.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace incise {
namespace {

using imaging_detail::pixels_of;

constexpr std::size_t kLeastTicks = 8;
constexpr double kEvenness = 0.12;  // a tick may lie off its place by this share of the spacing

/// A straight, slim dark piece of the picture.
struct Stroke {
  Vec2 center;     ///< weighted by darkness
  Vec2 direction;  ///< along it
  double length;
  double width;
  double fill;  ///< share of its rectangle that it covers
};

/// Pixels that are dark against their surroundings and without colour, with their darkness, [0, 255].
struct DarkPixels {
  cv::Mat mask;
  cv::Mat darkness;
};
DarkPixels dark_pixels(const ColorPicture& picture, int window) {
  constexpr double kLeastStep = 40.0;  // grey levels
  constexpr int kColorless = 40;       // greatest difference of the channels
  const cv::Mat rgb = pixels_of(picture);
  cv::Mat grey, around;
  cv::cvtColor(rgb, grey, cv::COLOR_RGB2GRAY);
  cv::boxFilter(grey, around, -1, {window, window});
  DarkPixels dark;
  cv::subtract(around, grey, dark.darkness);
  dark.mask = cv::Mat(grey.size(), CV_8U);
  for (int v = 0; v < grey.rows; ++v) {
    for (int u = 0; u < grey.cols; ++u) {
      const auto& c = rgb.at<cv::Vec3b>(v, u);
      const auto [low, high] = std::minmax({c[0], c[1], c[2]});
      dark.mask.at<std::uint8_t>(v, u) =
          dark.darkness.at<std::uint8_t>(v, u) > kLeastStep && high - low <= kColorless ? 255 : 0;
    }
  }
  return dark;
}

std::vector<Stroke> strokes_in(const cv::Mat& mask, const cv::Mat& darkness, double least_aspect) {
  cv::Mat labels, stats, centers;
  const int count = cv::connectedComponentsWithStats(mask, labels, stats, centers, 8, CV_32S);
  std::vector<Stroke> strokes;
  for (int i = 1; i < count; ++i) {
    const cv::Rect box(stats.at<int>(i, cv::CC_STAT_LEFT), stats.at<int>(i, cv::CC_STAT_TOP),
                       stats.at<int>(i, cv::CC_STAT_WIDTH), stats.at<int>(i, cv::CC_STAT_HEIGHT));
    const int area = stats.at<int>(i, cv::CC_STAT_AREA);
    if (area < 12 || std::max(box.width, box.height) < 8) continue;
    double mass = 0.0;
    Vec2 first = Vec2::Zero();
    Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
    for (int v = box.y; v < box.y + box.height; ++v) {
      for (int u = box.x; u < box.x + box.width; ++u) {
        if (labels.at<int>(v, u) != i) continue;
        const double weight = darkness.at<std::uint8_t>(v, u) + 1.0;
        const Vec2 p(u, v);
        mass += weight;
        first += weight * p;
        second += weight * p * p.transpose();
      }
    }
    const Vec2 center = first / mass;
    const Eigen::Matrix2d spread = second / mass - center * center.transpose();
    const double middle = 0.5 * spread.trace();
    const double half = std::hypot(0.5 * (spread(0, 0) - spread(1, 1)), spread(0, 1));
    const double angle = 0.5 * std::atan2(2.0 * spread(0, 1), spread(0, 0) - spread(1, 1));
    // An even rectangle of length a has the variance a²/12 along itself.
    const double length = std::sqrt(12.0 * (middle + half));
    const double width = std::sqrt(12.0 * std::max(middle - half, 1.0 / 12.0));
    if (length < least_aspect * width) continue;
    strokes.push_back({center, {std::cos(angle), std::sin(angle)}, length, width, area / (length * width)});
  }
  return strokes;
}

/// Evenly spaced places fitted through ticks: place = start + spacing · number.
struct Comb {
  double spacing = 0.0;
  double error = 0.0;  ///< standard error of the spacing
  std::vector<Vec2> ticks;
};

/// The longest even run among strokes that are parallel to one of them and stand side by side with it.
std::optional<Comb> comb_about(const Stroke& seed, const std::vector<Stroke>& strokes) {
  constexpr double kParallel = 0.9986;  // cosine of 3 degrees
  const Vec2 across(-seed.direction.y(), seed.direction.x());
  struct Place {
    double at;
    Vec2 center;
  };
  std::vector<Place> places;
  for (const Stroke& s : strokes) {
    const double along = std::abs(seed.direction.dot(s.center - seed.center));
    if (std::abs(seed.direction.dot(s.direction)) < kParallel || along > 0.5 * (seed.length + s.length)) continue;
    if (s.length > 4.0 * seed.length || s.length < 0.4 * seed.length) continue;
    places.push_back({across.dot(s.center - seed.center), s.center});
  }
  if (places.size() < kLeastTicks) return std::nullopt;
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.at < b.at; });
  std::vector<double> steps;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) steps.push_back(places[i + 1].at - places[i].at);
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  double spacing = steps[steps.size() / 2];
  if (spacing < 3.0) return std::nullopt;
  // Numbered from neighbour to neighbour, so that an error of the first guess does not add up.
  std::vector<double> numbers{0.0}, ats{places.front().at};
  Comb comb;
  comb.ticks.push_back(places.front().center);
  for (std::size_t i = 1; i < places.size(); ++i) {
    const double step = (places[i].at - ats.back()) / spacing;
    const double whole = std::round(step);
    if (whole < 1.0 || std::abs(step - whole) > kEvenness * whole) continue;
    if (whole > 6.0) break;
    numbers.push_back(numbers.back() + whole);
    ats.push_back(places[i].at);
    comb.ticks.push_back(places[i].center);
  }
  const auto n = static_cast<double>(numbers.size());
  if (numbers.size() < kLeastTicks) return std::nullopt;
  double mean_k = 0.0, mean_x = 0.0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    mean_k += numbers[i] / n;
    mean_x += ats[i] / n;
  }
  double kk = 0.0, kx = 0.0, rest = 0.0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    kk += (numbers[i] - mean_k) * (numbers[i] - mean_k);
    kx += (numbers[i] - mean_k) * (ats[i] - mean_x);
  }
  comb.spacing = kx / kk;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    rest += std::pow(ats[i] - mean_x - comb.spacing * (numbers[i] - mean_k), 2);
  const double deviation = std::sqrt(rest / (n - 2.0));
  if (deviation > kEvenness * comb.spacing) return std::nullopt;
  comb.error = deviation / std::sqrt(kk);
  return comb;
}

Ruler ruler_of_ticks(const ColorPicture& picture, double length_mm, const std::filesystem::path& name) {
  std::optional<Comb> best;
  // Spacing and stroke width are not known yet: narrow and wide surroundings.
  for (const int window : {31, 81}) {
    const DarkPixels dark = dark_pixels(picture, window);
    const std::vector<Stroke> strokes = strokes_in(dark.mask, dark.darkness, 2.5);
    for (const Stroke& seed : strokes) {
      const std::optional<Comb> comb = comb_about(seed, strokes);
      if (comb && (!best || comb->ticks.size() > best->ticks.size())) best = comb;
    }
  }
  if (!best) {
    throw DataError(name, "", "no ruler (fewer than 8 evenly spaced parallel dark lines on a light ground)",
                    "a ruler with its ticks in view",
                    "Give the scale with --mm-per-pixel or two points of known distance instead.");
  }
  return {length_mm / best->spacing, 100.0 * best->error / best->spacing, best->ticks};
}

/// Place, along a line, where grey passes half-way between inside and outside; nullopt without a step.
std::optional<double> end_of_bar(const cv::Mat& grey, const Vec2& inside, const Vec2& direction, double expected) {
  const auto value = [&](double s) {
    const Vec2 p = inside + s * direction;
    const int u = std::clamp(static_cast<int>(p.x()), 0, grey.cols - 2);
    const int v = std::clamp(static_cast<int>(p.y()), 0, grey.rows - 2);
    const double a = std::clamp(p.x() - u, 0.0, 1.0), b = std::clamp(p.y() - v, 0.0, 1.0);
    return (1 - b) * ((1 - a) * grey.at<std::uint8_t>(v, u) + a * grey.at<std::uint8_t>(v, u + 1)) +
           b * ((1 - a) * grey.at<std::uint8_t>(v + 1, u) + a * grey.at<std::uint8_t>(v + 1, u + 1));
  };
  double in = 0.0, out = 0.0;
  for (int k = 0; k < 4; ++k) {
    in += 0.25 * value(expected - 6.0 - k);
    out += 0.25 * value(expected + 6.0 + k);
  }
  if (std::abs(in - out) < 30.0) return std::nullopt;
  const double level = 0.5 * (in + out);
  for (double s = expected - 6.0; s < expected + 6.0; s += 0.25) {
    const double a = value(s) - level, b = value(s + 0.25) - level;
    if (a * b <= 0.0 && a != b) return s + 0.25 * a / (a - b);
  }
  return std::nullopt;
}

/// Every solid straight bar without colour, black or white, longest first.
std::vector<Stroke> bars_in(const ColorPicture& picture, const cv::Mat& grey) {
  constexpr double kFill = 0.85;
  constexpr double kAspect = 4.0;
  constexpr double kLeastPx = 40.0;
  const cv::Mat rgb = pixels_of(picture);
  cv::Mat mask(grey.size(), CV_8U);
  const cv::Mat even(grey.size(), CV_8U, cv::Scalar(127));
  std::vector<Stroke> bars;
  for (const bool is_dark : {true, false}) {
    for (int v = 0; v < rgb.rows; ++v) {
      for (int u = 0; u < rgb.cols; ++u) {
        const auto& c = rgb.at<cv::Vec3b>(v, u);
        const auto [low, high] = std::minmax({c[0], c[1], c[2]});
        mask.at<std::uint8_t>(v, u) = high - low <= 40 && (is_dark ? high < 70 : low > 225) ? 255 : 0;
      }
    }
    for (const Stroke& s : strokes_in(mask, even, kAspect)) {
      if (s.fill >= kFill && s.fill <= 1.0 / kFill && s.length >= kLeastPx) bars.push_back(s);
    }
  }
  std::stable_sort(bars.begin(), bars.end(), [](const Stroke& a, const Stroke& b) { return a.length > b.length; });
  return bars;
}

/// An instrument's shaft, a label or the next piece of a chequered bar passes for a bar, too: which one has the length
/// that was given cannot be told.
void require_one_bar(const std::vector<Stroke>& bars, const std::filesystem::path& name) {
  constexpr double kOfLongest = 0.25;  // strokes of a label's letters are shorter
  if (bars.size() < 2 || bars[1].length < kOfLongest * bars[0].length) return;
  const auto text = [](const Stroke& bar) {
    return fmt::format("one of {:.0f} pixels at pixel {:.0f}, {:.0f}", bar.length, bar.center.x(), bar.center.y());
  };
  throw DataError(name, "", fmt::format("{} bars, {} and {}", bars.size(), text(bars[0]), text(bars[1])),
                  "one scale bar in view",
                  "Cover the other, or give the scale with --mm-per-pixel or with the bar's two ends: --two-points.");
}

Ruler ruler_of_bar(const ColorPicture& picture, double length_mm, const std::filesystem::path& name) {
  cv::Mat grey;
  cv::cvtColor(pixels_of(picture), grey, cv::COLOR_RGB2GRAY);
  const std::vector<Stroke> bars = bars_in(picture, grey);
  const auto refuse = [&] {
    throw DataError(name, "", "no scale bar (a solid black or white straight bar)", "one in view",
                    "Give the scale with --mm-per-pixel or two points of known distance instead.");
  };
  if (bars.empty()) refuse();
  require_one_bar(bars, name);
  const Stroke* best = bars.data();
  // Ends on several lines along the bar, so that one blemish does not count.
  const Vec2 across(-best->direction.y(), best->direction.x());
  std::vector<double> lengths;
  for (const double share : {-0.25, -0.125, 0.0, 0.125, 0.25}) {
    const Vec2 inside = best->center + share * best->width * across;
    const auto front = end_of_bar(grey, inside, best->direction, 0.5 * best->length);
    const auto back = end_of_bar(grey, inside, -best->direction, 0.5 * best->length);
    if (front && back) lengths.push_back(*front + *back);
  }
  if (lengths.size() < 3) refuse();
  std::sort(lengths.begin(), lengths.end());
  const double pixels = lengths[lengths.size() / 2];
  return {length_mm / pixels,
          100.0 * (lengths.back() - lengths.front()) / 2.0 / pixels,
          {best->center - 0.5 * pixels * best->direction, best->center + 0.5 * pixels * best->direction}};
}

}  // namespace

Ruler find_ruler(const ColorPicture& picture, RulerKind kind, double length_mm, const std::filesystem::path& name) {
  INCISE_REQUIRE(std::isfinite(length_mm) && length_mm > 0.0,
                 fmt::format("expected a length above 0 mm, found {}", length_mm));
  imaging_detail::hold_opencv_threads();
  return kind == RulerKind::Ticks ? ruler_of_ticks(picture, length_mm, name) : ruler_of_bar(picture, length_mm, name);
}

}  // namespace incise
