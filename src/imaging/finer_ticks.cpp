#include "imaging/finer_ticks.hpp"

#include <incise/core/median.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace incise::imaging_detail {
namespace {

constexpr std::size_t kStepsTogether = 10;  // overlaid: a finer scale may run along only part of the row
constexpr std::size_t kFewestSteps = 6;
// Between the ticks of a sound ruler (8 grey levels of noise, JPEG) the median of 10 steps stays below 1 grey level.
constexpr double kLeastContrast = 0.06;  // relative to the ticks' contrast
constexpr double kLeastGreys = 4.0;
constexpr double kBesideTick = 0.14;  // of the spacing: nearer is the tick's own rim
constexpr double kLeastBesidePx = 2.5;

/// The ends of the ticks that lie in line, one for each tick, and the direction from there along the ticks.
struct Feet {
  std::vector<Vec2> places;
  Vec2 inward;
  [[nodiscard]] Vec2 between(std::size_t tick, double share) const {
    return places[tick] + share * (places[tick + 1] - places[tick]);
  }
};

Feet feet_of(const Comb& comb) {
  const Vec2 first = comb.ticks.front().direction;
  const auto n = static_cast<double>(comb.ticks.size());
  Feet best;
  double least = std::numeric_limits<double>::infinity();
  for (const double end : {-0.5, 0.5}) {
    Feet feet;
    Vec2 mean = Vec2::Zero(), slope = Vec2::Zero();
    feet.inward = Vec2::Zero();
    double mean_number = 0.0, squares = 0.0, rest = 0.0;
    for (std::size_t i = 0; i < comb.ticks.size(); ++i) {
      const Stroke& tick = comb.ticks[i];
      const Vec2 along = tick.direction.dot(first) < 0.0 ? Vec2(-tick.direction) : tick.direction;
      feet.places.emplace_back(tick.center + end * tick.length * along);
      feet.inward -= (end < 0.0 ? -1.0 : 1.0) * along;
      mean += feet.places.back() / n;
      mean_number += comb.numbers[i] / n;
    }
    for (std::size_t i = 0; i < comb.ticks.size(); ++i) {
      squares += (comb.numbers[i] - mean_number) * (comb.numbers[i] - mean_number);
      slope += (comb.numbers[i] - mean_number) * (feet.places[i] - mean);
    }
    slope /= squares;
    feet.inward.normalize();
    for (std::size_t i = 0; i < comb.ticks.size(); ++i) {
      const double off = feet.inward.dot(feet.places[i] - mean - slope * (comb.numbers[i] - mean_number));
      feet.places[i] -= off * feet.inward;
      rest += off * off;
    }
    if (rest >= least) continue;
    least = rest;
    best = std::move(feet);
  }
  return best;
}

/// Darkness relative to both sides, by position from tick to tick (columns) and along the ticks (rows).
class Overlay {
 public:
  Overlay(const cv::Mat& grey, const Feet& feet, double spacing_px, double length_px, double width_px)
      : grey_(grey),
        feet_(feet),
        columns_(
            static_cast<std::size_t>(std::clamp(std::ceil(spacing_px / std::max(0.5, width_px / 3.0)), 12.0, 400.0))),
        rows_(std::max<std::size_t>(4, static_cast<std::size_t>(std::ceil(length_px)))),
        beside_(std::min(0.25, std::max(kLeastBesidePx, width_px) / spacing_px)),
        spacing_px_(spacing_px),
        window_(std::max<std::size_t>(3, static_cast<std::size_t>(0.15 * length_px))),
        width_px_(width_px) {}

  /// Returns the darkest mark between ticks: median over the steps (each given by its first tick), averaged along the
  /// ticks over a short window. Returns nullopt if it is too faint.
  [[nodiscard]] std::optional<FinerTicks> look_at(const std::vector<std::size_t>& steps) const {
    const double margin = std::max(kBesideTick, (0.75 * width_px_ + kLeastBesidePx) / spacing_px_);
    double best = 0.0, share = 0.0, tick = 0.0;
    for (std::size_t j = 0; j < columns_; ++j) {
      const double u = static_cast<double>(j) / static_cast<double>(columns_);
      const bool is_tick = j == 0;
      if (!is_tick && (u < margin || u > 1.0 - margin)) continue;
      std::vector<double> column(rows_);
      for (std::size_t k = 0; k < rows_; ++k) column[k] = median_darkness(steps, u, static_cast<double>(k) + 0.5);
      for (std::size_t k = 0; k + window_ <= rows_; ++k) {
        double mean = 0.0;
        for (std::size_t w = 0; w < window_; ++w) mean += column[k + w] / static_cast<double>(window_);
        if (is_tick) {
          tick = std::max(tick, mean);
          continue;
        }
        if (mean <= best) continue;
        best = mean;
        share = u;
      }
    }
    if (best <= std::max(kLeastGreys, kLeastContrast * tick)) return std::nullopt;
    return FinerTicks{share, best / tick};
  }

 private:
  [[nodiscard]] double median_darkness(const std::vector<std::size_t>& steps, double u, double height_px) const {
    std::vector<double> values;
    for (const std::size_t tick : steps) {
      const auto value = [&](double share) {
        return grey_at(grey_, feet_.between(tick, share) + height_px * feet_.inward);
      };
      values.push_back(std::min(value(u - beside_), value(u + beside_)) - value(u));
    }
    return median(values);
  }

  const cv::Mat& grey_;
  const Feet& feet_;
  std::size_t columns_, rows_;
  double beside_, spacing_px_;
  std::size_t window_;
  double width_px_;
};

}  // namespace

std::optional<FinerTicks> finer_ticks(const cv::Mat& grey, const Comb& comb) {
  const Feet feet = feet_of(comb);
  std::vector<double> lengths, widths;
  std::vector<std::size_t> steps;
  for (std::size_t i = 0; i < comb.ticks.size(); ++i) {
    lengths.push_back(comb.ticks[i].length);
    widths.push_back(comb.ticks[i].width);
    if (i > 0 && comb.numbers[i] - comb.numbers[i - 1] == 1.0) steps.push_back(i - 1);
  }
  const Overlay overlay(grey, feet, comb.spacing_px, median(lengths), median(widths));
  std::optional<FinerTicks> found;
  for (std::size_t first = 0; first < steps.size(); first += kStepsTogether / 2) {
    const std::size_t end = std::min(first + kStepsTogether, steps.size());
    if (end - first < std::min(kFewestSteps, steps.size())) break;
    const auto here = overlay.look_at(
        {steps.begin() + static_cast<std::ptrdiff_t>(first), steps.begin() + static_cast<std::ptrdiff_t>(end)});
    if (here && (!found || here->contrast > found->contrast)) found = here;
  }
  return found;
}

bool every_second_is_longer(const Comb& comb) {
  constexpr double kLonger = 1.15;
  constexpr double kShare = 0.75;  // least share of ticks on their group's side; every fifth and tenth is longer too
  std::array<std::vector<double>, 2> lengths;
  for (std::size_t i = 0; i < comb.ticks.size(); ++i)
    lengths[static_cast<std::size_t>(std::llround(comb.numbers[i])) % 2].push_back(comb.ticks[i].length);
  if (std::min(lengths[0].size(), lengths[1].size()) < 3) return false;
  double low = median(lengths[0]), high = median(lengths[1]);
  const std::size_t longer = low > high ? 0 : 1;
  if (low > high) std::swap(low, high);
  if (high < kLonger * low) return false;
  std::size_t agree = 0;
  for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
    agree += static_cast<std::size_t>(std::count_if(lengths[side].begin(), lengths[side].end(), [&](double length) {
      return (length > 0.5 * (low + high)) == (side == longer);
    }));
  }
  return static_cast<double>(agree) >= kShare * static_cast<double>(comb.ticks.size());
}

}  // namespace incise::imaging_detail
