#include "laboratory/experiment_advice.hpp"
#include "laboratory/experiment_report.hpp"
#include "laboratory/experiment_rivals.hpp"
#include "laboratory/experiment_tables.hpp"
#include "laboratory/outside_range.hpp"
#include "laboratory/virtual_laboratory.hpp"

#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/core/version.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/folder_lock.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/manifest.hpp>
#include <incise/laboratory/experiment.hpp>
#include <incise/report/html_report.hpp>
#include <incise/steps/case_steps.hpp>
#include <incise/steps/cut_steps.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <mutex>
#include <ostream>
#include <string_view>
#include <thread>

namespace incise::laboratory {
namespace {

using ExperimentJson = nlohmann::ordered_json;

// Of the time of a specimen that is cut as planned and no more: advice and correction; two paths of a forecast.
constexpr double kCorrectionCost = 2.2, kLearningCost = 1.5;

/// A step of all specimens together cannot be done without.
void require_done(const StepAnswer& answer, const char* step, const ExperimentSteps& runner) {
  if (answer.end != StepEnd::Done)
    throw DataError(runner.folder() / "log.txt", step, refusal_of(step, answer), "a step whose result can be used");
}

/// Along whose paths test specimens are cut.
std::vector<RivalPath> rivals_of(const ExperimentSettings& settings) {
  if (settings.with_rivals)
    return {RivalPath::Constant,    RivalPath::Profile,   RivalPath::ProfileSmoothed, RivalPath::ProfileInView,
            RivalPath::Photographs, RivalPath::PaperPass, RivalPath::Uncalibrated,    RivalPath::Hybrid,
            RivalPath::Learned,     RivalPath::Robust};
  return settings.with_paper_pass ? std::vector{RivalPath::PaperPass} : std::vector<RivalPath>{};
}

ExperimentJson comparison_json(const PathComparison& paths) {
  return {{"rivals", paths_json(paths)}, {"best_without_simulation", to_json(paths.best_without_simulation)}};
}

/// What the calibration's data say: estimates and sentences, without the posterior's samples. Null without a fit.
ExperimentJson fit_summary(const ExperimentJson& calibration) {
  if (!calibration.is_object() || !calibration.at("posterior").is_object()) return nullptr;
  ExperimentJson json;
  for (const char* parameter : {"drag_length_mm", "ln_stiffness_factor", "bias_mm"}) {
    const ExperimentJson& estimate = calibration.at("posterior").at(parameter);
    for (const char* key : {"mean", "sd", "told", "at_limit"}) json[parameter][key] = estimate.at(key);
  }
  json["stiffness_varied"] = calibration.at("posterior").at("stiffness_varied");
  json["score_percent"] = calibration.at("score_percent");
  json["identifiability"] = calibration.at("identifiability");
  return json;
}

/// Geometric mean of the specimens that a calibration is of.
double mean_modulus_kpa(const ExperimentJson& calibration) {
  double sum = 0.0;
  const ExperimentJson& specimens = calibration.at("specimens");
  for (const ExperimentJson& specimen : specimens) sum += std::log(specimen.at("youngs_modulus_kpa").get<double>());
  return std::exp(sum / static_cast<double>(specimens.size()));
}

/// The case whose correction is by a forecast. @param path  ProfileInView, Photographs or Learned.
CaseVariant forecast_variant(RivalPath path, const ChosenTool& tool, double youngs_modulus_kpa,
                             const ExperimentJson& forecast) {
  const auto list = [&forecast](const char* pointer) {
    return forecast.at(ExperimentJson::json_pointer(pointer)).get<std::vector<double>>();
  };
  CaseVariant variant{tool, youngs_modulus_kpa, CompensationChoice{.method = CompensationMethod::Profile}};
  CompensationChoice& choice = *variant.compensation;
  if (path == RivalPath::ProfileInView) choice.photographed_mm = list("/in_view_mm");
  if (path == RivalPath::Photographs) choice.photographed_mm = list("/without_simulation/residual_mm");
  if (path == RivalPath::Learned) {
    choice = calibrated_choice(tool);
    choice.residual_mm = list("/with_simulation/residual_mm");
    choice.simulated_share = forecast.at("with_simulation").at("simulated_share").get<double>();
  }
  return variant;
}

/// The tool that a calibration chose.
ChosenTool tool_of(const ExperimentJson& calibration) {
  const ExperimentJson& chosen = calibration.at("chosen");
  return {chosen.at("speed_mm_s").get<double>(), chosen.at("dullness").get<double>(),
          calibration.at("posterior").at("bias_mm").at("mean").get<double>()};
}

class Experiment {
 public:
  Experiment(ExperimentSettings settings, std::filesystem::path output, RunContext run, Workers& workers,
             Monitor& monitor)
      : settings_(std::move(settings)),
        context_(std::move(run)),
        workers_(workers),
        monitor_(monitor),
        root_(std::move(output)),
        truth_(settings_.truth.empty() ? root_ / "truth" : settings_.truth) {
    for (std::uint64_t i = 0; i < settings_.specimens; ++i) {
      Trial trial;
      trial.name = fmt::format("S{}", i + 1);
      trial.seed = context_.seed + i;
      trial.role = i < settings_.specimens / 2 ? TrialRole::Calibrate : TrialRole::Test;
      trials_.push_back(std::move(trial));
    }
    add_outside(context_.seed);
  }

  ExperimentJson run();

 private:
  void claim_folder() const;
  void remove_summaries() const;
  void add_outside(std::uint64_t seed);
  [[nodiscard]] double cost_of(const Trial& trial) const;
  [[nodiscard]] static double cost_of(RivalPath path) { return is_without_simulation(path) ? 0.5 : 0.9; }
  [[nodiscard]] double calibration_cost() const;
  /// What was reported of a specimen on the way.
  struct Reported {
    double cost = 0.0;
    std::size_t computed = 0;  ///< steps computed until then
    bool is_rest_kept = true;  ///< nothing was computed since
  };
  /// @param is_kept  an earlier run had computed all of it.
  void report_end(const Trial* trial, double cost, bool is_kept);
  void report_part(const SpecimenTrial& specimen, double cost, Reported& reported);
  void tell();
  void run_trials(TrialRole first, TrialRole last);
  Reported run_trial(Trial& trial);
  void assess(SpecimenTrial& specimen, Trial& trial);
  [[nodiscard]] ExperimentJson advice_of(SpecimenTrial& specimen, const std::string& step,
                                         const std::filesystem::path& file, const std::filesystem::path& folder,
                                         std::optional<double> force_n) const;
  void assess_without_pull(SpecimenTrial& specimen, Trial& trial);
  void correct(SpecimenTrial& specimen, Trial& trial);
  [[nodiscard]] StepAnswer forecast_of(SpecimenTrial& specimen, const std::filesystem::path& file,
                                       const std::filesystem::path& folder, const std::filesystem::path& calibration,
                                       const std::string& step) const;
  [[nodiscard]] CaseVariant variant_of(RivalPath path, double youngs_modulus_kpa, const ExperimentJson& forecast) const;
  /// @param reported  grows by what was reported, as below.
  void cut_rivals(SpecimenTrial& specimen, Trial& trial, Reported& reported);
  void cut_learning(SpecimenTrial& specimen, Trial& trial, Reported& reported);
  [[nodiscard]] TrialCut cut_along(RivalPath path, SpecimenTrial& specimen, const StepAnswer& forecast) const;
  void calibrate();
  void compare();
  void write_commands() const;

  ExperimentSettings settings_;
  RunContext context_;
  Workers& workers_;
  Monitor& monitor_;
  std::filesystem::path root_, truth_;
  FolderLock lock_{root_};
  std::vector<Trial> trials_;
  const std::vector<RivalPath> rivals_ = rivals_of(settings_);
  /// A calibration of the first photographs alone.
  struct Learning {
    std::size_t photographs = 0;
    std::filesystem::path calibration;
    ChosenTool tool;
  };
  std::optional<ChosenTool> tool_;
  std::vector<Learning> learning_;
  double calibrated_kpa_ = 0.0;  // geometric mean of the calibrated specimens' moduli
  ExperimentJson calibration_, table_1_, comparison_;
  std::vector<std::string> calibration_commands_, comparison_commands_;
  std::mutex mutex_;  // of what is not reported yet, while specimens go side by side
  std::vector<std::string> warnings_;
  double done_ = 0.0;                                          // of the whole cost
  double kept_ = 0.0;                                          // likewise, of parts that an earlier run kept
  const std::thread::id caller_ = std::this_thread::get_id();  // it alone may tell the monitor
};

ExperimentJson Experiment::run() {
  const steps::StepContext timed{context_, workers_, monitor_};  // for its wall_s()
  claim_folder();
  remove_summaries();
  run_trials(TrialRole::Calibrate, TrialRole::Calibrate);
  calibrate();
  run_trials(TrialRole::Test, TrialRole::Outside);
  compare();
  write_table_2(root_ / "table_2.csv", trials_);
  const ExperimentJson advice = hold_advice_against_truth(trials_, truth_);
  if (!advice.is_null()) {
    AtomicFolder folder(root_ / "advice");
    write_json(folder.path() / "advice.json", advice);
    draw_advice(folder.path(), advice);
    write_manifest(folder.path(), steps::manifest_of(context_, to_json(settings_).dump(), {}, timed.wall_s()));
    folder.commit();
  }
  write_commands();
  const TrialSummary summary = summary_of(trials_, TrialRole::Test);
  ExperimentJson result;
  result["specimen_is"] = "virtual";
  result["specimens"] = trials_.size();
  result["tested"] = summary.specimens;
  const ExperimentJson of_test = to_json(summary);
  for (const auto& [key, value] : of_test.items())
    if (key != "specimens") result[key] = value;
  if (std::find(rivals_.begin(), rivals_.end(), RivalPath::PaperPass) != rivals_.end())
    result["paper_pass"] = to_json(summary_of(trials_, TrialRole::Test, RivalPath::PaperPass));
  const std::vector<TestedSpecimen> tested = tested_specimens(trials_, truth_);
  const PathComparison paths = compare_paths(tested);
  result.update(comparison_json(paths));
  if (settings_.with_rivals) {
    for (const bool is_unlike : {true, false})
      result[is_unlike ? "unlike" : "like"] = comparison_json(compare_paths(of_likeness(tested, is_unlike)));
  }
  if (settings_.with_known_physics) result["known_physics"] = known_physics_json(trials_);
  result["advice"] = advice;
  result["calibration"] = json_part(calibration_, "/chosen");
  result["fit"] = fit_summary(calibration_);
  result["left_out_of_calibration"] =
      calibration_.is_object() ? calibration_.value("left_out", ExperimentJson::array()) : ExperimentJson::array();
  result["specimens_test"] = json_part(comparison_, "/specimens");
  result["table_1"] = json_part(table_1_, "/rows");
  result["table_2"] = table_2_json(trials_);
  result["tested_specimens"] = to_json(tested);
  result["learning"] = to_json(learning_curve(std::span(&tested, 1)));
  result["assessments"] = assessments_json(trials_);
  result["figures"] = ExperimentJson::array();
  for (const char* figure : {"comparison/box_plot.svg", "comparison/error_by_clock.svg", "table_1/table_1.svg",
                             "calibration/fit.svg", "advice/roc.svg", "advice/reliability.svg"}) {
    const bool is_of_grid = std::string_view(figure).starts_with("table_1");
    if (is_of_grid && !table_1_.is_object()) continue;  // an earlier run's, which is kept
    if (std::filesystem::exists(root_ / figure)) result["figures"].push_back((root_ / figure).string());
  }
  result["commands"] = (root_ / "commands.sh").string();
  ReportData page = experiment_report(trials_, paths, result, root_);
  const ExperimentJson asked = to_json(settings_);
  for (const auto& [name, value] : asked.items()) page.settings.push_back({name, value.dump(), ""});
  page.provenance = {{"version", std::string(version()), ""},
                     {"commit", std::string(source_commit()), ""},
                     {"command", context_.command, ""},
                     {"seed", std::to_string(context_.seed), ""},
                     {"threads", std::to_string(context_.threads), ""},
                     {"machine", machine_description(), ""}};
  write_report(page, root_ / "report.html");
  result["report"] = (root_ / "report.html").string();
  result["wall_s"] = timed.wall_s();
  write_manifest(root_, steps::manifest_of(context_, to_json(settings_).dump(), {}, result["wall_s"].get<double>()));
  write_json(root_ / "study.json", result);
  return result;
}

/// One folder holds one experiment: runs with other options go on with it, those with other specimens would mix with
/// it.
void Experiment::claim_folder() const {
  const std::filesystem::path file = root_ / "experiment.json";
  ExperimentJson claim{{"schema", "incise.experiment/1"}, {"specimen_is", "virtual"}, {"seed", context_.seed}};
  if (settings_.bench != 1) claim["bench"] = settings_.bench;
  if (!std::filesystem::exists(file)) {
    steps::require_own_or_empty(root_, {file.filename().string()}, "an experiment");
    write_json(file, claim);
    return;
  }
  const ExperimentJson kept = read_json(file);
  const auto require_same = [&](const char* key, const ExperimentJson& asked, const ExperimentJson& if_absent) {
    const ExperimentJson found = kept.is_object() ? kept.value(key, if_absent) : ExperimentJson();
    if (found != asked)
      throw DataError(file, key, found.dump(), fmt::format("{}, that of this command", asked.dump()),
                      "Its specimens differ. Choose another place for the output");
  };
  require_same("seed", context_.seed, nullptr);
  require_same("bench", settings_.bench, 1);
}

/// What an earlier run with other options said of the whole: it would be taken for this one's.
void Experiment::remove_summaries() const {
  for (const char* folder : {"advice", "comparison"}) {
    remove_replaceable(root_ / folder);  // somebody else's folder of that name is none of ours to remove
  }
  for (const char* file : {"study.json", "report.html", "table_2.csv", "commands.sh"})
    std::filesystem::remove(root_ / file);
}

void Experiment::add_outside(std::uint64_t seed) {
  const bool is_papers =
      settings_.specimens == 4 && settings_.bench == 1;  // two to calibrate, two corrected, and one that fails
  const std::uint64_t count = settings_.outside.value_or(is_papers ? 1 : 0);
  for (std::uint64_t i = 0; i < count; ++i) {
    Trial trial;
    trial.seed = seed + settings_.specimens + i;
    trial.name = fmt::format("S{}", settings_.specimens + i + 1);
    trial.role = TrialRole::Outside;
    OutsideKind kind = is_papers && !settings_.outside ? failed_specimen() : outside_specimen(trial.seed, i);
    trial.kind = std::move(kind.name);
    trial.given = std::move(kind.given);
    trials_.push_back(std::move(trial));
  }
}

/// Specimens side by side, one thread each.
void Experiment::run_trials(TrialRole first, TrialRole last) {
  std::vector<Trial*> mine;
  for (Trial& trial : trials_)
    if (trial.role >= first && trial.role <= last) mine.push_back(&trial);
  workers_.for_each(mine.size(), 1, [&](std::size_t i) {
    const Reported reported = run_trial(*mine[i]);
    report_end(mine[i], cost_of(*mine[i]) - reported.cost, reported.is_rest_kept);
  });
  tell();
}

/// Notes that something has ended. Only the caller's thread reports to the monitor.
void Experiment::report_end(const Trial* trial, double cost, bool is_kept) {
  {
    const std::scoped_lock lock(mutex_);
    (is_kept ? kept_ : done_) += cost;
    if (trial != nullptr) {
      for (const std::string& reason : refusals_of(*trial))
        warnings_.push_back(fmt::format("{} ended at {}", trial->name, reason));
    }
  }
  if (std::this_thread::get_id() == caller_) tell();
}

void Experiment::report_part(const SpecimenTrial& specimen, double cost, Reported& reported) {
  const bool is_kept = specimen.computed() == reported.computed;
  reported.computed = specimen.computed();
  reported.cost += cost;
  report_end(nullptr, cost, is_kept);
}

void Experiment::tell() {
  const std::scoped_lock lock(mutex_);
  for (const std::string& warning : warnings_) monitor_.message(Severity::Warning, warning);
  warnings_.clear();
  double total = calibration_cost();
  for (const Trial& trial : trials_) total += cost_of(trial);
  // Parts that an earlier run kept take no time and do not count: the time left would be estimated too short.
  const double to_do = total - kept_;
  monitor_.progress("virtual specimens", to_do > 1e-9 * total ? std::min(1.0, done_ / to_do) : 1.0);
}

/// Roughly how long a specimen takes, in times of one that is cut as planned and no more: measured on a machine with
/// two cores, and used for nothing but the time that is left.
double Experiment::cost_of(const Trial& trial) const {
  if (trial.role == TrialRole::Calibrate) return 1.0;
  double cost = 1.0 + kCorrectionCost;
  if (settings_.with_withheld_force) cost += 1.6;
  if (trial.role == TrialRole::Test) {
    for (const RivalPath path : rivals_) cost += cost_of(path);
    cost += kLearningCost * static_cast<double>(settings_.learning.size());
  }
  if (trial.role == TrialRole::Test && settings_.with_known_physics) cost += 1.5;
  return cost;
}

/// Of fit and, unless it is left out, grid.
double Experiment::calibration_cost() const {
  const double specimens = static_cast<double>(settings_.specimens / 2);
  return specimens * (settings_.is_quick ? 1.2 : 3.0);
}

Experiment::Reported Experiment::run_trial(Trial& trial) {
  Reported reported;
  Workers one(1);
  ExperimentSteps steps(root_ / trial.name, one, monitor_);
  VirtualLaboratory bench({trial.seed, trial.given, truth_ / trial.name, settings_.bench, context_.seed}, steps);
  SpecimenTrial specimen(
      {.name = trial.name, .overrides = settings_.overrides, .tets = settings_.tets, .rule = settings_.rule}, steps,
      bench);
  if (specimen.prepare(tool_)) {
    trial.planned = specimen.cut(specimen.planned_path(), "planned");
    if (trial.role != TrialRole::Calibrate) report_part(specimen, 1.0, reported);
    const bool goes_on = trial.planned.is_made && trial.role != TrialRole::Calibrate;
    const bool is_test = goes_on && trial.role == TrialRole::Test;
    if (goes_on) {
      assess(specimen, trial);
      correct(specimen, trial);
      report_part(specimen, kCorrectionCost, reported);
    }
    if (goes_on && settings_.with_withheld_force) assess_without_pull(specimen, trial);
    if (is_test) cut_rivals(specimen, trial, reported);
    if (is_test) cut_learning(specimen, trial, reported);
    if (is_test && settings_.with_known_physics) trial.known_physics = bench.known_physics().result;
  }
  trial.stretch_force_n = specimen.stretch_force_n();
  trial.youngs_modulus_kpa = specimen.youngs_modulus_kpa();
  trial.registration_rmse_mm = specimen.registration_rmse_mm();
  trial.ended_at = specimen.ended_at();
  trial.commands = steps.lines();
  reported.is_rest_kept = steps.computed() == reported.computed;
  return reported;
}

/// What would be advised before the robot moves. The corrected cut is made on the bench whatever it says: whether the
/// advice was right is part of the experiment.
void Experiment::assess(SpecimenTrial& specimen, Trial& trial) {
  trial.assessment =
      advice_of(specimen, "assess", specimen.case_file(), specimen.at("compensated"), specimen.stretch_force_n());
}

/// The same advice of a laboratory that cannot measure the pull: the tissue is taken to be as stiff as the calibrated
/// one is on average. It corrects along another path, which is cut, too.
void Experiment::assess_without_pull(SpecimenTrial& specimen, Trial& trial) {
  const std::filesystem::path folder = specimen.at("withheld");
  const std::filesystem::path file =
      specimen.write_variant("withheld.yaml", {tool_, calibrated_kpa_, calibrated_choice(*tool_)});
  trial.assessment_without_pull = advice_of(specimen, "assess_without_pull", file, folder, std::nullopt);
  trial.withheld = specimen.cut_again(file, folder, "withheld").cut;
}

/// @param force_n  absent: not measured.
ExperimentJson Experiment::advice_of(SpecimenTrial& specimen, const std::string& step,
                                     const std::filesystem::path& file, const std::filesystem::path& folder,
                                     std::optional<double> force_n) const {
  const std::filesystem::path registration = specimen.registration();
  const steps::CalibratedRequest known{root_ / "calibration/calibration.json", force_n};
  std::vector<std::string> words{"assess",         file.string(),        "--calibration", known.calibration.string(),
                                 "--registration", registration.string()};
  if (force_n) words.insert(words.end(), {"--stretch-force-n", fmt::format("{}", *force_n)});
  words.insert(words.end(), {"-o", folder.string()});
  return specimen
      .ask({step,
            words,
            {file, specimen.at("tumor.csv"), specimen.at("lab/ct"), known.calibration, registration},
            {folder / "assessment/assess.json"},
            [=, &specimen](const steps::StepContext& context) {
              specimen.begin_run(folder, Stage::Plan);
              const steps::CalibrationInput calibration = steps::read_calibration_input(known);
              return steps::assess_case({read_case_with_inputs(file), folder, {}}, calibration, registration, context);
            }})
      .result;
}

/// What photographs say of this ring.
StepAnswer Experiment::forecast_of(SpecimenTrial& specimen, const std::filesystem::path& file,
                                   const std::filesystem::path& folder, const std::filesystem::path& calibration,
                                   const std::string& step) const {
  return specimen.ask({step,
                       {"forecast", file.string(), "--calibration", calibration.string(), "-o", folder.string()},
                       {file, specimen.at("tumor.csv"), specimen.at("lab/ct"), calibration},
                       {folder / "forecast/forecast.json"},
                       [=, &specimen](const steps::StepContext& context) {
                         specimen.begin_run(folder, Stage::Plan);
                         return steps::forecast_case({read_case_with_inputs(file), folder, {.until = Stage::Plan}},
                                                     calibration, context);
                       }});
}

/// The case whose correction is the rival's path, by the same readings and photographs.
CaseVariant Experiment::variant_of(RivalPath path, double youngs_modulus_kpa, const ExperimentJson& forecast) const {
  const auto list = [&](const char* pointer) {
    return calibration_.at(ExperimentJson::json_pointer(pointer)).get<std::vector<double>>();
  };
  CaseVariant variant{tool_, youngs_modulus_kpa, CompensationChoice{.method = CompensationMethod::Profile}};
  CompensationChoice& choice = *variant.compensation;
  switch (path) {
    case RivalPath::Constant:
      choice.photographed_mm = {calibration_.at("photographed_profile").at("constant_mm").get<double>()};
      break;
    case RivalPath::Profile:
      choice.photographed_mm = list("/photographed_profile/mean_mm");
      break;
    case RivalPath::ProfileSmoothed:
      choice.photographed_mm = list("/photographed_profile/smoothed_mm");
      break;
    case RivalPath::ProfileInView:
    case RivalPath::Photographs:
    case RivalPath::Learned:
      return forecast_variant(path, *tool_, youngs_modulus_kpa, forecast);
    case RivalPath::PaperPass:
      choice.method = CompensationMethod::Paper;
      break;
    case RivalPath::Uncalibrated:
      variant.tool.reset();
      choice = {.observable = ContourKind::InnerEdge};
      break;
    case RivalPath::Hybrid:
      choice = calibrated_choice(*tool_);
      choice.residual_mm = list("/residual_profile/mean_mm");
      choice.simulated_share = calibration_.at("residual_profile").at("simulated_share").get<double>();
      break;
    case RivalPath::Robust:
      choice = calibrated_choice(*tool_);
      break;
  }
  return variant;
}

/// Cuts the same specimen along every rival's path.
void Experiment::cut_rivals(SpecimenTrial& specimen, Trial& trial, Reported& reported) {
  StepAnswer forecast;
  if (settings_.with_rivals)
    forecast = forecast_of(specimen, specimen.case_file(), specimen.at("compensated"),
                           root_ / "calibration/calibration.json", "forecast");
  if (settings_.with_rivals && forecast.end == StepEnd::Done)
    trial.unlike = forecast.result.at("with_simulation").at("unlike").get<std::vector<std::string>>();
  for (const RivalPath path : rivals_) {
    trial.rivals.push_back({path, cut_along(path, specimen, forecast)});
    report_part(specimen, cost_of(path), reported);
  }
}

/// @param forecast  of this ring; read for paths that are made of it.
TrialCut Experiment::cut_along(RivalPath path, SpecimenTrial& specimen, const StepAnswer& forecast) const {
  const std::string name{to_string(path)};
  if (is_of_forecast(path) && forecast.end != StepEnd::Done) return {.ended_at = refusal_of("forecast", forecast)};
  const std::filesystem::path file =
      specimen.write_variant(name + ".yaml", variant_of(path, specimen.youngs_modulus_kpa(), forecast.result));
  if (path != RivalPath::Robust)
    return specimen.cut_again(file, specimen.at(name), name, !is_without_simulation(path)).cut;
  const steps::CalibratedRequest known{root_ / "calibration/calibration.json", specimen.stretch_force_n()};
  return specimen.cut_robustly(file, known, specimen.at(name), name);
}

/// Cuts along what the first photographs alone forecast, without and with simulation.
void Experiment::cut_learning(SpecimenTrial& specimen, Trial& trial, Reported& reported) {
  for (const Learning& learning : learning_) {
    const std::string suffix = fmt::format("_{}", learning.photographs);
    const std::filesystem::path file =
        specimen.write_variant("forecast" + suffix + ".yaml",
                               {learning.tool, specimen.youngs_modulus_kpa(), calibrated_choice(learning.tool)});
    const StepAnswer forecast =
        forecast_of(specimen, file, specimen.at("forecast" + suffix), learning.calibration, "forecast" + suffix);
    for (const RivalPath path : {RivalPath::Photographs, RivalPath::Learned}) {
      const std::string name = learning_name(path, learning.photographs);
      LearningCut& made = trial.learning.emplace_back(learning.photographs, path);
      if (forecast.end != StepEnd::Done) {
        made.cut.ended_at = refusal_of("forecast" + suffix, forecast);
        continue;
      }
      const std::filesystem::path variant = specimen.write_variant(
          name + ".yaml", forecast_variant(path, learning.tool, specimen.youngs_modulus_kpa(), forecast.result));
      made.cut = specimen.cut_again(variant, specimen.at(name), name, !is_without_simulation(path)).cut;
    }
    report_part(specimen, kLearningCost, reported);
  }
}

void Experiment::correct(SpecimenTrial& specimen, Trial& trial) {
  // The case holds what was calibrated: tool, stiffness, bias.
  SecondCut again = specimen.cut_again(specimen.case_file(), specimen.at("compensated"), "corrected");
  trial.compensation = std::move(again.compensation);
  trial.corrected = std::move(again.cut);
}

void Experiment::calibrate() {
  steps::CalibrateRequest asked;
  std::vector<std::filesystem::path> inputs;
  for (const Trial& trial : trials_) {
    if (trial.role != TrialRole::Calibrate || !trial.planned.measured) continue;
    const std::filesystem::path folder = root_ / trial.name;
    asked.cases.push_back(folder / "case.yaml");
    asked.observed.push_back(trial.planned.measured->evaluation);
    asked.forces_n.push_back(trial.stretch_force_n);
    asked.registrations.push_back(folder / "registration/registration.json");
    for (const std::filesystem::path& input : {asked.cases.back(), folder / "tumor.csv", folder / "lab/ct",
                                               asked.observed.back(), asked.registrations.back()})
      inputs.push_back(input);
  }
  if (asked.cases.empty())
    throw DataError(root_, "", "no specimen whose planned cut could be measured", "at least one, for the calibration");
  ExperimentSteps steps(root_, workers_, monitor_);
  const auto calibrated = [&](const std::string& step, CalibrationMethod method, const std::string& folder,
                              const char* product, std::size_t photographs) {
    steps::CalibrateRequest request = asked;
    request.cases.resize(photographs);
    request.observed.resize(photographs);
    request.forces_n.resize(photographs);
    request.registrations.resize(photographs);
    request.request.method = method;
    request.output = root_ / folder;
    std::vector<std::string> words{"calibrate"};
    for (const auto& file : request.cases) words.push_back(file.string());
    words.emplace_back("--observed");
    for (const auto& file : request.observed) words.push_back(file.string());
    words.emplace_back("--stretch-force-n");
    for (const double force_n : request.forces_n) words.push_back(fmt::format("{}", force_n));
    words.emplace_back("--registration");
    for (const auto& file : request.registrations) words.push_back(file.string());
    words.insert(words.end(), {"--method", std::string(to_string(method)), "-o", request.output.string()});
    return steps.run({step, words, inputs, {request.output / product}, [=](const steps::StepContext& context) {
                        return steps::calibrate_on_cuts(request, context).step;
                      }});
  };
  const std::size_t all = asked.cases.size();
  const auto of_all = [&](const char* step, CalibrationMethod method, const char* folder, const char* product) {
    const StepAnswer answer = calibrated(step, method, folder, product, all);
    require_done(answer, step, steps);
    return answer.result;
  };
  calibration_ = of_all("calibrate", CalibrationMethod::Fit, "calibration", "calibration.json");
  tool_ = tool_of(calibration_);
  for (const std::size_t photographs : settings_.learning) {
    if (photographs >= all) continue;
    const std::string name = fmt::format("calibration_{}", photographs);
    const StepAnswer answer = calibrated(name, CalibrationMethod::Fit, name, "calibration.json", photographs);
    if (answer.end == StepEnd::Done)
      learning_.push_back({photographs, root_ / name / "calibration.json", tool_of(answer.result)});
    else
      warnings_.push_back(fmt::format("the calibration on the first {} photographs is not used: {}", photographs,
                                      refusal_of(name, answer)));
  }
  calibrated_kpa_ = mean_modulus_kpa(calibration_);
  if (!settings_.is_quick) table_1_ = of_all("table_1", CalibrationMethod::Paper, "table_1", "table_1.csv");
  calibration_commands_ = steps.lines();
  report_end(nullptr, calibration_cost(), steps.computed() == 0);
}

void Experiment::compare() {
  steps::CompareRequest request{.output = root_ / "comparison"};
  for (const Trial& trial : trials_) {
    if (trial.role != TrialRole::Test || !trial.planned.measured || !trial.corrected.measured) continue;
    request.before.push_back(trial.planned.measured->evaluation);
    request.after.push_back(trial.corrected.measured->evaluation);
  }
  if (request.before.empty()) return;
  request.settings.is_paired = true;
  std::vector<std::string> words{"compare", "--before"};
  for (const auto& file : request.before) words.push_back(file.string());
  words.emplace_back("--after");
  for (const auto& file : request.after) words.push_back(file.string());
  words.insert(words.end(), {"--paired", "-o", request.output.string()});
  std::vector<std::filesystem::path> inputs = request.before;
  inputs.insert(inputs.end(), request.after.begin(), request.after.end());
  ExperimentSteps steps(root_, workers_, monitor_);
  const StepAnswer compared =
      steps.run({"compare", words, inputs, {request.output / "compare.json"}, [=](const steps::StepContext& context) {
                   steps::CompareRequest seeded = request;
                   seeded.settings.bootstrap.seed = context.run.seed;
                   return steps::compare_cuts(seeded, context).step;
                 }});
  require_done(compared, "compare", steps);
  comparison_ = compared.result;
  comparison_commands_ = steps.lines();
}

/// Every command in an order in which they could be given by hand. 4 is an answer: not acceptable.
void Experiment::write_commands() const {
  write_atomically(root_ / "commands.sh", [&](std::ostream& out) {
    out << "#!/bin/sh\n# The commands of this virtual experiment. Case files and tumor.csv are written between them by "
           "`incise experiment`.\nset -e\n"
           "incise() { command incise \"$@\" || [ $? -eq 4 ]; }\n";
    const auto write = [&out](const std::string& title, const std::vector<std::string>& lines) {
      out << "\n# " << title << '\n';
      for (const std::string& line : lines) out << line << '\n';
    };
    const auto write_trials = [&](bool is_calibration) {
      for (const Trial& trial : trials_) {
        if ((trial.role == TrialRole::Calibrate) == is_calibration)
          write(fmt::format("{} ({})", trial.name, to_string(trial.role)), trial.commands);
      }
    };
    write_trials(true);
    write("calibration", calibration_commands_);
    write_trials(false);
    write("before and after", comparison_commands_);
  });
}

}  // namespace
}  // namespace incise::laboratory

namespace incise {

void describe(Visitor& v, ExperimentSettings& s) {
  v("bench", s.bench,
    "1: the first laboratory, whose specimens are much alike; 2: the second, whose specimens, margins, depths and "
    "speeds differ widely (`incise schema bench2`). Specimens of laboratory 2 are one series, that of the run's seed.",
    {1.0, 2.0});
  v("specimens", s.specimens,
    "Number of specimens, even: half to calibrate on, half to test; 4: as in the paper, and one outside the calibrated "
    "range. Their seeds count up from the run's, so start another experiment beyond the last seed of this one.",
    {2.0, 200.0});
  v("outside", s.outside,
    "Further specimens unlike those calibrated on (stiff, oedematous, scarred, oedematous, soft in turn), to compare "
    "the advice of `assess` with what happens; by default one if there are four specimens, otherwise none. First "
    "laboratory only.",
    {0.0, 200.0});
  v("quick", s.is_quick, "Skip the grid of 25 pairs of speed and dullness (Table I).");
  v("rivals", s.with_rivals, "Whether test specimens are also cut along every rival's path.");
  v("paper_pass", s.with_paper_pass, "Without the rivals: still cut along the paper's single radial correction.");
  v("known_physics", s.with_known_physics,
    "Also cut every test specimen as a planner that knows the bench's physics would (first laboratory).");
  v("withheld_force", s.with_withheld_force, "Also run `assess` as if the pull had not been measured.");
  v("learning", s.learning,
    "Also cut test specimens along forecasts from only the first photographs, as many as each of these numbers (such "
    "as 1,2,4,8), without and with simulation, to show what photographs are worth.",
    {1.0, 100.0});
  v("overrides", s.overrides, "Failed checks of every program to override.");
  v("tets", s.tets, "Number of tetrahedra of the planner's meshes.", {5000.0, 500000.0});
  v("rule", s.rule, "Rule of the planner's simulated cuts: cut.rule of its cases.");
  std::string truth = s.truth.string();
  v("truth", truth, "Folder for the hidden specimens; by default truth/ in the output.");
  if (v.sets()) s.truth = truth;
}

std::vector<Problem> validate(const ExperimentSettings& s) {
  std::vector<Problem> problems = problems_of(s);
  if (s.specimens % 2 != 0)
    problems.push_back(
        {"specimens", fmt::format("{}", s.specimens), "an even number: half to calibrate on, half to test"});
  if (std::ranges::adjacent_find(s.learning, std::greater_equal<>()) != s.learning.end())
    problems.push_back({"learning", fmt::format("{}", fmt::join(s.learning, ",")), "ascending numbers"});
  if (!s.learning.empty() && !s.with_rivals)
    problems.push_back({"learning", "no rivals", "the rivals, with which the learning is compared"});
  if (s.bench == 2 && s.outside)
    problems.push_back({"outside", fmt::format("{} on the second bench", *s.outside),
                        "the option only with the first bench",
                        "Specimens of the second bench differ from one another anyway."});
  if (s.bench == 2 && s.with_known_physics)
    problems.push_back({"known_physics", "the second bench", "the option only with the first bench"});
  return problems;
}

nlohmann::ordered_json experiment(const ExperimentSettings& settings, const std::filesystem::path& output,
                                  const RunContext& run, Workers& workers, Monitor& monitor) {
  require_none(validate(settings));
  return laboratory::Experiment(settings, output, run, workers, monitor).run();
}

nlohmann::ordered_json experiment(const ExperimentSettings& settings, const std::filesystem::path& output,
                                  std::uint64_t seed) {
  Workers all(0);
  Monitor quiet;
  return experiment(settings, output, {"incise::experiment", seed, all.thread_count()}, all, quiet);
}

}  // namespace incise
