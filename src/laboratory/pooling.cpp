#include "laboratory/experiment_advice.hpp"
#include "laboratory/experiment_rivals.hpp"

#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/table_io.hpp>
#include <incise/laboratory/pooling.hpp>
#include <incise/report/category_plot.hpp>
#include <incise/steps/case_steps.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace incise {
namespace {

using laboratory::AdvisedSpecimen;
using laboratory::PathComparison;
using laboratory::PathResult;
using laboratory::TestedSeries;
using laboratory::TestedSpecimen;
using PoolJson = nlohmann::ordered_json;

constexpr const char* kHint = "Finish it with `incise experiment` of this version";

/// One finished experiment.
struct PooledSeries {
  std::filesystem::path folder;
  std::uint64_t seed = 0, specimens = 0;
  int bench = 1;
  std::size_t calibrated_on = 0;  ///< photographs
  TestedSeries tested;
  std::vector<AdvisedSpecimen> advised;
};

/// A list of described values in a file. @throws DataError where there is none.
template <class T>
std::vector<T> list_in(const PoolJson& json, const std::filesystem::path& file, const char* key) {
  if (!json.is_object() || !json.contains(key) || !json.at(key).is_array())
    throw DataError(file, key, "no list", "a list of specimens", kHint);
  std::vector<T> values;
  for (std::size_t i = 0; i < json.at(key).size(); ++i)
    values.push_back(from_json<T>(json.at(key)[i], file, fmt::format("/{}/{}", key, i), kHint));
  return values;
}

std::uint64_t count_in(const PoolJson& json, const std::filesystem::path& file, const char* key) {
  if (!json.is_object() || !json.contains(key) || !json.at(key).is_number_unsigned())
    throw DataError(file, key, json.is_object() && json.contains(key) ? json.at(key).dump() : "nothing",
                    "a whole number", kHint);
  return json.at(key).get<std::uint64_t>();
}

/// Paths and ends that go together, so that what is read can be counted.
void check(const TestedSpecimen& specimen, const std::filesystem::path& file) {
  const auto refuse = [&](const std::string& found, const char* expected) {
    throw DataError(file, specimen.name, found, expected, kHint);
  };
  const laboratory::PathCut* planned = specimen.find(laboratory::kAsPlannedPath);
  if (planned == nullptr || planned->end != laboratory::PathEnd::Measured)
    refuse("no measured cut as planned", "one: it is what every path is held against");
  for (const laboratory::PathCut& cut : specimen.cuts) {
    const bool is_known = cut.path == laboratory::kAsPlannedPath || cut.path == laboratory::kIncisePath ||
                          value_of<laboratory::RivalPath>(cut.path).has_value();
    if (!is_known) refuse(fmt::format("path {}", cut.path), "as_planned, incise or a rival's");
    if ((cut.end == laboratory::PathEnd::Measured) != cut.mean_abs_error_mm.has_value())
      refuse(fmt::format("a cut along {} that is {} and {} an error", cut.path, to_string(cut.end),
                         cut.mean_abs_error_mm ? "has" : "lacks"),
             "an error for measured cuts alone");
  }
}

/// Photographs that entered the calibration.
std::size_t calibrated_on(const PoolJson& study, const std::filesystem::path& file) {
  for (const char* key : {"table_2", "left_out_of_calibration"})
    if (!study.contains(key) || !study.at(key).is_array()) throw DataError(file, key, "no list", "a list", kHint);
  const auto measured = std::ranges::count_if(study.at("table_2"), [](const PoolJson& row) {
    return row.is_object() && row.value("role", "") == to_string(laboratory::TrialRole::Calibrate) &&
           row.value("mean_abs_error_mm", PoolJson()).is_number();
  });
  return static_cast<std::size_t>(measured) -
         std::min<std::size_t>(static_cast<std::size_t>(measured), study.at("left_out_of_calibration").size());
}

PooledSeries read_series(const std::filesystem::path& folder) {
  const std::filesystem::path claim = folder / "experiment.json", study = folder / "study.json";
  const PoolJson claimed = read_json(claim), found = read_json(study);
  PooledSeries series{.folder = folder};
  series.seed = count_in(claimed, claim, "seed");
  series.bench = claimed.contains("bench") ? static_cast<int>(count_in(claimed, claim, "bench")) : 1;
  series.specimens = count_in(found, study, "specimens");
  series.tested = list_in<TestedSpecimen>(found, study, "tested_specimens");
  for (const TestedSpecimen& specimen : series.tested) check(specimen, study);
  series.calibrated_on = calibrated_on(found, study);
  const std::filesystem::path advice = folder / "advice/advice.json";
  if (found.contains("advice") && found.at("advice").is_object())
    series.advised = list_in<AdvisedSpecimen>(read_json(advice), advice, "specimens");
  return series;
}

/// Two experiments must not share a specimen: it would count twice.
void require_apart(const std::vector<PooledSeries>& all) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::filesystem::path file = all[i].folder / "experiment.json";
    if (all[i].bench != all.front().bench)
      throw DataError(file, "bench", fmt::format("{}", all[i].bench),
                      fmt::format("{}, that of {}", all.front().bench, all.front().folder.string()));
    for (std::size_t j = 0; j < i; ++j) {
      const bool is_shared =
          all[i].seed < all[j].seed + all[j].specimens && all[j].seed < all[i].seed + all[i].specimens;
      if (is_shared)
        throw DataError(file, "seed", fmt::format("{}, {} specimens", all[i].seed, all[i].specimens),
                        fmt::format("seeds other than those of {}: {} to {}", all[j].folder.string(), all[j].seed,
                                    all[j].seed + all[j].specimens - 1));
    }
  }
}

PoolJson comparison_json(const std::vector<TestedSeries>& series, const PathComparison& paths) {
  std::size_t tested = 0;
  for (const TestedSeries& specimens : series) tested += specimens.size();
  PoolJson json{{"tested", tested}, {"rivals", laboratory::paths_json(paths)}};
  json["best_without_simulation"] =
      paths.best_without_simulation ? PoolJson(*paths.best_without_simulation) : PoolJson(nullptr);
  return json;
}

/// Of one series: the mean along every path, on the specimens where the best one over all series closed, too.
PoolJson series_json(const PooledSeries& series, const PathComparison& pooled) {
  PoolJson json{{"folder", series.folder.string()},
                {"seed", series.seed},
                {"specimens", series.specimens},
                {"calibrated_on", series.calibrated_on},
                {"tested", series.tested.size()}};
  json["unlike"] = laboratory::of_likeness(series.tested, true).size();
  json["differences_mm"] = PoolJson::object();
  for (const PathResult& path : pooled.paths) {
    if (!pooled.best_without_simulation || path.name == *pooled.best_without_simulation) continue;
    const auto difference =
        laboratory::compare_two(std::span(&series.tested, 1), *pooled.best_without_simulation, path.name)
            .difference_mm();
    json["differences_mm"][path.name] = difference ? PoolJson(*difference) : PoolJson(nullptr);
  }
  return json;
}

TextTable paths_csv(const std::vector<std::pair<std::string, PathComparison>>& parts) {
  TextTable csv{{"of", "path", "simulated", "pairs", "mean_mm", "worse", "harmed", "uncut", "closed", "close_margins",
                 "compared", "difference_mm", "low_mm", "high_mm"},
                {}};
  const auto text = [](const std::optional<double>& value) { return value ? fmt::format("{}", *value) : ""; };
  for (const auto& [of, paths] : parts) {
    for (const PathResult& p : paths.paths) {
      csv.rows.push_back({of, p.name, p.is_simulated ? "yes" : "no", fmt::format("{}", p.pairs), text(p.mean_mm),
                          fmt::format("{}", p.worse), fmt::format("{}", p.harmed), fmt::format("{}", p.uncut),
                          fmt::format("{}", p.closed), fmt::format("{}", p.close_margins),
                          fmt::format("{}", p.compared), text(p.difference_mm),
                          text(p.confidence ? std::optional(p.confidence->low) : std::nullopt),
                          text(p.confidence ? std::optional(p.confidence->high) : std::nullopt)});
    }
  }
  return csv;
}

/// Differences from the best path without simulation, side by side for each part that has one. @pre the first has.
std::string paths_svg(const std::vector<std::pair<std::string, PathComparison>>& parts, std::size_t series) {
  CategoryPlot plot{.title = fmt::format("Virtual specimens of {} series: mean |error| less that of the best path "
                                         "without simulation",
                                         series),
                    .categories = {},
                    .panels = {}};
  for (const PathResult& path : parts.front().second.paths)
    if (path.difference_mm && path.name != laboratory::kAsPlannedPath) plot.categories.push_back(path.name);
  for (const auto& [of, paths] : parts) {
    if (!paths.best_without_simulation) continue;
    CategorySeries shown{.name = "", .values = {}, .low = {}, .high = {}};
    for (const std::string& name : plot.categories) {
      const PathResult* path = paths.find(name);
      const double middle = path != nullptr ? path->difference_mm.value_or(0.0) : 0.0;
      shown.values.push_back(middle);
      shown.low.push_back(path != nullptr && path->confidence ? path->confidence->low : middle);
      shown.high.push_back(path != nullptr && path->confidence ? path->confidence->high : middle);
    }
    plot.panels.push_back({fmt::format("{}: less {}, mm (95 %)", of, *paths.best_without_simulation), {shown}});
  }
  return category_plot_svg(plot);
}

}  // namespace

PoolJson pool_experiments(const std::vector<std::filesystem::path>& experiments, const std::filesystem::path& output,
                          const RunContext& run, Monitor& monitor) {
  INCISE_REQUIRE(experiments.size() >= 2,
                 fmt::format("expected two experiments or more, found {}", experiments.size()));
  const auto start = std::chrono::steady_clock::now();
  std::vector<PooledSeries> all;
  for (const std::filesystem::path& folder : experiments) all.push_back(read_series(folder));
  require_apart(all);
  std::vector<TestedSeries> tested, unlike, like;
  std::vector<AdvisedSpecimen> advised;
  for (const PooledSeries& series : all) {
    tested.push_back(series.tested);
    unlike.push_back(laboratory::of_likeness(series.tested, true));
    like.push_back(laboratory::of_likeness(series.tested, false));
    advised.insert(advised.end(), series.advised.begin(), series.advised.end());
    if (series.tested.empty())
      monitor.message(Severity::Warning,
                      fmt::format("{}: no test specimen was measured as planned", series.folder.string()));
  }
  const std::vector<std::pair<std::string, PathComparison>> parts{{"all", laboratory::compare_paths(tested)},
                                                                  {"unlike", laboratory::compare_paths(unlike)},
                                                                  {"like", laboratory::compare_paths(like)}};
  PoolJson result;
  result["specimen_is"] = "virtual";
  result["bench"] = all.front().bench;
  result["series"] = PoolJson::array();
  for (const PooledSeries& series : all) result["series"].push_back(series_json(series, parts.front().second));
  result.update(comparison_json(tested, parts[0].second));
  result["unlike"] = comparison_json(unlike, parts[1].second);
  result["like"] = comparison_json(like, parts[2].second);
  const std::string default_path{laboratory::kIncisePath}, robust{to_string(laboratory::RivalPath::Robust)};
  result["robust_against_default"] = to_json(laboratory::compare_two(tested, default_path, robust));
  const PoolJson advice = laboratory::advice_scores(advised);
  result["advice"] = advice;
  AtomicFolder folder(output);
  write_json(folder.path() / "pooled.json", result);
  write_atomically(folder.path() / "paths.csv", csv_text(paths_csv(parts)));
  const PathComparison& whole = parts.front().second;
  const bool is_drawn = std::ranges::any_of(whole.paths, [](const PathResult& path) {
    return path.difference_mm && path.name != laboratory::kAsPlannedPath;
  });
  if (is_drawn) write_atomically(folder.path() / "paths.svg", paths_svg(parts, all.size()));
  if (advice.is_object()) laboratory::draw_advice(folder.path(), advice);
  std::vector<std::filesystem::path> inputs;
  for (const PooledSeries& series : all) inputs.push_back(series.folder / "study.json");
  const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_manifest(folder.path(), steps::manifest_of(run, "{}", inputs, wall_s));
  folder.commit();
  result["figure"] = is_drawn ? PoolJson((output / "paths.svg").string()) : PoolJson(nullptr);
  return result;
}

}  // namespace incise
