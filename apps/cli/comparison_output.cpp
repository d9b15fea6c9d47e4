#include "comparison_output.hpp"

#include "comparison_tables.hpp"

#include <incise/core/error.hpp>
#include <incise/core/isa.hpp>
#include <incise/core/version.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/manifest.hpp>
#include <incise/report/comparison_figures.hpp>
#include <incise/report/svg_png.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise::cli {
namespace {

using Json = nlohmann::ordered_json;

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

}  // namespace

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
                      const std::vector<std::filesystem::path>& inputs, const RunContext& context, double wall_s) {
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
  Manifest manifest;
  manifest.version = version();
  manifest.commit = source_commit();
  manifest.command = context.command;
  manifest.settings_json = json_text({{"measure", output.json["measure"]},
                                      {"paired", output.settings.is_paired},
                                      {"alpha", output.settings.alpha},
                                      {"power", output.settings.power},
                                      {"replicates", output.settings.bootstrap.replicates}});
  manifest.seed = context.seed;
  manifest.threads = context.threads;
  manifest.instruction_set = to_string(active_isa());
  for (const auto& input : inputs) manifest.inputs.push_back({input.string(), sha256_of_file(input)});
  manifest.wall_s = wall_s;
  manifest.machine = machine_description();
  write_manifest(target.path(), manifest);
  target.commit();
}

}  // namespace incise::cli
