#include "imaging/ruler_ticks.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace incise {
namespace {

using imaging_detail::Stroke;
using imaging_detail::pixels_of;

/// Returns the distance from `inside` at which grey passes half-way to the outside; nullopt if there is no step.
std::optional<double> end_of_bar(const cv::Mat& grey, const Vec2& inside, const Vec2& direction, double expected) {
  const auto value = [&](double s) { return imaging_detail::grey_at(grey, inside + s * direction); };
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

/// Returns every solid, straight, black or white bar, longest first.
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
    for (const Stroke& s : imaging_detail::strokes_in(mask, even, kAspect)) {
      if (s.fill >= kFill && s.fill <= 1.0 / kFill && s.length >= kLeastPx) bars.push_back(s);
    }
  }
  std::stable_sort(bars.begin(), bars.end(), [](const Stroke& a, const Stroke& b) { return a.length > b.length; });
  return bars;
}

/// Refuses a second bar. An instrument's shaft, a label or the next piece of a chequered bar also looks like a bar;
/// which one has the given length is unknown.
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
  imaging_detail::require_no_ticks(picture, name);  // first, because ticks are bars too
  require_one_bar(bars, name);
  const Stroke* best = bars.data();
  // Measure along several lines, to ignore a blemish.
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
          {best->center - 0.5 * pixels * best->direction, best->center + 0.5 * pixels * best->direction},
          {}};
}

}  // namespace

Ruler find_ruler(const ColorPicture& picture, RulerKind kind, std::optional<double> length_mm,
                 const std::filesystem::path& name) {
  INCISE_REQUIRE(!length_mm || (std::isfinite(*length_mm) && *length_mm > 0.0),
                 fmt::format("expected a length above 0 mm, found {}", *length_mm));
  INCISE_REQUIRE(length_mm || kind == RulerKind::Ticks, "expected the bar's length, found none");
  imaging_detail::hold_opencv_threads();
  return kind == RulerKind::Ticks ? imaging_detail::ruler_of_ticks(picture, length_mm, name)
                                  : ruler_of_bar(picture, *length_mm, name);
}

}  // namespace incise
