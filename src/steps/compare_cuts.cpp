#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/report/comparison_figures.hpp>
#include <incise/report/svg_png.hpp>
#include <incise/steps/comparison_tables.hpp>
#include <incise/steps/cut_steps.hpp>
#include <incise/storage/evaluation_file.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise::steps {
namespace {

struct ComparedFiles {
  std::vector<EvaluationFile> before;
  std::vector<EvaluationFile> after;
};

ComparedRow row_of(const EvaluationFile& file, bool is_after, const std::optional<Comparison>& comparison) {
  ComparedRow row{.name = file.specimen.name,
                  .side = is_after ? "after" : "before",
                  .outcome = file.outcome,
                  .target_mm = file.target_mm,
                  .hu_score = file.hu_score,
                  .hu_score_ideal = file.hu_score_ideal,
                  .centroid_shift_mm = file.centroid_shift_mm,
                  .n_points = file.specimen.signed_error_mm.size()};
  if (!comparison) return row;
  for (const SpecimenRow& found : comparison->rows) {
    if (found.name != file.specimen.name || found.is_after != is_after) continue;
    row.mean_mm = found.error_mm.mean;
    row.sd_mm = found.error_mm.sd;
    row.block_points = found.correlation.block;
    row.n_effective = found.correlation.n_effective;
  }
  return row;
}

std::vector<MeasuredSpecimen> measured(const std::vector<EvaluationFile>& files) {
  std::vector<MeasuredSpecimen> specimens;
  for (const EvaluationFile& file : files) {
    if (!file.specimen.signed_error_mm.empty()) specimens.push_back(file.specimen);
  }
  return specimens;
}

/// Makes the names of specimens differ in tables and figures: files with the same name get their number within the
/// side.
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

/// Absent where targets differ: the same error may be close to the tumour for one target, and not for another.
std::optional<double> common_target_mm(const ComparedFiles& files) {
  const double first = files.before.front().target_mm;
  for (const auto* side : {&files.before, &files.after})
    for (const EvaluationFile& file : *side)
      if (file.target_mm != first) return std::nullopt;
  return first;
}

/// The borders of the first incision that states them, else the defaults; absent where targets differ.
std::optional<ZoneBorders> borders_of(const ComparedFiles& files) {
  if (!common_target_mm(files)) return std::nullopt;
  for (const auto* side : {&files.before, &files.after}) {
    for (const EvaluationFile& file : *side) {
      if (file.positive_at_mm && file.too_close_at_mm) return ZoneBorders{*file.positive_at_mm, *file.too_close_at_mm};
    }
  }
  return ZoneBorders{};
}

void write_both(const std::filesystem::path& folder, const std::string& name, const std::string& svg) {
  write_atomically(folder / (name + ".svg"), svg);
  write_atomically(folder / (name + ".png"), png_of_svg(svg));
}

void write_figures(const std::filesystem::path& folder, const ComparedFiles& files) {
  const std::vector<ErrorSeries> series = series_of(files);
  if (series.empty()) return;
  const std::optional<ZoneBorders> zones = borders_of(files);
  write_both(folder, "box_plot", comparison_box_plot_svg(series, zones));
  const bool has_clock =
      std::none_of(series.begin(), series.end(), [](const auto& one) { return one.clock_h.empty(); });
  if (has_clock) write_both(folder, "error_by_clock", error_by_clock_svg(series, zones));
}

/// Compares the specimens that have errors. Specimens on which no incision was found stay in the table, are named under
/// `left_out`, and count in no mean. A side without any errors has a verdict, `too_few`, and no test.
CutComparison compared(ComparedFiles& files, const ComparisonSettings& settings) {
  tell_apart(files.before);
  tell_apart(files.after);
  const std::vector<MeasuredSpecimen> before = measured(files.before);
  const std::vector<MeasuredSpecimen> after = measured(files.after);
  // A pair can be tested only if both cuts have errors; the user decides which pair to leave out.
  const bool is_whole = before.size() == files.before.size() && after.size() == files.after.size();
  if (settings.is_paired && !is_whole) {
    throw DataError("--paired", "", "an evaluation without an incision", "errors in every file",
                    "Leave out both files of that specimen");
  }
  std::optional<Comparison> comparison;
  if (!before.empty() && !after.empty()) comparison = compare(before, after, settings);
  CutComparison result{.measure = settings.measure,
                       .contour = files.before.front().contour,
                       .target_mm = common_target_mm(files),
                       .alpha = settings.alpha,
                       .power = settings.power};
  if (comparison) {
    result.points = comparison->points;
    result.specimens = comparison->specimens;
  }
  for (const bool is_after : {false, true}) {
    for (const EvaluationFile& file : is_after ? files.after : files.before) {
      result.rows.push_back(row_of(file, is_after, comparison));
      if (file.specimen.signed_error_mm.empty()) result.left_out.push_back({file.specimen.name, file.outcome});
    }
  }
  return result;
}

void write_comparison(const CompareRequest& request, const ComparedFiles& files, const CutComparison& found,
                      const std::vector<std::filesystem::path>& inputs, const StepContext& context) {
  require_replaceable(request.output);
  AtomicFolder target(request.output);
  write_json(target.path() / "compare.json", to_json(found));
  const TextTable results = result_table(found);
  write_atomically(target.path() / "table.csv", csv_text(results));
  write_atomically(target.path() / "table.tex", latex_text(results));
  const TextTable tests = test_table(found);
  write_atomically(target.path() / "tests.csv", csv_text(tests));
  write_atomically(target.path() / "tests.tex", latex_text(tests));
  write_figures(target.path(), files);
  Manifest manifest = manifest_of(context.run, json_text(to_json(request.settings)), inputs, context.wall_s());
  manifest.specimen_id.clear();  // a comparison has several
  write_manifest(target.path(), manifest);
  target.commit();
}

std::vector<EvaluationFile> read_all(const std::vector<std::filesystem::path>& paths) {
  std::vector<EvaluationFile> files;
  for (const auto& path : paths) files.push_back(read_evaluation_file(path));
  return files;
}

/// Requires the same line of the cut and the same target everywhere. Where specimens are paired, each may have its own
/// target, which its two cuts share.
void require_alike(const CompareRequest& request, const ComparedFiles& files) {
  INCISE_REQUIRE(
      !request.settings.is_paired || request.before.size() == request.after.size(),
      fmt::format("expected pairs, found {} before and {} after", request.before.size(), request.after.size()));
  const auto refuse = [&](const std::filesystem::path& path, const char* key, const std::string& found,
                          const std::string& expected, std::size_t like) {
    throw DataError(path, key, found, fmt::format("{} as in {}", expected, request.before[like].string()),
                    "Compare only cuts with the same contour and target");
  };
  const auto check = [&](const std::vector<std::filesystem::path>& paths, const std::vector<EvaluationFile>& side) {
    const EvaluationFile& first = files.before.front();
    for (std::size_t i = 0; i < side.size(); ++i) {
      if (side[i].contour != first.contour)
        refuse(paths[i], "contour", std::string(to_string(side[i].contour)), std::string(to_string(first.contour)), 0);
      const std::size_t like = request.settings.is_paired ? i : 0;
      const double target_mm = files.before[like].target_mm;
      if (side[i].target_mm != target_mm)
        refuse(paths[i], "target_mm", fmt::format("{}", side[i].target_mm), fmt::format("{}", target_mm), like);
    }
  };
  check(request.before, files.before);
  check(request.after, files.after);
}

}  // namespace

void describe(Visitor& v, ComparedRow& r) {
  v("name", r.name, "Name of the file, without its ending.");
  v("side", r.side, "Side of the comparison: before or after.");
  v("outcome", r.outcome, "Outcome of the cut.");
  v({"target_mm", "Intended distance of the line that was measured.", "mm"}, r.target_mm);
  v("hu_score", r.hu_score, "Hu score of the incision against the tumour edge.");
  v("hu_score_ideal", r.hu_score_ideal, "Hu score of a perfect offset.");
  v({"centroid_shift_mm", "Distance between the centres of the filled regions.", "mm"}, r.centroid_shift_mm);
  v("n_points", r.n_points, "Number of points of the contour.");
  const auto compared = [](std::string_view name, std::string_view meaning, std::string_view unit) {
    return Field{.name = name, .meaning = meaning, .unit = unit, .is_omitted = true};
  };
  v(compared("mean_mm", "Mean of the measure that is compared.", "mm"), r.mean_mm);
  v(compared("sd_mm", "Sample standard deviation of the measure that is compared.", "mm"), r.sd_mm);
  v(compared("block_points", "Points in a block of the bootstrap.", ""), r.block_points);
  v(compared("n_effective", "Number of independent values that carry as much information as the points.", ""),
    r.n_effective);
}

void describe(Visitor& v, CutComparison& c) {
  v("measure", c.measure, "Which errors are compared.");
  v("contour", c.contour, "Which line of the cuts was measured.");
  v({"target_mm", "Intended distance of the measured line; null if specimens differ in it.", "mm"}, c.target_mm);
  v.derived("mean_before_mm", c.points ? std::optional(c.points->before.mean) : std::nullopt,
            "Mean error before the change, over all points.");
  v.derived("mean_after_mm", c.points ? std::optional(c.points->after.mean) : std::nullopt,
            "Mean error after the change, over all points.");
  v.derived("verdict", c.points ? TestVerdict::Tested : TestVerdict::TooFew, "Whether there was anything to test.");
  v("points", c.points, "Tests by contour point, as in the paper; absent if a side has no errors.");
  v("specimens", c.specimens, "Tests by specimen; absent if a side has no errors.");
  v("alpha", c.alpha, "Level of significance.");
  v("power", c.power, "Power of the test for which fewest_specimens is stated.");
  v("rows", c.rows, "Every incision.");
  v("left_out", c.left_out, "Incisions without errors.");
}

CompareResult compare_cuts(const CompareRequest& request, const StepContext& context) {
  std::vector<std::filesystem::path> inputs = request.before;
  inputs.insert(inputs.end(), request.after.begin(), request.after.end());
  ComparedFiles files{read_all(request.before), read_all(request.after)};
  require_alike(request, files);
  CompareResult result;
  result.found = compared(files, request.settings);
  if (!request.output.empty()) write_comparison(request, files, result.found, inputs, context);
  result.step = {to_json(result.found), result.found.points.has_value()};
  return result;
}

}  // namespace incise::steps
