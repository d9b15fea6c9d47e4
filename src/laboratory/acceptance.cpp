#include "laboratory/experiment_tables.hpp"
#include "laboratory/trial_on_bench.hpp"

#include <incise/core/batch_monitor.hpp>
#include <incise/core/described_json.hpp>
#include <incise/core/expect.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/folder_lock.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/manifest.hpp>
#include <incise/laboratory/acceptance.hpp>
#include <incise/steps/case_steps.hpp>

#include <fmt/format.h>

namespace incise {
namespace {

using laboratory::Trial;
using Rows = nlohmann::ordered_json;

constexpr const char* kAcceptanceFile = "acceptance.json";
constexpr const char* kAcceptanceTable = "acceptance.csv";

/// Cuts as planned, then along the paper's correction.
void cut_twice(const AcceptanceSettings& settings, const std::filesystem::path& root, std::uint64_t series,
               Monitor& monitor, Trial& trial, Rows& row) {
  laboratory::HiddenSpecimen hidden{trial.seed, trial.given, root / "truth" / trial.name, 2, series};
  hidden.factors = settings.factors;
  laboratory::TrialSetup setup{.name = trial.name, .tets = settings.tets};
  setup.given_power_w = settings.power_w;
  setup.overrides = settings.overrides;
  laboratory::TrialOnBench on_bench(root / trial.name, setup, hidden, monitor);
  laboratory::SpecimenTrial& specimen = on_bench.specimen();
  if (specimen.prepare(std::nullopt)) {
    trial.planned = specimen.cut(specimen.planned_path(), "planned");
    if (trial.planned.is_made && settings.with_paper_pass) {
      laboratory::CaseVariant variant{std::nullopt, specimen.youngs_modulus_kpa(),
                                      CompensationChoice{.method = CompensationMethod::Paper}};
      const std::filesystem::path file = specimen.write_variant("paper_pass.yaml", variant);
      trial.rivals.push_back(
          {laboratory::RivalPath::PaperPass, specimen.cut_again(file, specimen.at("paper_pass"), "paper_pass").cut});
    }
  }
  trial.ended_at = specimen.ended_at();
  const auto error = [](const laboratory::TrialCut* cut) {
    return to_json(cut != nullptr ? laboratory::mean_error_mm(*cut) : std::nullopt);
  };
  row["seed"] = trial.seed;
  row["prescription"] = specimen.prescription();
  row["youngs_modulus_kpa"] = specimen.youngs_modulus_kpa() > 0.0 ? Rows(specimen.youngs_modulus_kpa()) : Rows(nullptr);
  row["planned_mm"] = error(&trial.planned);
  row["paper_pass_mm"] = error(laboratory::find_rival(trial, laboratory::RivalPath::PaperPass));
  row["ended_at"] = laboratory::refusals_of(trial);
}

Rows summary_of_rows(const Rows& rows) {
  std::size_t closed = 0, pairs = 0, worse = 0;
  double planned = 0.0, before = 0.0, after = 0.0;
  for (const Rows& row : rows) {
    if (!row.at("planned_mm").is_number()) continue;
    const double error = row.at("planned_mm").get<double>();
    ++closed;
    planned += error;
    if (!row.at("paper_pass_mm").is_number()) continue;
    const double again = row.at("paper_pass_mm").get<double>();
    ++pairs;
    before += error;
    after += again;
    if (again > error) ++worse;
  }
  Rows summary;
  summary["specimens"] = rows.size();
  summary["closed_as_planned"] = closed;
  summary["planned_mean_mm"] = closed > 0 ? Rows(planned / static_cast<double>(closed)) : Rows(nullptr);
  summary["pairs"] = pairs;
  summary["paper_pass_gain_percent"] = pairs > 0 ? Rows(100.0 * (1.0 - after / before)) : Rows(nullptr);
  summary["paper_pass_worse"] = worse;
  return summary;
}

std::string csv_of(const Rows& rows) {
  std::string csv = "seed,margin_mm,depth_mm,speed_mm_s,power_w,youngs_modulus_kpa,planned_mm,paper_pass_mm\n";
  for (const Rows& row : rows) {
    const Rows& asked = row.at("prescription");
    const auto of = [&asked](const char* key) { return asked.is_object() ? asked.at(key).dump() : std::string(); };
    const auto number = [&row](const char* key) {
      return row.at(key).is_number() ? row.at(key).dump() : std::string();
    };
    csv += fmt::format("{},{},{},{},{},{},{},{}\n", row.at("seed").dump(), of("lateral_margin_mm"), of("depth_mm"),
                       of("speed_mm_s"), of("power_w"), number("youngs_modulus_kpa"), number("planned_mm"),
                       number("paper_pass_mm"));
  }
  return csv;
}

}  // namespace

void describe(Visitor& v, AcceptanceSettings& s) {
  v("specimens", s.specimens, "Number of specimens; their seeds count up from the run's.", {1.0, 200.0});
  std::vector<second_bench::Factor> factors(s.factors.begin(), s.factors.end());
  v("factors", factors, "Factors of laboratory 2 that vary.");
  if (v.sets()) s.factors = {factors.begin(), factors.end()};
  v({"speed_mm_s", "Speed of every cut; by default as prescribed.", "mm/s"}, s.speed_mm_s, {1.0, 15.0});
  v({"power_w", "Power of every cut; by default as prescribed.", "W"}, s.power_w, {1.0, 120.0});
  v("overrides", s.overrides, "Failed checks of the program to override.");
  v("paper_pass", s.with_paper_pass, "Whether each specimen is also cut along the paper's correction.");
  v("tets", s.tets, "Target number of tets of the planner's meshes.", kPositive);
}

nlohmann::ordered_json accept_bench(const AcceptanceSettings& settings, const std::filesystem::path& output,
                                    const RunContext& run, Workers& workers, Monitor& monitor) {
  require_none(problems_of(settings));
  const steps::StepContext timed{run, workers, monitor};  // for its wall_s()
  const FolderLock lock(output);
  laboratory::claim_folder(output, "incise.acceptance/1", "an acceptance", run.seed,
                           {kAcceptanceFile, kAcceptanceTable, "manifest.json"});
  std::vector<Trial> trials(settings.specimens);
  std::vector<Rows> rows(settings.specimens);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    trials[i].name = fmt::format("S{}", i + 1);
    trials[i].seed = run.seed + i;
    trials[i].role = laboratory::TrialRole::Test;
    if (settings.speed_mm_s) trials[i].given.emplace_back("speed_mm_s", *settings.speed_mm_s);
  }
  BatchProgress progress(trials.size(), "virtual specimens", monitor);
  workers.for_each(trials.size(), 1, [&](std::size_t i) {
    cut_twice(settings, output, run.seed, monitor, trials[i], rows[i]);
    progress.note(i, 1.0);
  });
  Rows result;
  result["specimen_is"] = "virtual";
  result["settings"] = to_json(settings);
  result["summary"] = summary_of_rows(rows);
  result["rows"] = rows;
  write_atomically(output / kAcceptanceTable, csv_of(rows));
  const double wall_s = timed.wall_s();
  write_manifest(output, steps::manifest_of(run, to_json(settings).dump(), {}, wall_s));
  result["wall_s"] = wall_s;
  write_json(output / kAcceptanceFile, result);
  return result;
}

}  // namespace incise
