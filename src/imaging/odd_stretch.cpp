#include "imaging/odd_stretch.hpp"

#include <incise/core/median.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace incise::imaging_detail {
namespace {

constexpr std::size_t kFeatures = 3;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A feature that is compared along a line, and the share of its median by which it may always differ.
struct Feature {
  const char* name;
  double least_share;
};
constexpr std::array<Feature, kFeatures> kCompared{
    {{"width", 0.35}, {"strength of colour", 0.25}, {"lightness", 0.20}}};
constexpr double kSpreads = 6.0;     // times the line's own spread (1.48 times the median deviation)
constexpr double kLeastKnown = 0.6;  // share of a stretch that must be known

using Values = std::array<std::vector<double>, kFeatures>;

double nearest_grey(const cv::Mat& grey, const Vec2& p) {
  const int u = std::clamp(static_cast<int>(std::lround(p.x())), 0, grey.cols - 1);
  const int v = std::clamp(static_cast<int>(std::lround(p.y())), 0, grey.rows - 1);
  return grey.at<std::uint8_t>(v, u) + 1.0;
}

/// Returns the features of every point; unknown where something covers the line.
Values features_of(const cv::Mat& grey, const InkMap& map, const MarkedLine& line, const cv::Mat& hidden,
                   LineEdge edge) {
  constexpr double kStep = 0.5;
  constexpr double kBesidePx = 4.0;
  Values values;
  const double reach = 1.2 * line.width_px + 4.0;
  const double from = edge == LineEdge::Inner ? -4.0 : -reach;
  for (std::size_t i = 0; i < line.points_px.size(); ++i) {
    const Vec2& p = line.points_px[i];
    const Vec2 normal = outward(tangent_at(line.points_px, line.is_closed, i, 8));
    double width = 0.0, strength = 0.0, light = 0.0;
    bool is_hidden = false;
    for (double s = from; s <= reach; s += kStep) {
      const Vec2 q = p + s * normal;
      is_hidden = is_hidden || covers(hidden, q);
      const double likelihood = sampled(map.likelihood, q.x(), q.y());
      strength = std::max(strength, likelihood);
      if (likelihood <= 0.5) continue;
      width += kStep;
      light += kStep * nearest_grey(grey, q);
    }
    // The kerf outside is dark and of varying width, so lightness is compared with the tissue inside.
    const double inside = nearest_grey(grey, p + (from - kBesidePx) * normal);
    const bool is_known = !is_hidden && width > 0.0;
    values[0].push_back(is_known ? width : kUnknown);
    values[1].push_back(is_known ? strength : kUnknown);
    values[2].push_back(is_known ? light / width / inside : kUnknown);
  }
  return values;
}

/// Returns means over `reach` points on either side; unknown where too few are known.
std::vector<double> averaged(const std::vector<double>& values, std::size_t reach) {
  const std::size_t n = values.size();
  std::vector<double> result(n, kUnknown);
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0.0;
    std::size_t known = 0;
    for (std::size_t k = 0; k <= 2 * reach; ++k) {
      const double value = values[(i + n + k - reach) % n];
      if (std::isnan(value)) continue;
      sum += value;
      ++known;
    }
    if (static_cast<double>(known) >= kLeastKnown * static_cast<double>(2 * reach + 1))
      result[i] = sum / static_cast<double>(known);
  }
  return result;
}

double median_of(std::vector<double> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return std::isnan(v); }), values.end());
  return values.empty() ? kUnknown : median(values);
}

/// The place where a feature differs most from its median, and by how many times the allowance; ratio 0: none.
struct Oddest {
  double ratio = 0.0;
  std::size_t at = 0;
  double value = 0.0, usual = 0.0;
};
Oddest oddest_of(const std::vector<double>& values, double least_share) {
  Oddest oddest;
  oddest.usual = median_of(values);
  if (std::isnan(oddest.usual)) return {};
  std::vector<double> deviations;
  for (const double v : values) deviations.push_back(std::abs(v - oddest.usual));
  const double allowed = std::max(least_share * oddest.usual, kSpreads * 1.48 * median_of(deviations));
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i]) || deviations[i] <= oddest.ratio * allowed) continue;
    oddest = {deviations[i] / allowed, i, values[i], oddest.usual};
  }
  return oddest;
}

}  // namespace

std::optional<OddStretch> odd_stretch_of(const ColorPicture& picture, const InkMap& map, const MarkedLine& line,
                                         const cv::Mat& hidden, const LineSettings& settings) {
  if (!line.is_closed || line.points_px.size() < 8) return std::nullopt;
  cv::Mat grey;
  cv::cvtColor(pixels_of(picture), grey, cv::COLOR_RGB2GRAY);
  const Values values = features_of(grey, map, line, hidden, settings.edge);
  const double step_mm =
      length_px(line.points_px, true) / static_cast<double>(line.points_px.size()) * settings.mm_per_pixel;
  // Shorter gaps are bridged anyway; a stretch as long as one decides.
  const double stretch_mm = settings.max_gap_mm + line.gap_tolerance_mm;
  const auto reach = static_cast<std::size_t>(std::max(2.0, 0.5 * stretch_mm / step_mm));
  if (2 * reach + 1 > line.points_px.size() / 4) return std::nullopt;
  std::optional<OddStretch> worst;
  double worst_ratio = 1.0;
  for (std::size_t f = 0; f < kFeatures; ++f) {
    const std::vector<double> means = averaged(values[f], reach);
    const Oddest odd = oddest_of(means, kCompared[f].least_share);
    if (odd.ratio <= worst_ratio) continue;
    worst_ratio = odd.ratio;
    const double border = 0.5 * (odd.value + odd.usual);  // half way back to the median
    const auto is_odd = [&](std::size_t i) {
      return !std::isnan(means[i]) && (means[i] < border) == (odd.value < border);
    };
    std::size_t count = 1;
    const std::size_t n = means.size();
    for (std::size_t k = 1; k < n && is_odd((odd.at + k) % n); ++k) ++count;
    for (std::size_t k = 1; k < n && is_odd((odd.at + n - k) % n); ++k) ++count;
    worst =
        OddStretch{line.points_px[odd.at], static_cast<double>(std::min(count, n)) * step_mm,
                   fmt::format("{} {:.0f} % {} than along the rest", kCompared[f].name,
                               100.0 * std::abs(odd.value / odd.usual - 1.0), odd.value < odd.usual ? "less" : "more")};
  }
  return worst;
}

}  // namespace incise::imaging_detail
