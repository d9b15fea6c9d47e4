#include "laboratory/experiment_tables.hpp"
#include "laboratory/factor_table.hpp"
#include "laboratory/trial_on_bench.hpp"

#include <incise/core/batch_monitor.hpp>
#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/evaluation/error_profile.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/folder_lock.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/table_io.hpp>
#include <incise/laboratory/factor_screening.hpp>
#include <incise/report/category_plot.hpp>
#include <incise/steps/case_steps.hpp>
#include <incise/storage/evaluation_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

using laboratory::FactorTable;
using ScreeningJson = nlohmann::ordered_json;

constexpr int kDirections = 36;

/// One specimen cut once under one run of the design.
struct ScreenedCut {
  std::optional<laboratory::ErrorByDirection> errors_mm;  ///< absent: no closed ring
  std::optional<double> mean_abs_mm;
  std::string ended_at;  ///< the step that refused, and why; empty: none did
};

ScreeningJson screening_json(const ScreeningSettings& settings, const FractionalFactorial& design) {
  return {{"specimens", settings.specimens},
          {"runs", design.runs()},
          {"factors", laboratory::names_of_factors(settings.factors)},
          {"overrides", settings.overrides},
          {"tets", settings.tets}};
}

second_bench::Factors factors_on(const FractionalFactorial& design, const second_bench::Factors& all, std::size_t run) {
  second_bench::Factors on;
  std::size_t k = 0;
  for (const second_bench::Factor factor : all)
    if (design.is_on(run, k++)) on.insert(factor);
  return on;
}

/// Returns the errors by direction in the picture, first the direction to the right.
std::optional<laboratory::ErrorByDirection> errors_in(const std::filesystem::path& evaluation) {
  const PhotographedCut cut = read_photographed_cut(evaluation);
  return error_profile(cut.incision, cut.tumor_edge,
                       {.target_mm = read_evaluation_file(evaluation).target_mm,
                        .approach = cut.approach,
                        .start_direction = Vec3::UnitX(),
                        .sectors = kDirections});
}

ScreenedCut cut_one(const ScreeningSettings& settings, const std::filesystem::path& root, std::uint64_t seed,
                    const std::string& specimen_name, const std::string& run_name, const second_bench::Factors& factors,
                    Monitor& monitor) {
  // Each specimen is a series, so it has its own hand-eye offset.
  laboratory::HiddenSpecimen hidden{seed, {}, root / "truth" / specimen_name / run_name, 2, seed};
  hidden.factors = factors;
  laboratory::TrialSetup setup{.name = specimen_name, .tets = settings.tets};
  setup.overrides = settings.overrides;
  laboratory::TrialOnBench on_bench(root / specimen_name / run_name, setup, hidden, monitor);
  laboratory::SpecimenTrial& specimen = on_bench.specimen();
  ScreenedCut result;
  laboratory::TrialCut cut;
  if (specimen.prepare(std::nullopt)) cut = specimen.cut(specimen.planned_path(), "planned");
  result.ended_at = specimen.ended_at().empty() ? cut.ended_at : specimen.ended_at();
  if (cut.measured) {
    result.errors_mm = errors_in(cut.measured->evaluation);
    result.mean_abs_mm = laboratory::mean_error_mm(cut);
  }
  return result;
}

TextTable factors_csv(const FactorTable& table) {
  TextTable csv{{"factor", "change_mm", "change_low_mm", "change_high_mm", "level_mm", "shift_mm", "rest_mm",
                 "made_with", "measured_with", "made_without", "measured_without"},
                {}};
  for (const laboratory::FactorEffect& f : table.factors) {
    csv.rows.push_back(
        {f.factor, number_cell(f.change_mm), number_cell(f.change_95, &Interval::low),
         number_cell(f.change_95, &Interval::high), number_cell(f.moved, &laboratory::ErrorParts::level_mm),
         number_cell(f.moved, &laboratory::ErrorParts::shift_mm),
         number_cell(f.moved, &laboratory::ErrorParts::rest_mm), fmt::format("{}", f.made_with),
         fmt::format("{}", f.measured_with), fmt::format("{}", f.made_without), fmt::format("{}", f.measured_without)});
  }
  return csv;
}

/// @pre effects are estimated.
std::string factors_svg(const FactorTable& table) {
  // The greatest first.
  std::vector<const laboratory::FactorEffect*> sorted;
  for (const laboratory::FactorEffect& factor : table.factors) sorted.push_back(&factor);
  const auto size = [](const laboratory::FactorEffect* f) {
    return std::hypot(f->moved->level_mm, f->moved->shift_mm);
  };
  std::ranges::stable_sort(sorted, [&](const auto* a, const auto* b) { return size(a) > size(b); });
  CategoryPlot plot{.title = "Virtual specimens: what each factor does to the error as planned",
                    .categories = {},
                    .panels = {{"moves the ring of a specimen, mm (dashed: by chance)",
                                {{.name = "mean error", .values = {}, .chance = table.chance->level_mm},
                                 {.name = "shift", .values = {}, .chance = table.chance->shift_mm},
                                 {.name = "rest", .values = {}, .chance = table.chance->rest_mm}}},
                               {"changes the mean |error|, mm (95 % over specimens)", {{.name = "", .values = {}}}}}};
  std::vector<CategorySeries>& moved = plot.panels[0].series;
  CategorySeries& change = plot.panels[1].series[0];
  for (const laboratory::FactorEffect* factor : sorted) {
    plot.categories.push_back(factor->factor);
    moved[0].values.push_back(factor->moved->level_mm);
    moved[1].values.push_back(factor->moved->shift_mm);
    moved[2].values.push_back(factor->moved->rest_mm);
    const double middle = factor->change_mm.value_or(0.0);
    change.values.push_back(middle);
    change.low.push_back(factor->change_95 ? factor->change_95->low : middle);
    change.high.push_back(factor->change_95 ? factor->change_95->high : middle);
  }
  return category_plot_svg(plot);
}

}  // namespace

nlohmann::ordered_json screen_factors(const ScreeningSettings& settings, const std::filesystem::path& output,
                                      const RunContext& run, Workers& workers, Monitor& monitor) {
  INCISE_REQUIRE(settings.factors.size() >= 2, "expected at least two factors: with one, chance cannot be estimated");
  const steps::StepContext timed{run, workers, monitor};  // for its wall_s()
  const FractionalFactorial design(settings.factors.size());
  const FolderLock lock(output);
  laboratory::claim_folder(output, "incise.factors/1", "a screening of factors", run.seed,
                           {"factors.json", "factors.csv", "cuts.csv", "factors.svg", "manifest.json"});
  const std::size_t runs = design.runs();
  const auto specimens = static_cast<std::size_t>(settings.specimens);
  std::vector<ScreenedCut> cuts(specimens * runs);
  const auto specimen_name = [](std::size_t s) { return fmt::format("S{}", s + 1); };
  const auto factors_of = [&](std::size_t r) { return factors_on(design, settings.factors, r); };
  // The folder's name states which factors were on, so another selection does not continue with its cuts.
  const auto run_name = [&](std::size_t r) {
    unsigned bits = 0;
    for (const second_bench::Factor factor : factors_of(r)) bits |= 1U << static_cast<unsigned>(factor);
    return fmt::format("{:04x}", bits);
  };
  BatchProgress progress(cuts.size(), "virtual cuts", monitor);
  workers.for_each(cuts.size(), 1, [&](std::size_t i) {
    const std::size_t s = i / runs, r = i % runs;
    cuts[i] = cut_one(settings, output, run.seed + s, specimen_name(s), run_name(r), factors_of(r), monitor);
    progress.note(i, 1.0);
  });
  std::vector<std::vector<std::optional<laboratory::ErrorByDirection>>> errors(specimens);
  std::vector<std::vector<std::optional<double>>> means(specimens);
  ScreeningJson rows = ScreeningJson::array();
  TextTable csv{{"specimen", "seed", "run", "factors", "mean_abs_error_mm", "ended_at"}, {}};
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const std::size_t s = i / runs, r = i % runs;
    errors[s].push_back(cuts[i].errors_mm);
    means[s].push_back(cuts[i].errors_mm ? cuts[i].mean_abs_mm : std::nullopt);
    const std::vector<std::string> on = laboratory::names_of_factors(factors_of(r));
    rows.push_back({{"specimen", specimen_name(s)},
                    {"seed", run.seed + s},
                    {"run", r + 1},
                    {"folder", run_name(r)},
                    {"factors", on},
                    {"mean_abs_error_mm", to_json(means[s].back())},
                    {"ended_at", cuts[i].ended_at.empty() ? ScreeningJson(nullptr) : ScreeningJson(cuts[i].ended_at)}});
    csv.rows.push_back({specimen_name(s), fmt::format("{}", run.seed + s), fmt::format("{}", r + 1),
                        fmt::format("{}", fmt::join(on, " ")), number_cell(means[s].back()), cuts[i].ended_at});
  }
  const FactorTable table =
      laboratory::factor_table(design, laboratory::names_of_factors(settings.factors), errors, means);
  ScreeningJson result;
  result["specimen_is"] = "virtual";
  result["settings"] = screening_json(settings, design);
  result.update(to_json(table));
  result["left_out"] = ScreeningJson::array();
  for (std::size_t s = 0; s < specimens; ++s)
    if (std::ranges::find(table.estimated, s) == table.estimated.end()) result["left_out"].push_back(specimen_name(s));
  result["rows"] = rows;
  write_atomically(output / "factors.csv", csv_text(factors_csv(table)));
  write_atomically(output / "cuts.csv", csv_text(csv));
  if (table.chance) write_atomically(output / "factors.svg", factors_svg(table));
  const double wall_s = timed.wall_s();
  write_manifest(output, steps::manifest_of(run, screening_json(settings, design).dump(), {}, wall_s));
  result["figure"] = table.chance ? ScreeningJson((output / "factors.svg").string()) : ScreeningJson(nullptr);
  result["wall_s"] = wall_s;
  write_json(output / "factors.json", result);
  return result;
}

}  // namespace incise
