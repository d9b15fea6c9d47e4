#include "laboratory/experiment_rivals.hpp"

#include <incise/core/described_json.hpp>
#include <incise/evaluation/t_tests.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise::laboratory {
namespace {

constexpr std::string_view kAsPlanned = "as_planned";
constexpr std::string_view kIncise = "incise";

/// The cut of a specimen along the path of that name; nothing: it was not asked for.
const TrialCut* cut_along(const Trial& trial, std::string_view name) {
  if (name == kAsPlanned) return &trial.planned;
  if (name == kIncise) return &trial.corrected;
  return find_rival(trial, *value_of<RivalPath>(name));
}

/// Of a test specimen whose planned cut was measured; nothing: no closed ring.
std::optional<double> error_along(const Trial& trial, std::string_view name) {
  if (trial.role != TrialRole::Test || !trial.planned.measured) return std::nullopt;
  const TrialCut* cut = cut_along(trial, name);
  return cut != nullptr ? mean_error_mm(*cut) : std::nullopt;
}

PathResult planned_result(const std::vector<Trial>& trials) {
  PathResult result{.name = std::string(kAsPlanned)};
  double sum = 0.0;
  for (const Trial& trial : trials) {
    const std::optional<double> error = mean_error_mm(trial.planned);
    if (trial.role != TrialRole::Test || !error) continue;
    ++result.pairs;
    sum += *error;
  }
  if (result.pairs > 0) result.mean_mm = sum / static_cast<double>(result.pairs);
  return result;
}

PathResult result_along(const std::vector<Trial>& trials, std::string_view name) {
  const bool is_incise = name == kIncise;
  const std::optional<RivalPath> path = is_incise ? std::nullopt : value_of<RivalPath>(name);
  const TrialSummary summary = summary_of(trials, TrialRole::Test, path);
  PathResult result{.name = std::string(name), .is_simulated = is_incise || !is_without_simulation(*path)};
  result.pairs = summary.pairs;
  if (summary.pairs > 0) result.mean_mm = summary.mean_after_mm;
  result.worse = summary.worse;
  result.uncut = summary.uncorrected;
  return result;
}

/// Against the best path, specimen by specimen.
void compare(const std::vector<Trial>& trials, std::string_view best, PathResult& result) {
  std::vector<double> theirs, mine;
  for (const Trial& trial : trials) {
    const std::optional<double> of_best = error_along(trial, best), of_this = error_along(trial, result.name);
    if (!of_best || !of_this) continue;
    theirs.push_back(*of_best);
    mine.push_back(*of_this);
  }
  result.compared = mine.size();
  if (mine.empty()) return;
  result.compared_mean_mm = moments_of(mine).mean;
  if (result.name == best) return;
  const TTest test = paired_t_test(theirs, mine);
  result.difference_mm = test.difference;
  result.confidence = test.confidence;
}

/// See PathComparison. @param names  of the paths without a simulated cut.
std::optional<std::string> best_of(const std::vector<Trial>& trials, const std::vector<std::string>& names) {
  std::vector<double> sums(names.size(), 0.0);
  bool is_any_common = false;
  for (const Trial& trial : trials) {
    std::vector<double> errors;
    for (const std::string& name : names) {
      if (const std::optional<double> error = error_along(trial, name)) errors.push_back(*error);
    }
    if (errors.size() != names.size()) continue;
    is_any_common = true;
    for (std::size_t i = 0; i < names.size(); ++i) sums[i] += errors[i];
  }
  if (!is_any_common) return std::nullopt;
  return names[static_cast<std::size_t>(std::min_element(sums.begin(), sums.end()) - sums.begin())];
}

}  // namespace

void describe(Visitor& v, PathResult& r) {
  v("name", r.name, "Of the path.");
  v({"mean_mm", "Mean over specimens of the photographs' mean |error|.", "mm"}, r.mean_mm);
  v("worse", r.worse, "Specimens whose error grew, or whose ring opened.");
  v("pairs", r.pairs, "Specimens with a closed ring along this path and as planned.");
  v("uncut", r.uncut, "Specimens that were cut as planned, and not along this path.");
  v("simulated", r.is_simulated, "Whether a simulated cut takes part in the path.");
  v("compared", r.compared, "Of the pairs: those with a closed ring along the best path without simulation, too.");
  v({"compared_mean_mm", "Of these: as mean_mm.", "mm"}, r.compared_mean_mm);
  v({"difference_mm", "Of these: mean less that along the best one; negative: better.", "mm"}, r.difference_mm);
  describe_interval(v, {"confidence_mm", "Of the difference, 95 %, paired by specimen.", "mm"}, r.confidence);
}

const PathResult* PathComparison::find(std::string_view name) const {
  const auto place = std::find_if(paths.begin(), paths.end(), [name](const PathResult& p) { return p.name == name; });
  return place != paths.end() ? &*place : nullptr;
}

PathComparison compare_paths(const std::vector<Trial>& trials) {
  PathComparison comparison;
  comparison.paths.push_back(planned_result(trials));
  const auto add = [&](std::string_view name) {
    const bool is_asked = std::any_of(trials.begin(), trials.end(), [name](const Trial& trial) {
      return trial.role == TrialRole::Test && cut_along(trial, name) != nullptr;
    });
    if (is_asked) comparison.paths.push_back(result_along(trials, name));
  };
  for (const std::string_view name : kRivalPathNames) {
    if (value_of<RivalPath>(name) == RivalPath::Hybrid) add(kIncise);
    add(name);
  }
  std::vector<std::string> without;
  for (const PathResult& path : comparison.paths)
    if (!path.is_simulated) without.push_back(path.name);
  if (without.size() == 1) return comparison;  // the planned path alone is no rival
  comparison.best_without_simulation = best_of(trials, without);
  if (!comparison.best_without_simulation) return comparison;
  for (PathResult& path : comparison.paths) compare(trials, *comparison.best_without_simulation, path);
  return comparison;
}

nlohmann::ordered_json paths_json(const PathComparison& comparison) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const PathResult& path : comparison.paths) json[path.name] = to_json(path);
  return json;
}

std::string claim_of(const PathComparison& comparison, std::string_view name) {
  const PathResult* mine = comparison.find(name);
  if (mine == nullptr || !comparison.best_without_simulation || !mine->difference_mm) return {};
  std::string claim = fmt::format(
      "{} {:.2f} mm, {} {:.2f} mm (best without simulation) on {} specimen{}: difference {:+.2f} mm", name,
      *mine->compared_mean_mm, *comparison.best_without_simulation, *mine->compared_mean_mm - *mine->difference_mm,
      mine->compared, mine->compared == 1 ? "" : "s", *mine->difference_mm);
  if (mine->confidence) claim += fmt::format(" ({:+.2f} to {:+.2f})", mine->confidence->low, mine->confidence->high);
  if (mine->uncut > 0) claim += fmt::format("; {} not cut, because a step refused the path", mine->uncut);
  return claim;
}

}  // namespace incise::laboratory
