#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/evaluation/forecast_skill.hpp>
#include <incise/evaluation/statistics.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

/// Share of the pairs in which the event's score is the higher one, equal ones counted as halves. Both sorted.
double area_of(const std::vector<double>& happened, const std::vector<double>& did_not) {
  double sum = 0.0;
  for (const double score : happened) {
    const auto [first, last] = std::equal_range(did_not.begin(), did_not.end(), score);
    sum += static_cast<double>(first - did_not.begin()) + 0.5 * static_cast<double>(last - first);
  }
  return sum / (static_cast<double>(happened.size()) * static_cast<double>(did_not.size()));
}

std::vector<double> drawn_anew(const std::vector<double>& scores, Random& random) {
  std::vector<double> drawn(scores.size());
  for (double& score : drawn) score = scores[random.below(scores.size())];
  std::sort(drawn.begin(), drawn.end());
  return drawn;
}

Interval percentiles(std::vector<double> values, double level) {
  std::sort(values.begin(), values.end());
  const auto at = [&values](double share) {
    return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
  };
  return {at(0.5 * (1.0 - level)), at(0.5 * (1.0 + level))};
}

std::vector<RocPoint> points_of(const std::vector<double>& happened, const std::vector<double>& did_not) {
  std::vector<double> thresholds = happened;
  thresholds.insert(thresholds.end(), did_not.begin(), did_not.end());
  std::sort(thresholds.begin(), thresholds.end(), std::greater<>());
  thresholds.erase(std::unique(thresholds.begin(), thresholds.end()), thresholds.end());
  const auto share_from = [](const std::vector<double>& sorted, double threshold) {
    const auto first = std::lower_bound(sorted.begin(), sorted.end(), threshold);
    return static_cast<double>(sorted.end() - first) / static_cast<double>(sorted.size());
  };
  std::vector<RocPoint> points{{0.0, 0.0}};
  for (const double threshold : thresholds)
    points.push_back({share_from(did_not, threshold), share_from(happened, threshold)});
  return points;
}

Interval wilson_interval(std::size_t happened, std::size_t n) {
  const auto count = static_cast<double>(n);
  const double share = static_cast<double>(happened) / count, z2 = kNormal95 * kNormal95;
  const double middle = (share + z2 / (2.0 * count)) / (1.0 + z2 / count);
  const double half =
      kNormal95 / (1.0 + z2 / count) * std::sqrt(share * (1.0 - share) / count + z2 / (4.0 * count * count));
  return {middle - half, middle + half};
}

}  // namespace

RocCurve roc_curve(std::span<const Forecast> forecasts, const BootstrapSettings& settings) {
  INCISE_REQUIRE(settings.replicates >= 99 && settings.level > 0.0 && settings.level < 1.0,
                 fmt::format("expected at least 99 replicates and a level between 0 and 1, found {} and {}",
                             settings.replicates, settings.level));
  std::vector<double> happened, did_not;
  for (std::size_t i = 0; i < forecasts.size(); ++i) {
    INCISE_REQUIRE(std::isfinite(forecasts[i].said), fmt::format("forecast {}: expected a finite score", i));
    (forecasts[i].happened ? happened : did_not).push_back(forecasts[i].said);
  }
  INCISE_REQUIRE(!happened.empty() && !did_not.empty(),
                 fmt::format("expected forecasts of what happened and of what did not, found {} and {}",
                             happened.size(), did_not.size()));
  std::sort(happened.begin(), happened.end());
  std::sort(did_not.begin(), did_not.end());
  RocCurve curve;
  curve.happened = happened.size();
  curve.did_not = did_not.size();
  curve.area = area_of(happened, did_not);
  curve.points = points_of(happened, did_not);
  Random random(settings.seed);
  std::vector<double> areas(static_cast<std::size_t>(settings.replicates));
  for (double& area : areas) {
    const std::vector<double> first = drawn_anew(happened, random);  // in this order on every compiler
    area = area_of(first, drawn_anew(did_not, random));
  }
  curve.confidence = percentiles(std::move(areas), settings.level);
  return curve;
}

std::optional<bool> is_second_worse(const std::optional<double>& first_mm, const std::optional<double>& second_mm) {
  if (first_mm && second_mm) return *second_mm > *first_mm;
  if (!first_mm && !second_mm) return std::nullopt;
  return !second_mm;
}

Reliability reliability(std::span<const Forecast> forecasts, std::size_t bins) {
  INCISE_REQUIRE(!forecasts.empty() && bins >= 1,
                 fmt::format("expected forecasts and at least one bin, found {} and {}", forecasts.size(), bins));
  std::vector<ReliabilityBin> all(bins);
  Reliability result;
  for (std::size_t i = 0; i < forecasts.size(); ++i) {
    const Forecast& forecast = forecasts[i];
    INCISE_REQUIRE(forecast.said >= 0.0 && forecast.said <= 1.0,
                   fmt::format("forecast {}: expected a probability in [0, 1], found {}", i, forecast.said));
    ReliabilityBin& bin = all[std::min(bins - 1, static_cast<std::size_t>(forecast.said * static_cast<double>(bins)))];
    ++bin.forecasts;
    bin.happened += forecast.happened ? 1 : 0;
    bin.mean_said += forecast.said;
    result.brier_score += std::pow(forecast.said - (forecast.happened ? 1.0 : 0.0), 2);
  }
  result.brier_score /= static_cast<double>(forecasts.size());
  for (ReliabilityBin& bin : all) {
    if (bin.forecasts == 0) continue;
    bin.mean_said /= static_cast<double>(bin.forecasts);
    bin.share = static_cast<double>(bin.happened) / static_cast<double>(bin.forecasts);
    bin.confidence = wilson_interval(bin.happened, bin.forecasts);
    result.bins.push_back(bin);
  }
  return result;
}

}  // namespace incise
