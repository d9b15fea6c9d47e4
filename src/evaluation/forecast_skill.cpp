#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/evaluation/forecast_skill.hpp>
#include <incise/evaluation/statistics.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace incise {
namespace {

constexpr std::size_t kLeastReplicates = 99;
/// Greatest number of draws for each replicate. Draws that lack one kind are repeated.
constexpr int kMostDrawsPerReplicate = 20;

/// Share of the pairs in which the score with the event is the higher one; equal scores count as half. @pre both sorted
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

/// Scores of forecasts whose event happened, and of the others.
struct Scores {
  std::vector<double> happened, did_not;
  void add(const Forecast& forecast) { (forecast.happened ? happened : did_not).push_back(forecast.said); }
  [[nodiscard]] double area() {
    std::sort(happened.begin(), happened.end());
    std::sort(did_not.begin(), did_not.end());
    return area_of(happened, did_not);
  }
};

std::vector<std::vector<Forecast>> by_cluster(std::span<const Forecast> forecasts) {
  std::map<std::size_t, std::vector<Forecast>> clusters;
  for (const Forecast& forecast : forecasts) clusters[forecast.cluster].push_back(forecast);
  std::vector<std::vector<Forecast>> list;
  for (auto& [number, members] : clusters) list.push_back(std::move(members));
  return list;
}

/// Areas of replicates in which whole clusters are redrawn. A draw with only one kind has no area and is repeated.
std::vector<double> areas_by_cluster(const std::vector<std::vector<Forecast>>& clusters,
                                     const BootstrapSettings& settings) {
  Random random(settings.seed);
  std::vector<double> areas;
  for (int left = kMostDrawsPerReplicate * settings.replicates;
       left > 0 && areas.size() < static_cast<std::size_t>(settings.replicates); --left) {
    Scores drawn;
    for (std::size_t i = 0; i < clusters.size(); ++i)
      for (const Forecast& forecast : clusters[random.below(clusters.size())]) drawn.add(forecast);
    if (!drawn.happened.empty() && !drawn.did_not.empty()) areas.push_back(drawn.area());
  }
  return areas;
}

/// Variance of a share, divided by the variance that it would have for independent forecasts; at least 1.
double design_effect(const std::vector<std::vector<Forecast>>& clusters, double share, double count) {
  if (clusters.size() < 2 || share == 0.0 || share == 1.0) return 1.0;
  double squares = 0.0;
  for (const std::vector<Forecast>& members : clusters) {
    const auto happened =
        static_cast<double>(std::ranges::count_if(members, [](const Forecast& one) { return one.happened; }));
    squares += std::pow(happened - share * static_cast<double>(members.size()), 2);
  }
  const auto number = static_cast<double>(clusters.size());
  return std::max(1.0, squares * number / (number - 1.0) / (count * share * (1.0 - share)));
}

/// Wilson's 95 % interval of a share. @param count  number of forecasts; for clusters, divided by the design effect
Interval wilson_interval(double share, double count) {
  const double z2 = kNormal95 * kNormal95;
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
  Scores scores;
  for (std::size_t i = 0; i < forecasts.size(); ++i) {
    INCISE_REQUIRE(std::isfinite(forecasts[i].said), fmt::format("forecast {}: expected a finite score", i));
    scores.add(forecasts[i]);
  }
  const auto& [happened, did_not] = scores;
  INCISE_REQUIRE(!happened.empty() && !did_not.empty(),
                 fmt::format("expected forecasts of what happened and of what did not, found {} and {}",
                             happened.size(), did_not.size()));
  RocCurve curve;
  curve.happened = happened.size();
  curve.did_not = did_not.size();
  curve.area = scores.area();  // sorts them
  curve.points = points_of(happened, did_not);
  const std::vector<std::vector<Forecast>> clusters = by_cluster(forecasts);
  std::vector<double> areas;
  if (clusters.size() > 1) {
    areas = areas_by_cluster(clusters, settings);
  } else {
    Random random(settings.seed);
    for (int i = 0; i < settings.replicates; ++i) {
      const std::vector<double> first = drawn_anew(happened, random);  // fixes the order of the draws
      areas.push_back(area_of(first, drawn_anew(did_not, random)));
    }
  }
  const bool is_enough = areas.size() >= kLeastReplicates;
  curve.confidence = !is_enough ? Interval{0.0, 1.0} : percentiles(std::move(areas), settings.level);
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
  std::vector<std::vector<Forecast>> in_bin(bins);
  Reliability result;
  for (std::size_t i = 0; i < forecasts.size(); ++i) {
    const Forecast& forecast = forecasts[i];
    INCISE_REQUIRE(forecast.said >= 0.0 && forecast.said <= 1.0,
                   fmt::format("forecast {}: expected a probability in [0, 1], found {}", i, forecast.said));
    const std::size_t place = std::min(bins - 1, static_cast<std::size_t>(forecast.said * static_cast<double>(bins)));
    ReliabilityBin& bin = all[place];
    in_bin[place].push_back(forecast);
    ++bin.forecasts;
    bin.happened += forecast.happened ? 1 : 0;
    bin.mean_said += forecast.said;
    result.brier_score += std::pow(forecast.said - (forecast.happened ? 1.0 : 0.0), 2);
  }
  result.brier_score /= static_cast<double>(forecasts.size());
  for (std::size_t place = 0; place < bins; ++place) {
    ReliabilityBin& bin = all[place];
    if (bin.forecasts == 0) continue;
    const auto count = static_cast<double>(bin.forecasts);
    bin.mean_said /= count;
    bin.share = static_cast<double>(bin.happened) / count;
    bin.confidence = wilson_interval(bin.share, count / design_effect(by_cluster(in_bin[place]), bin.share, count));
    result.bins.push_back(bin);
  }
  return result;
}

}  // namespace incise
