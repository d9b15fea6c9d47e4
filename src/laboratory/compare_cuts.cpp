#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_text.hpp>
#include <incise/laboratory/comparison_tables.hpp>
#include <incise/laboratory/cut_steps.hpp>
#include <incise/report/comparison_figures.hpp>
#include <incise/report/svg_png.hpp>
#include <incise/storage/evaluation_file.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise::laboratory {
namespace {

using Json = nlohmann::ordered_json;

struct ComparedFiles {
  std::vector<EvaluationFile> before;
  std::vector<EvaluationFile> after;
};

struct ComparisonOutput {
  ComparedFiles files;
  ComparisonSettings settings;
  nlohmann::ordered_json json;  ///< what --json prints and compare.json holds
};

template <class Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json interval_json(const std::optional<Interval>& interval) {
  return interval ? Json::array({interval->low, interval->high}) : Json(nullptr);
}

Json test_json(const TTest& test, const char* name) {
  return {{"test", name},
          {"t", or_null(test.t)},
          {"df", or_null(test.df)},
          {"p", or_null(test.p)},
          {"difference_mm", test.difference},
          {"standard_error_mm", or_null(test.standard_error)},
          {"confidence_mm", interval_json(test.confidence)},
          {"verdict", to_string(test.verdict)}};
}

Json effect_json(const std::optional<EffectSize>& effect) {
  if (!effect) return nullptr;
  return {{"hedges_g", effect->hedges_g},
          {"cohens_d", effect->cohens_d},
          {"confidence", Json::array({effect->confidence.low, effect->confidence.high})}};
}

Json points_json_of(const PooledTests& points, const ComparisonSettings& settings) {
  Json json = test_json(points.student, "student, pooled by point");
  json["n_before"] = points.before.n;
  json["n_after"] = points.after.n;
  json["welch"] = test_json(points.welch, "welch, pooled by point");
  json["effect"] = effect_json(points.effect);
  json["n_effective_before"] = points.n_effective_before;
  json["n_effective_after"] = points.n_effective_after;
  json["block_bootstrap"] = {{"p", or_null(points.bootstrap.p)},
                             {"difference_mm", points.bootstrap.difference},
                             {"standard_error_mm", or_null(points.bootstrap.standard_error)},
                             {"confidence_mm", interval_json(points.bootstrap.confidence)},
                             {"verdict", to_string(points.bootstrap.verdict)},
                             {"replicates", settings.bootstrap.replicates},
                             {"seed", settings.bootstrap.seed}};
  return json;
}

Json specimens_json(const SpecimenTests& specimens) {
  Json json = test_json(specimens.main(), specimens.paired ? "paired, by specimen" : "welch, by specimen");
  json["n_before"] = specimens.before.n;
  json["n_after"] = specimens.after.n;
  json["mean_before_mm"] = specimens.before.mean;
  json["mean_after_mm"] = specimens.after.mean;
  json["student"] = test_json(specimens.student, "student, by specimen");
  json["welch"] = test_json(specimens.welch, "welch, by specimen");
  json["paired"] = specimens.paired ? test_json(*specimens.paired, "paired, by specimen") : Json(nullptr);
  json["effect"] = effect_json(specimens.effect);
  json["fewest_specimens"] = or_null(specimens.fewest);
  return json;
}

Json row_json(const EvaluationFile& file, bool is_after, const Comparison* comparison) {
  Json json{{"name", file.specimen.name},
            {"side", is_after ? "after" : "before"},
            {"outcome", to_string(file.outcome)},
            {"hu_score", or_null(file.hu_score)},
            {"hu_score_ideal", or_null(file.hu_score_ideal)},
            {"centroid_shift_mm", or_null(file.centroid_shift_mm)},
            {"n_points", file.specimen.signed_error_mm.size()}};
  if (comparison == nullptr) return json;
  for (const SpecimenRow& row : comparison->rows) {
    if (row.name != file.specimen.name || row.is_after != is_after) continue;
    json["mean_mm"] = row.error_mm.mean;
    json["sd_mm"] = row.error_mm.sd;
    json["block_points"] = row.correlation.block;
    json["n_effective"] = or_null(row.correlation.n_effective);
  }
  return json;
}

std::vector<MeasuredSpecimen> measured(const std::vector<EvaluationFile>& files) {
  std::vector<MeasuredSpecimen> specimens;
  for (const EvaluationFile& file : files) {
    if (!file.specimen.signed_error_mm.empty()) specimens.push_back(file.specimen);
  }
  return specimens;
}

/// Names tell specimens apart in tables and figures: files of one name get their number within the side.
void tell_apart(std::vector<EvaluationFile>& files) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string name = files[i].specimen.name;
    std::size_t same = 1;
    for (std::size_t k = i + 1; k < files.size(); ++k) {
      if (files[k].specimen.name == name) files[k].specimen.name = fmt::format("{} ({})", name, ++same);
    }
    if (same > 1) files[i].specimen.name = name + " (1)";
  }
}

std::vector<ErrorSeries> series_of(const ComparedFiles& files) {
  std::vector<ErrorSeries> series;
  for (const bool is_after : {false, true}) {
    for (const EvaluationFile& file : is_after ? files.after : files.before) {
      if (file.specimen.signed_error_mm.empty()) continue;
      series.push_back({file.specimen.name, is_after, file.specimen.signed_error_mm, file.clock_h});
    }
  }
  return series;
}

/// Of the first incision that has them; all are measured alike.
ZoneBorders borders_of(const ComparedFiles& files) {
  for (const auto* side : {&files.before, &files.after}) {
    for (const EvaluationFile& file : *side) {
      if (file.positive_at_mm && file.too_close_at_mm) return {*file.positive_at_mm, *file.too_close_at_mm};
    }
  }
  return {};
}

void write_both(const std::filesystem::path& folder, const std::string& name, const std::string& svg) {
  write_atomically(folder / (name + ".svg"), svg);
  write_atomically(folder / (name + ".png"), png_of_svg(svg));
}

void write_figures(const std::filesystem::path& folder, const ComparedFiles& files) {
  const std::vector<ErrorSeries> series = series_of(files);
  if (series.empty()) return;
  const ZoneBorders zones = borders_of(files);
  write_both(folder, "box_plot", comparison_box_plot_svg(series, zones));
  const bool has_clock =
      std::none_of(series.begin(), series.end(), [](const auto& one) { return one.clock_h.empty(); });
  if (has_clock) write_both(folder, "error_by_clock", error_by_clock_svg(series, zones));
}

/// Compares the specimens that have errors. Those on which no incision was found stay in the table, are named under
/// `left_out` and make no mean better. A side without any errors has a verdict, `too_few`, and no test.
ComparisonOutput compared(ComparedFiles files, const ComparisonSettings& settings) {
  tell_apart(files.before);
  tell_apart(files.after);
  ComparisonOutput output{.files = std::move(files), .settings = settings, .json = {}};
  const std::vector<MeasuredSpecimen> before = measured(output.files.before);
  const std::vector<MeasuredSpecimen> after = measured(output.files.after);
  // Of a pair, both or neither can be tested; which to leave out is the person's choice.
  const bool is_whole = before.size() == output.files.before.size() && after.size() == output.files.after.size();
  if (settings.is_paired && !is_whole) {
    throw DataError("--paired", "", "an evaluation without an incision", "errors in every file",
                    "Leave out both files of that specimen");
  }
  std::optional<Comparison> comparison;
  if (!before.empty() && !after.empty()) comparison = compare(before, after, settings);

  Json& json = output.json;
  json["measure"] = to_string(settings.measure);
  json["contour"] = to_string(output.files.before.front().contour);
  json["target_mm"] = output.files.before.front().target_mm;
  json["mean_before_mm"] = comparison ? Json(comparison->points.before.mean) : Json(nullptr);
  json["mean_after_mm"] = comparison ? Json(comparison->points.after.mean) : Json(nullptr);
  json["verdict"] = to_string(comparison ? TestVerdict::Tested : TestVerdict::TooFew);
  json["points"] = comparison ? points_json_of(comparison->points, settings) : Json(nullptr);
  json["specimens"] = comparison ? specimens_json(comparison->specimens) : Json(nullptr);
  json["alpha"] = settings.alpha;
  json["power"] = settings.power;
  json["rows"] = Json::array();
  json["left_out"] = Json::array();
  for (const bool is_after : {false, true}) {
    for (const EvaluationFile& file : is_after ? output.files.after : output.files.before) {
      json["rows"].push_back(row_json(file, is_after, comparison ? &*comparison : nullptr));
      if (file.specimen.signed_error_mm.empty()) {
        json["left_out"].push_back({{"name", file.specimen.name}, {"outcome", to_string(file.outcome)}});
      }
    }
  }
  return output;
}

void write_comparison(const std::filesystem::path& folder, const ComparisonOutput& output,
                      const std::vector<std::filesystem::path>& inputs, const StepContext& context) {
  require_replaceable(folder);
  AtomicFolder target(folder);
  write_json(target.path() / "compare.json", output.json);
  const TextTable results = result_table(output.json);
  write_atomically(target.path() / "table.csv", csv_text(results));
  write_atomically(target.path() / "table.tex", latex_text(results));
  const TextTable tests = test_table(output.json);
  write_atomically(target.path() / "tests.csv", csv_text(tests));
  write_atomically(target.path() / "tests.tex", latex_text(tests));
  write_figures(target.path(), output.files);
  const Json settings{{"measure", output.json["measure"]},
                      {"paired", output.settings.is_paired},
                      {"alpha", output.settings.alpha},
                      {"power", output.settings.power},
                      {"replicates", output.settings.bootstrap.replicates}};
  Manifest manifest = manifest_of(context.run, json_text(settings), inputs, context.wall_s());
  manifest.specimen_id.clear();  // it is of several
  write_manifest(target.path(), manifest);
  target.commit();
}

std::vector<EvaluationFile> read_all(const std::vector<std::filesystem::path>& paths) {
  std::vector<EvaluationFile> files;
  for (const auto& path : paths) files.push_back(read_evaluation_file(path));
  return files;
}

/// Like is compared with like: the same line of the cut, against the same target, with the same zones.
void require_alike(const CompareRequest& request, const ComparedFiles& files) {
  const EvaluationFile& first = files.before.front();
  const auto check = [&](const std::filesystem::path& path, const EvaluationFile& file) {
    const auto refuse = [&](const char* key, const std::string& found, const std::string& expected) {
      throw DataError(path, key, found, fmt::format("{} as in {}", expected, request.before.front().string()),
                      "Only like is compared with like");
    };
    if (file.contour != first.contour) refuse("contour", std::string(to_string(file.contour)), std::string(to_string(first.contour)));
    if (file.target_mm != first.target_mm) {
      refuse("target_mm", fmt::format("{}", file.target_mm), fmt::format("{}", first.target_mm));
    }
  };
  for (std::size_t i = 0; i < request.before.size(); ++i) check(request.before[i], files.before[i]);
  for (std::size_t i = 0; i < request.after.size(); ++i) check(request.after[i], files.after[i]);
}

}  // namespace

StepResult compare_cuts(const CompareRequest& request, const StepContext& context) {
  std::vector<std::filesystem::path> inputs = request.before;
  inputs.insert(inputs.end(), request.after.begin(), request.after.end());
  ComparedFiles files{read_all(request.before), read_all(request.after)};
  require_alike(request, files);
  ComparisonOutput output = compared(std::move(files), request.settings);
  if (!request.output.empty()) write_comparison(request.output, output, inputs, context);
  const bool is_tested = !output.json["points"].is_null();
  return {std::move(output.json), is_tested};
}

}  // namespace incise::laboratory
