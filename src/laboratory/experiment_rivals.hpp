#pragma once

#include "laboratory/experiment_tables.hpp"

#include <incise/evaluation/t_tests.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise::laboratory {

/// What came of the test specimens along one path, and against the best path without a simulated cut.
struct PathResult {
  std::string name;               ///< as_planned, incise, or that of a RivalPath
  bool is_simulated = false;      ///< a simulated cut takes part in the path
  std::size_t pairs = 0;          ///< specimens with a closed ring along this path and as planned
  std::optional<double> mean_mm;  ///< of these: mean over specimens of the mean |error|
  std::size_t worse = 0;          ///< specimens whose error grew, or whose ring opened
  std::size_t uncut = 0;          ///< specimens that were cut as planned, and not along this path: a step refused it
  std::size_t compared = 0;       ///< of the pairs: those with a closed ring along the best path, too
  std::optional<double> compared_mean_mm;  ///< of these: as mean_mm
  std::optional<double> difference_mm;     ///< of these: mean less that along the best path; negative: better
  /// Of that difference, 95 %, paired by specimen; absent: fewer than 2, or no spread.
  std::optional<Interval> confidence;
};
void describe(Visitor& v, PathResult& r);

/// Every path that test specimens were cut along: as planned, the rivals, incise.
struct PathComparison {
  std::vector<PathResult> paths;
  /// The least mean |error| over the specimens with closed rings along all paths without a simulated cut, the planned
  /// one among them; absent: no rival of that kind was cut, or there is no such specimen.
  std::optional<std::string> best_without_simulation;
  [[nodiscard]] const PathResult* find(std::string_view name) const;
};
/// A benefit is claimed over the best path without a simulated cut, chosen after the fact: the choice favours that
/// rival. Differences are paired by specimen; their interval is Student's, over specimens. Paths without a simulated
/// cut are never refused by a simulation, the others may be: see `uncut`.
[[nodiscard]] PathComparison compare_paths(const std::vector<Trial>& trials);

/// `{as_planned: {…}, constant: {…}, …}`
[[nodiscard]] nlohmann::ordered_json paths_json(const PathComparison& comparison);

/// "incise 0.47 mm, profile 0.32 mm (best without simulation) on 12 specimens: difference +0.15 mm (+0.05 to +0.25)".
/// @param name  of the path that is held against the best one. Empty where nothing can be compared.
[[nodiscard]] std::string claim_of(const PathComparison& comparison, std::string_view name);

}  // namespace incise::laboratory
