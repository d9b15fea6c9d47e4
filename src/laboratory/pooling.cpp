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
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <set>

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
  std::uint64_t seed = 0, specimens = 0, bench = 1;
  std::size_t photographs = 0;  ///< number given to the calibration
  TestedSeries tested;
  std::vector<AdvisedSpecimen> advised;
};

/// Returns a list of described values in a file. @throws DataError if there is none.
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

/// Requires an error of a measured cut, and of no other.
void check(const laboratory::PathCut& cut, const std::string& specimen, const std::filesystem::path& file) {
  if ((cut.end == laboratory::PathEnd::Measured) == cut.mean_abs_error_mm.has_value()) return;
  throw DataError(file, specimen,
                  fmt::format("a cut along {} that is {} and {} an error", cut.path, to_string(cut.end),
                              cut.mean_abs_error_mm ? "has" : "lacks"),
                  "an error only for measured cuts", kHint);
}

/// Requires known paths, each once, and a measured cut as planned.
void check(const TestedSpecimen& specimen, const std::filesystem::path& file) {
  const auto refuse = [&](const std::string& found, const char* expected) {
    throw DataError(file, specimen.name, found, expected, kHint);
  };
  const laboratory::PathCut* planned = specimen.find(laboratory::kAsPlannedPath);
  if (planned == nullptr || planned->end != laboratory::PathEnd::Measured)
    refuse("no measured cut as planned", "a measured cut as planned, with which every path is compared");
  std::set<std::string> paths;
  for (const laboratory::PathCut& cut : specimen.cuts) {
    const bool is_known = cut.path == laboratory::kAsPlannedPath || cut.path == laboratory::kIncisePath ||
                          value_of<laboratory::RivalPath>(cut.path).has_value();
    if (!is_known) refuse(fmt::format("path {}", cut.path), "as_planned, incise or a rival's");
    if (!paths.insert(cut.path).second) refuse(fmt::format("two cuts along {}", cut.path), "each path once");
    check(cut, specimen.name, file);
  }
  std::set<std::pair<std::size_t, std::string>> parts;
  for (const laboratory::LearningPathCut& learning : specimen.learning) {
    const std::string& path = learning.cut.path;
    const bool is_forecast =
        path == to_string(laboratory::RivalPath::Photographs) || path == to_string(laboratory::RivalPath::Learned);
    if (!is_forecast || learning.photographs == 0 || !parts.insert({learning.photographs, path}).second)
      refuse(fmt::format("path {} of {} photographs", path, learning.photographs),
             "photographs and learned, each once for each number of photographs above 0");
    check(learning.cut, specimen.name, file);
  }
}

/// Returns the number of photographs given to the calibration.
std::size_t photographs_in(const PoolJson& study, const std::filesystem::path& file) {
  if (!study.contains("table_2") || !study.at("table_2").is_array())
    throw DataError(file, "table_2", "no list", "a list of cuts", kHint);
  const PoolJson calibrated(to_string(laboratory::TrialRole::Calibrate));
  return static_cast<std::size_t>(std::ranges::count_if(study.at("table_2"), [&](const PoolJson& row) {
    return row.is_object() && row.value("role", PoolJson()) == calibrated &&
           row.value("mean_abs_error_mm", PoolJson()).is_number();
  }));
}

PooledSeries read_series(const std::filesystem::path& folder) {
  const std::filesystem::path claim = folder / "experiment.json", study = folder / "study.json";
  const PoolJson claimed = read_json(claim), found = read_json(study);
  PooledSeries series{.folder = folder};
  series.seed = count_in(claimed, claim, "seed");
  series.bench = claimed.contains("bench") ? count_in(claimed, claim, "bench") : 1;
  if (series.bench != 1 && series.bench != 2)
    throw DataError(claim, "bench", fmt::format("{}", series.bench), "1 or 2");
  series.specimens = count_in(found, study, "specimens");
  series.tested = list_in<TestedSpecimen>(found, study, "tested_specimens");
  std::set<std::string> names;
  for (const TestedSpecimen& specimen : series.tested) {
    check(specimen, study);
    if (!names.insert(specimen.name).second)
      throw DataError(study, "tested_specimens", fmt::format("{} twice", specimen.name), "each specimen once", kHint);
  }
  series.photographs = photographs_in(found, study);
  if (found.contains("advice") && found.at("advice").is_object())
    series.advised = list_in<AdvisedSpecimen>(found.at("advice"), study, "specimens");
  for (AdvisedSpecimen& specimen : series.advised) specimen.name = fmt::format("{}/{}", series.seed, specimen.name);
  return series;
}

/// Two experiments must not share a specimen: it would count twice.
void require_apart(const std::vector<PooledSeries>& all) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    const PooledSeries& one = all[i];
    const std::filesystem::path file = one.folder / "experiment.json";
    if (one.bench != all.front().bench)
      throw DataError(file, "bench", fmt::format("{}", one.bench),
                      fmt::format("{}, that of {}", all.front().bench, all.front().folder.string()));
    for (std::size_t j = 0; j < i; ++j) {
      const PooledSeries& other = all[j];
      const PooledSeries& first = one.seed < other.seed ? one : other;
      const std::uint64_t apart = std::max(one.seed, other.seed) - first.seed;
      if (apart < first.specimens || one.seed == other.seed)
        throw DataError(file, "seed", fmt::format("{}, {} specimens", one.seed, one.specimens),
                        fmt::format("seeds other than those of {}: {} specimens from {}", other.folder.string(),
                                    other.specimens, other.seed));
    }
  }
}

/// Requires the same paths everywhere: a path of only some series would be compared on other specimens.
void require_same_paths(const std::vector<PooledSeries>& all) {
  const auto paths_of = [](const PooledSeries& series) {
    std::set<std::string> paths;
    for (const TestedSpecimen& specimen : series.tested)
      for (const laboratory::PathCut& cut : specimen.cuts) paths.insert(cut.path);
    return paths;
  };
  const PooledSeries* first = nullptr;
  for (const PooledSeries& series : all) {
    if (series.tested.empty()) continue;
    if (first == nullptr) first = &series;
    if (paths_of(series) != paths_of(*first))
      throw DataError(series.folder / "study.json", "tested_specimens",
                      fmt::format("cuts along {}", fmt::join(paths_of(series), ", ")),
                      fmt::format("along {}, as in {}", fmt::join(paths_of(*first), ", "), first->folder.string()));
  }
}

PoolJson comparison_json(const std::vector<TestedSeries>& series, const PathComparison& paths) {
  std::size_t tested = 0;
  for (const TestedSeries& specimens : series) tested += specimens.size();
  PoolJson json{{"tested", tested}, {"rivals", laboratory::paths_json(paths)}};
  json["best_without_simulation"] = to_json(paths.best_without_simulation);
  return json;
}

/// Returns, for one series, the difference of every path from the best one over all series.
PoolJson series_json(const PooledSeries& series, const PathComparison& pooled) {
  PoolJson json{{"folder", series.folder.string()},
                {"seed", series.seed},
                {"specimens", series.specimens},
                {"photographs", series.photographs},
                {"tested", series.tested.size()}};
  json["tested_unlike"] = laboratory::of_likeness(series.tested, true).size();
  json["differences_mm"] = PoolJson::object();
  for (const PathResult& path : pooled.paths) {
    if (!pooled.best_without_simulation || path.name == *pooled.best_without_simulation) continue;
    json["differences_mm"][path.name] =
        to_json(laboratory::compare_two(std::span(&series.tested, 1), *pooled.best_without_simulation, path.name)
                    .difference_mm());
  }
  return json;
}

TextTable paths_csv(const std::vector<std::pair<std::string, PathComparison>>& parts) {
  TextTable csv{{"of", "path", "simulated", "pairs", "mean_mm", "worse", "harmed", "uncut", "closed", "close_margins",
                 "compared", "difference_mm", "low_mm", "high_mm"},
                {}};
  for (const auto& [of, paths] : parts) {
    for (const PathResult& p : paths.paths) {
      csv.rows.push_back({of, p.name, p.is_simulated ? "yes" : "no", fmt::format("{}", p.pairs), number_cell(p.mean_mm),
                          fmt::format("{}", p.worse), fmt::format("{}", p.harmed), fmt::format("{}", p.uncut),
                          fmt::format("{}", p.closed), fmt::format("{}", p.close_margins),
                          fmt::format("{}", p.compared), number_cell(p.difference_mm),
                          number_cell(p.confidence, &Interval::low), number_cell(p.confidence, &Interval::high)});
    }
  }
  return csv;
}

/// Draws the differences from the best path without simulation, side by side for each part that has one. @pre the first
/// has.
std::string paths_svg(const std::vector<std::pair<std::string, PathComparison>>& parts, std::size_t series) {
  CategoryPlot plot{.title = fmt::format("Virtual specimens of {} series: mean |error| minus that of the best path "
                                         "without simulation",
                                         series),
                    .categories = {},
                    .panels = {}};
  for (const PathResult& path : parts.front().second.paths) {
    const bool is_compared = std::ranges::any_of(parts, [&](const auto& part) {
      const PathResult* found = part.second.find(path.name);
      return found != nullptr && found->difference_mm.has_value();
    });
    if (is_compared && path.name != laboratory::kAsPlannedPath) plot.categories.push_back(path.name);
  }
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
    const bool has_intervals =
        std::ranges::any_of(paths.paths, [](const PathResult& path) { return path.confidence.has_value(); });
    if (!has_intervals) shown.low = shown.high = {};  // too few series
    plot.panels.push_back({fmt::format("{}: difference from {}, mm{}", of, *paths.best_without_simulation,
                                       has_intervals ? " (95 %)" : ""),
                           {shown}});
  }
  return category_plot_svg(plot);
}

/// Whether the series has a learning curve.
bool has_curve(const PooledSeries& series) {
  return std::ranges::any_of(series.tested, [](const TestedSpecimen& specimen) { return !specimen.learning.empty(); });
}

/// Of a series with fewer photographs than another one's point of the learning curve, the first so many are all.
void take_all_where_fewer(std::vector<PooledSeries>& all) {
  std::set<std::size_t> points;
  for (const PooledSeries& series : all) {
    for (const TestedSpecimen& specimen : series.tested)
      for (const laboratory::LearningPathCut& learning : specimen.learning) points.insert(learning.photographs);
  }
  for (PooledSeries& series : all) {
    for (TestedSpecimen& specimen : series.tested) {
      if (specimen.learning.empty()) continue;  // of a series without a curve
      std::size_t most = std::max<std::size_t>(series.photographs, 1) - 1;
      for (const laboratory::LearningPathCut& learning : specimen.learning) most = std::max(most, learning.photographs);
      for (auto point = points.upper_bound(most); point != points.end(); ++point) {
        for (const laboratory::RivalPath path : {laboratory::RivalPath::Photographs, laboratory::RivalPath::Learned})
          if (const laboratory::PathCut* cut = specimen.find(to_string(path)))
            specimen.learning.push_back({*point, *cut});
      }
    }
  }
}

}  // namespace

PoolJson pool_experiments(const std::vector<std::filesystem::path>& experiments, const std::filesystem::path& output,
                          const RunContext& run, Monitor& monitor) {
  INCISE_REQUIRE(experiments.size() >= 2,
                 fmt::format("expected at least two experiments, found {}", experiments.size()));
  const auto start = std::chrono::steady_clock::now();
  std::vector<PooledSeries> all;
  for (const std::filesystem::path& folder : experiments) all.push_back(read_series(folder));
  require_apart(all);
  require_same_paths(all);
  take_all_where_fewer(all);
  std::vector<TestedSeries> tested, unlike, like;
  std::vector<AdvisedSpecimen> advised;
  const bool is_by_series = static_cast<std::ptrdiff_t>(all.size()) >= laboratory::kFewestSeries;
  for (const PooledSeries& series : all) {
    tested.push_back(series.tested);
    unlike.push_back(laboratory::of_likeness(series.tested, true));
    like.push_back(laboratory::of_likeness(series.tested, false));
    for (AdvisedSpecimen specimen : series.advised) {
      if (is_by_series) specimen.series = tested.size();
      advised.push_back(std::move(specimen));
    }
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
  const std::vector<laboratory::LearningPoint> curve = laboratory::learning_curve(tested);
  result["learning"] = to_json(curve);
  PoolJson advice = laboratory::advice_scores(advised);
  if (advice.is_object()) advice["intervals_by"] = is_by_series ? "series" : "specimens";
  result["advice"] = advice;
  AtomicFolder folder(output);
  write_json(folder.path() / "pooled.json", result);
  write_atomically(folder.path() / "paths.csv", csv_text(paths_csv(parts)));
  const PathComparison& whole = parts.front().second;
  const bool is_drawn = std::ranges::any_of(whole.paths, [](const PathResult& path) {
    return path.difference_mm && path.name != laboratory::kAsPlannedPath;
  });
  if (is_drawn) write_atomically(folder.path() / "paths.svg", paths_svg(parts, all.size()));
  if (!curve.empty()) {
    double photographs = 0.0, curves = 0.0;
    for (const PooledSeries& series : all) {
      if (!has_curve(series)) continue;
      photographs += static_cast<double>(series.photographs);
      curves += 1.0;
    }
    write_atomically(folder.path() / "learning.svg",
                     line_plot_svg(laboratory::learning_plot(curve, photographs / curves)));
  }
  if (advice.is_object()) laboratory::draw_advice(folder.path(), advice);
  std::vector<std::filesystem::path> inputs;
  for (const PooledSeries& series : all)
    for (const char* file : {"experiment.json", "study.json"}) inputs.push_back(series.folder / file);
  const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_manifest(folder.path(), steps::manifest_of(run, "{}", inputs, wall_s));
  folder.commit();
  result["figure"] = is_drawn ? PoolJson((output / "paths.svg").string()) : PoolJson(nullptr);
  return result;
}

}  // namespace incise
