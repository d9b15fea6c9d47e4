#pragma once

#include "laboratory/tested_specimen.hpp"

#include <incise/evaluation/t_tests.hpp>
#include <incise/report/line_plot.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace incise::laboratory {

/// Results of the test specimens along one path, compared with the best path without a simulated cut.
struct PathResult {
  std::string name;               ///< as_planned, incise, or the name of a RivalPath
  bool is_simulated = false;      ///< a simulated cut takes part in the path
  std::size_t pairs = 0;          ///< specimens with a closed ring along this path and as planned
  std::optional<double> mean_mm;  ///< of the pairs: mean over specimens of the mean |error|
  std::size_t worse = 0;          ///< specimens whose error grew, or whose ring opened
  std::size_t harmed = 0;         ///< of the worse ones: by more than 0.1 mm, or opened
  std::size_t closed = 0;         ///< cuts whose ring truly closed
  std::size_t close_margins = 0;  ///< of the closed ones: somewhere less tissue beside the tumour than the close margin
  std::size_t uncut = 0;          ///< specimens cut as planned, but not along this path, because a step refused it
  std::size_t compared = 0;       ///< of the pairs: those with a closed ring along the best path, too
  std::optional<double> compared_mean_mm;  ///< mean_mm of the compared pairs
  std::optional<double> difference_mm;     ///< of the compared pairs: mean minus the best path's; negative: better
  /// 95 % confidence interval of the difference, see compare_paths; absent: fewer than 2 pairs, or no spread.
  std::optional<Interval> confidence;
};
void describe(Visitor& v, PathResult& r);

/// Every path that test specimens were cut along: as planned, the rivals, incise.
struct PathComparison {
  std::vector<PathResult> paths;
  /// The path without a simulated cut that has the least mean |error| over the specimens with closed rings along all
  /// such paths, the planned one included; absent: no rival of that kind was cut, or there is no such specimen.
  std::optional<std::string> best_without_simulation;
  [[nodiscard]] const PathResult* find(std::string_view name) const;
};
/// With fewer series, an interval that resamples series would end at single series.
inline constexpr std::ptrdiff_t kFewestSeries = 5;

/// The tested specimens of one series: they share a calibration and, on the second bench, a hand-eye offset.
using TestedSeries = std::vector<TestedSpecimen>;

/// Compares every path with the best one without a simulated cut. That path is chosen after the fact, which favours it
/// over incise. Differences are paired by specimen. Their interval is Student's over the specimens of one series, or,
/// from five series on, a bootstrap's that resamples whole series. A simulation can refuse a path, but never a path
/// without a simulated cut: see `uncut`.
[[nodiscard]] PathComparison compare_paths(std::span<const TestedSeries> series);
[[nodiscard]] inline PathComparison compare_paths(const TestedSeries& specimens) {
  return compare_paths(std::span(&specimens, 1));
}

/// Two paths of the same specimens.
struct PathPair {
  std::string first, second;
  std::size_t compared = 0;                   ///< specimens with closed rings along both, in the photographs
  std::optional<double> first_mm, second_mm;  ///< of the compared ones: mean over specimens of the mean |error|
  std::optional<Interval> confidence;         ///< of the difference, as in compare_paths
  std::size_t closed = 0;                     ///< specimens whose rings truly closed along both
  std::size_t close_margins_first = 0, close_margins_second = 0;  ///< of the closed ones
  [[nodiscard]] std::optional<double> difference_mm() const {
    return first_mm && second_mm ? std::optional(*second_mm - *first_mm) : std::nullopt;
  }
};
void describe(Visitor& v, PathPair& p);
[[nodiscard]] PathPair compare_two(std::span<const TestedSeries> series, std::string_view first,
                                   std::string_view second);

/// Errors after so many photographs, without and with simulation.
struct LearningPoint {
  std::optional<std::size_t> photographs;  ///< number; absent: all photographs of each calibration
  PathPair pair;                           ///< the forecasts without and with simulation, on the same specimens
};
inline void describe(Visitor& v, LearningPoint& p) {
  v("photographs", p.photographs, "Number of photographs used, the first of each calibration; absent: all.");
  v("pair", p.pair,
    "Cuts along the forecasts without and with simulation; without photographs: as planned, and corrected with the "
    "default tool.");
}
/// Returns the points from none to all photographs, on the specimens whose rings closed along both paths of every
/// point; empty: there are none.
[[nodiscard]] std::vector<LearningPoint> learning_curve(std::span<const TestedSeries> series);
/// Plots the mean |error| against the number of photographs. @param all  number of photographs of a whole calibration,
/// mean over series. @pre the curve has points.
[[nodiscard]] LinePlot learning_plot(const std::vector<LearningPoint>& curve, double all);

/// `{as_planned: {…}, constant: {…}, …}`
[[nodiscard]] nlohmann::ordered_json paths_json(const PathComparison& comparison);

/// "incise 0.47 mm, profile 0.32 mm (best without simulation) on 12 specimens: difference +0.15 mm (+0.05 to +0.25)".
/// @param name  of the path to compare with the best one. Empty if nothing can be compared.
[[nodiscard]] std::string claim_of(const PathComparison& comparison, std::string_view name);

}  // namespace incise::laboratory
