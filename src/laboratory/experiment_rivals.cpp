#include "laboratory/experiment_rivals.hpp"

#include <incise/core/described_json.hpp>
#include <incise/evaluation/cluster_bootstrap.hpp>
#include <incise/evaluation/t_tests.hpp>
#include <incise/workflow/case.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace incise::laboratory {
namespace {

constexpr double kHarmMm = 0.1;

/// Returns a specimen's photographed mean |error| along a path, mm; absent: no closed ring, or not requested.
std::optional<double> error_along(const TestedSpecimen& specimen, std::string_view name) {
  const PathCut* cut = specimen.find(name);
  return cut != nullptr && cut->end == PathEnd::Measured ? cut->mean_abs_error_mm : std::nullopt;
}

/// Adds the result of a path in one specimen.
void add_cut(const TestedSpecimen& specimen, const PathCut& cut, PathResult& result, double& sum_mm) {
  if (cut.end == PathEnd::NotCut) {
    ++result.uncut;
    return;
  }
  if (cut.least_margin_mm) {
    ++result.closed;
    if (*cut.least_margin_mm < Case{}.close_margin_mm) ++result.close_margins;
  }
  if (cut.end == PathEnd::Open) {
    ++result.worse;
    ++result.harmed;
    return;
  }
  const double change_mm = *cut.mean_abs_error_mm - error_along(specimen, kAsPlannedPath).value();
  ++result.pairs;
  sum_mm += *cut.mean_abs_error_mm;
  if (change_mm > 0.0) ++result.worse;
  if (change_mm > kHarmMm) ++result.harmed;
}

PathResult result_along(std::span<const TestedSeries> series, std::string_view name) {
  PathResult result{.name = std::string(name), .is_simulated = !is_path_without_simulation(name)};
  double sum_mm = 0.0;
  for (const TestedSeries& specimens : series) {
    for (const TestedSpecimen& specimen : specimens)
      if (const PathCut* cut = specimen.find(name)) add_cut(specimen, *cut, result, sum_mm);
  }
  if (result.pairs > 0) result.mean_mm = sum_mm / static_cast<double>(result.pairs);
  return result;
}

/// Errors along two paths, of the specimens whose rings closed along both.
struct PairedErrors {
  std::vector<double> first, second;
  std::vector<std::vector<double>> differences;  ///< by series: second minus first
};

PairedErrors paired_errors(std::span<const TestedSeries> series, std::string_view first, std::string_view second) {
  PairedErrors errors;
  for (const TestedSeries& specimens : series) {
    std::vector<double>& differences = errors.differences.emplace_back();
    for (const TestedSpecimen& specimen : specimens) {
      const std::optional<double> of_first = error_along(specimen, first), of_second = error_along(specimen, second);
      if (!of_first || !of_second) continue;
      errors.first.push_back(*of_first);
      errors.second.push_back(*of_second);
      differences.push_back(*of_second - *of_first);
    }
  }
  return errors;
}

/// Returns the interval of the mean difference. Specimens of one series share a calibration and a hand-eye offset, so
/// with several series, whole series are resampled.
std::optional<Interval> interval_of(const PairedErrors& errors) {
  if (errors.differences.size() > 1) {
    const auto compared = std::ranges::count_if(errors.differences, [](const auto& one) { return !one.empty(); });
    return compared >= kFewestSeries ? cluster_bootstrap(errors.differences) : std::nullopt;
  }
  return paired_t_test(errors.first, errors.second).confidence;
}

/// Against the best path, specimen by specimen.
void compare(std::span<const TestedSeries> series, std::string_view best, PathResult& result) {
  const PairedErrors errors = paired_errors(series, best, result.name);
  result.compared = errors.first.size();
  if (errors.first.empty()) return;
  result.compared_mean_mm = moments_of(errors.second).mean;
  if (result.name == best) return;
  result.difference_mm = *result.compared_mean_mm - moments_of(errors.first).mean;
  result.confidence = interval_of(errors);
}

/// See PathComparison. @param names  the paths without a simulated cut.
std::optional<std::string> best_of(std::span<const TestedSeries> series, const std::vector<std::string>& names) {
  std::vector<double> sums(names.size(), 0.0);
  bool is_any_common = false;
  const auto add = [&](const TestedSpecimen& specimen) {
    std::vector<double> errors;
    for (const std::string& name : names) {
      if (const std::optional<double> error = error_along(specimen, name)) errors.push_back(*error);
    }
    if (errors.size() != names.size()) return;
    is_any_common = true;
    for (std::size_t i = 0; i < names.size(); ++i) sums[i] += errors[i];
  };
  for (const TestedSeries& specimens : series)
    for (const TestedSpecimen& specimen : specimens) add(specimen);
  if (!is_any_common) return std::nullopt;
  return names[static_cast<std::size_t>(std::min_element(sums.begin(), sums.end()) - sums.begin())];
}

/// Returns as_planned and every other path along which a specimen should be cut, in order.
std::vector<std::string> paths_of(std::span<const TestedSeries> series) {
  std::vector<std::string> names{std::string(kAsPlannedPath)};
  const auto add = [&names](const TestedSpecimen& specimen) {
    for (const PathCut& cut : specimen.cuts)
      if (std::find(names.begin(), names.end(), cut.path) == names.end()) names.push_back(cut.path);
  };
  for (const TestedSeries& specimens : series)
    for (const TestedSpecimen& specimen : specimens) add(specimen);
  return names;
}

}  // namespace

void describe(Visitor& v, PathResult& r) {
  v("name", r.name, "Name of the path.");
  v({"mean_mm", "Mean over specimens of the photographs' mean |error|.", "mm"}, r.mean_mm);
  v("worse", r.worse, "Specimens whose error grew, or whose ring opened.");
  v("harmed", r.harmed, "Of the worse ones: those that grew by more than 0.1 mm, or opened.");
  v("closed", r.closed, "Cuts whose ring truly closed.");
  v("close_margins", r.close_margins,
    "Of the closed ones: those with less tissue beside the tumour than the close margin somewhere.");
  v("pairs", r.pairs, "Specimens with a closed ring along this path and as planned.");
  v("uncut", r.uncut, "Specimens that were cut as planned but not along this path.");
  v("simulated", r.is_simulated, "Whether a simulated cut takes part in the path.");
  v("compared", r.compared, "Of the pairs: those that also have a closed ring along the best path without simulation.");
  v({"compared_mean_mm", "As mean_mm, over the compared specimens.", "mm"}, r.compared_mean_mm);
  v({"difference_mm",
     "Over the compared specimens: mean minus that along the best path without simulation; negative: better.", "mm"},
    r.difference_mm);
  describe_interval(v, {"confidence_mm", "95 % interval of difference_mm, paired by specimen.", "mm"}, r.confidence);
}

void describe(Visitor& v, PathPair& p) {
  v("first", p.first, "Name of the first path.");
  v("second", p.second, "Name of the second path.");
  v("compared", p.compared, "Specimens with closed rings along both paths, in the photographs.");
  v({"first_mm", "Mean |error| along the first path, mean over the compared specimens.", "mm"}, p.first_mm);
  v({"second_mm", "Mean |error| along the second path, mean over the compared specimens.", "mm"}, p.second_mm);
  v.derived("difference_mm", p.difference_mm(), "The second mean minus the first.");
  describe_interval(v, {"confidence_mm", "95 % interval of difference_mm.", "mm"}, p.confidence);
  v("closed", p.closed, "Specimens whose rings truly closed along both paths.");
  v("close_margins_first", p.close_margins_first,
    "Of the closed ones: those closer to the edge than the close margin somewhere, along the first path.");
  v("close_margins_second", p.close_margins_second, "The same along the second path.");
}

const PathResult* PathComparison::find(std::string_view name) const {
  const auto place = std::find_if(paths.begin(), paths.end(), [name](const PathResult& p) { return p.name == name; });
  return place != paths.end() ? &*place : nullptr;
}

PathComparison compare_paths(std::span<const TestedSeries> series) {
  PathComparison comparison;
  for (const std::string& name : paths_of(series)) comparison.paths.push_back(result_along(series, name));
  std::vector<std::string> without;
  for (const PathResult& path : comparison.paths)
    if (!path.is_simulated) without.push_back(path.name);
  if (without.size() == 1) return comparison;  // the planned path is no rival
  comparison.best_without_simulation = best_of(series, without);
  if (!comparison.best_without_simulation) return comparison;
  for (PathResult& path : comparison.paths) compare(series, *comparison.best_without_simulation, path);
  return comparison;
}

PathPair compare_two(std::span<const TestedSeries> series, std::string_view first, std::string_view second) {
  PathPair pair{.first = std::string(first), .second = std::string(second)};
  for (const TestedSeries& specimens : series) {
    for (const TestedSpecimen& specimen : specimens) {
      const PathCut* one = specimen.find(first);
      const PathCut* other = specimen.find(second);
      if (one == nullptr || other == nullptr || !one->least_margin_mm || !other->least_margin_mm) continue;
      ++pair.closed;
      if (*one->least_margin_mm < Case{}.close_margin_mm) ++pair.close_margins_first;
      if (*other->least_margin_mm < Case{}.close_margin_mm) ++pair.close_margins_second;
    }
  }
  const PairedErrors errors = paired_errors(series, first, second);
  pair.compared = errors.first.size();
  if (errors.first.empty()) return pair;
  pair.first_mm = moments_of(errors.first).mean;
  pair.second_mm = moments_of(errors.second).mean;
  pair.confidence = interval_of(errors);
  return pair;
}

std::vector<LearningPoint> learning_curve(std::span<const TestedSeries> series) {
  const std::string without{to_string(RivalPath::Photographs)}, with{to_string(RivalPath::Learned)};
  std::set<std::size_t> parts;
  for (const TestedSeries& specimens : series) {
    for (const TestedSpecimen& specimen : specimens)
      for (const LearningPathCut& learning : specimen.learning) parts.insert(learning.photographs);
  }
  if (parts.empty()) return {};
  std::vector<std::optional<std::size_t>> points{0};
  points.insert(points.end(), parts.begin(), parts.end());
  points.emplace_back(std::nullopt);
  // Returns both cuts of one specimen at each point, as if they were its only ones; nothing if one is missing.
  const auto cuts_at = [&](const TestedSpecimen& specimen, std::optional<std::size_t> photographs,
                           std::string_view path) -> std::optional<PathCut> {
    if (photographs && *photographs > 0) {
      for (const LearningPathCut& learning : specimen.learning)
        if (learning.photographs == *photographs && learning.cut.path == path) return learning.cut;
      return std::nullopt;
    }
    std::string_view name = path;
    if (photographs) name = path == without ? kAsPlannedPath : to_string(RivalPath::Uncalibrated);
    const PathCut* found = specimen.find(name);
    if (found == nullptr) return std::nullopt;
    PathCut cut = *found;
    cut.path = path;
    return cut;
  };
  std::vector<std::vector<TestedSeries>> at_point(points.size(), std::vector<TestedSeries>(series.size()));
  for (std::size_t i = 0; i < series.size(); ++i) {
    for (const TestedSpecimen& specimen : series[i]) {
      std::vector<TestedSpecimen> shown;
      for (const std::optional<std::size_t>& photographs : points) {
        const auto first = cuts_at(specimen, photographs, without), second = cuts_at(specimen, photographs, with);
        if (!first || !second || first->end != PathEnd::Measured || second->end != PathEnd::Measured) break;
        shown.push_back({specimen.name, specimen.unlike, {*first, *second}, {}});
      }
      if (shown.size() != points.size()) continue;
      for (std::size_t k = 0; k < points.size(); ++k) at_point[k][i].push_back(std::move(shown[k]));
    }
  }
  std::vector<LearningPoint> curve;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const PathPair pair = compare_two(at_point[k], without, with);
    if (pair.compared == 0) return {};
    curve.push_back({points[k], pair});
  }
  return curve;
}

LinePlot learning_plot(const std::vector<LearningPoint>& curve, double all) {
  LinePlot plot{.title =
                    "Virtual specimens: what photographs of earlier cuts are worth, on the specimens whose "
                    "rings closed along every path",
                .x_label = "photographs in the calibration",
                .y_label = "mean |error|, mm",
                .series = {}};
  LineSeries without{"forecast without simulation", {}, {}, true}, with{"with simulation", {}, {}, true};
  for (const LearningPoint& point : curve) {
    const double photographs = point.photographs ? static_cast<double>(*point.photographs) : all;
    without.add(photographs, *point.pair.first_mm);
    with.add(photographs, *point.pair.second_mm);
  }
  plot.series = {std::move(without), std::move(with)};
  return plot;
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
