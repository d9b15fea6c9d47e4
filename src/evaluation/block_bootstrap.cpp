#include <incise/core/error.hpp>
#include <incise/core/quantile.hpp>
#include <incise/core/random.hpp>
#include <incise/evaluation/block_bootstrap.hpp>
#include <incise/evaluation/statistics.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

/// Autocovariance at lags 0 … last, divided by n.
std::vector<double> autocovariance(const ContourValues& contour, double mean, std::size_t last) {
  const std::vector<double>& x = contour.values;
  const std::size_t n = x.size();
  std::vector<double> result;
  for (std::size_t lag = 0; lag <= last; ++lag) {
    double sum = 0.0;
    const std::size_t pairs = contour.is_ring ? n : n - lag;
    for (std::size_t i = 0; i < pairs; ++i) sum += (x[i] - mean) * (x[(i + lag) % n] - mean);
    result.push_back(sum / static_cast<double>(n));
  }
  return result;
}

/// Politis and White's flat-top window.
double flat_top(double share) {
  return share <= 0.5 ? 1.0 : share <= 1.0 ? 2.0 * (1.0 - share) : 0.0;
}

/// Rounded block length. The autocorrelation counts as 0 once it stays within 2 √(log10 n / n) for `run` lags.
std::size_t block_length(const ContourValues& contour, double mean) {
  const std::size_t n = contour.values.size();
  const auto count = static_cast<double>(n);
  const std::size_t furthest = contour.is_ring ? n / 2 : n - 1;
  const auto run = static_cast<std::size_t>(std::max(5.0, std::ceil(std::sqrt(std::log10(count)))));
  const auto searched = std::min(furthest, static_cast<std::size_t>(std::ceil(std::sqrt(count))) + run);
  const std::vector<double> covariance = autocovariance(contour, mean, std::min(furthest, 2 * searched));
  const double border = 2.0 * std::sqrt(std::log10(count) / count) * covariance[0];
  std::size_t gone = searched;  // correlated over all searched lags, unless a run is found
  for (std::size_t lag = 0; lag + run <= searched; ++lag) {
    const auto first = covariance.begin() + static_cast<std::ptrdiff_t>(lag) + 1;
    if (std::all_of(first, first + static_cast<std::ptrdiff_t>(run), [&](double c) { return std::abs(c) < border; })) {
      gone = lag;
      break;
    }
  }
  if (gone == 0) return 1;
  const std::size_t width = std::min(2 * gone, covariance.size() - 1);
  double slope = 0.0;
  double spectrum = covariance[0];
  for (std::size_t lag = 1; lag <= width; ++lag) {
    const double weight = 2.0 * flat_top(static_cast<double>(lag) / static_cast<double>(width)) * covariance[lag];
    spectrum += weight;
    slope += weight * static_cast<double>(lag);
  }
  const double longest = std::ceil(std::min(3.0 * std::sqrt(count), count / 3.0));
  // With the window, the spectrum may be 0 or negative. Then the correlation is too long to measure on this contour, so
  // the longest block is used.
  if (!(spectrum > 0.0)) return static_cast<std::size_t>(longest);
  const double wanted = std::cbrt(1.5 * slope * slope / (spectrum * spectrum) * count);
  return static_cast<std::size_t>(std::clamp(std::round(wanted), 1.0, longest));
}

/// Sums of the blocks, one starting at each point, which wrap round.
std::vector<double> block_sums(const std::vector<double>& values, std::size_t block) {
  const std::size_t n = values.size();
  std::vector<double> sums(n, 0.0);
  for (std::size_t start = 0; start < n; ++start) {
    for (std::size_t k = 0; k < block; ++k) sums[start] += values[(start + k) % n];
  }
  return sums;
}

void require_contour(const ContourValues& contour) {
  INCISE_REQUIRE(contour.values.size() >= 3,
                 fmt::format("found {} values on a contour, expected at least 3", contour.values.size()));
  static_cast<void>(summarize(contour.values));  // throws for values that are not finite
}

/// A contour prepared for redrawing: whole blocks, and one shorter block for the remaining points.
struct Drawer {
  std::vector<double> whole;
  std::vector<double> rest;
  std::size_t wholes = 0;

  explicit Drawer(const ContourValues& contour) {
    const std::size_t n = contour.values.size();
    const std::size_t block = contour_correlation(contour).block;
    wholes = n / block;
    whole = block_sums(contour.values, block);
    if (n % block != 0) rest = block_sums(contour.values, n % block);
  }
  [[nodiscard]] double drawn_sum(Random& random) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < wholes; ++k) sum += whole[random.below(whole.size())];
    if (!rest.empty()) sum += rest[random.below(rest.size())];
    return sum;
  }
};

struct Side {
  std::vector<Drawer> contours;
  double points = 0.0;
  double mean = 0.0;

  explicit Side(std::span<const ContourValues> values) {
    double sum = 0.0;
    for (const ContourValues& contour : values) {
      contours.emplace_back(contour);
      points += static_cast<double>(contour.values.size());
      for (const double value : contour.values) sum += value;
    }
    mean = sum / points;
  }
  [[nodiscard]] double drawn_mean(Random& random) const {
    double sum = 0.0;
    for (const Drawer& contour : contours) sum += contour.drawn_sum(random);
    return sum / points;
  }
};

bool is_constant(std::span<const ContourValues> contours) {
  return std::all_of(contours.begin(), contours.end(), [](const ContourValues& contour) {
    const Summary summary = summarize(contour.values);
    return summary.min == summary.max;
  });
}

}  // namespace

ContourCorrelation contour_correlation(const ContourValues& contour) {
  require_contour(contour);
  const SampleMoments moments = moments_of(contour.values);
  ContourCorrelation result;
  if (moments.sd == 0.0) return result;
  result.block = block_length(contour, moments.mean);
  const auto n = static_cast<double>(moments.n);
  const auto length = static_cast<double>(result.block);
  double squares = 0.0;
  for (const double sum : block_sums(contour.values, result.block)) {
    squares += (sum / length - moments.mean) * (sum / length - moments.mean);
  }
  result.standard_error = std::sqrt(squares / n * length / n);
  if (result.standard_error > 0.0) {
    const double variance = moments.sd * moments.sd * (n - 1.0) / n;
    result.n_effective = variance / (result.standard_error * result.standard_error);
  }
  return result;
}

BootstrapTest block_bootstrap_test(std::span<const ContourValues> before, std::span<const ContourValues> after,
                                   const BootstrapSettings& settings) {
  INCISE_REQUIRE(!before.empty() && !after.empty(), "expected at least one contour before and after");
  INCISE_REQUIRE(settings.replicates >= 99,
                 fmt::format("found {} replicates, expected at least 99", settings.replicates));
  INCISE_REQUIRE(settings.level > 0.0 && settings.level < 1.0, "expected a level in (0, 1)");
  for (const auto side : {before, after}) {
    for (const ContourValues& contour : side) require_contour(contour);
  }
  const Side first(before);
  const Side second(after);
  BootstrapTest test{.verdict = TestVerdict::NoSpread,
                     .difference = second.mean - first.mean,
                     .replicates = settings.replicates,
                     .seed = settings.seed};
  if (is_constant(before) && is_constant(after)) return test;

  Random random(settings.seed);
  std::vector<double> drawn;
  drawn.reserve(static_cast<std::size_t>(settings.replicates));
  std::size_t astray = 0;
  for (int k = 0; k < settings.replicates; ++k) {
    const double mean_before = first.drawn_mean(random);
    drawn.push_back(second.drawn_mean(random) - mean_before);
    if (std::abs(drawn.back() - test.difference) >= std::abs(test.difference)) ++astray;
  }
  test.verdict = TestVerdict::Tested;
  test.standard_error = summarize(drawn).sd;
  test.p = (1.0 + static_cast<double>(astray)) / (1.0 + static_cast<double>(settings.replicates));
  std::sort(drawn.begin(), drawn.end());
  const double tail = 0.5 * (1.0 - settings.level);
  test.confidence = Interval{quantile(drawn, tail), quantile(drawn, 1.0 - tail)};
  return test;
}

}  // namespace incise
