#include "option_checks.hpp"
#include "options.hpp"
#include "study_tables.hpp"

#include <incise/core/error.hpp>
#include <incise/core/version.hpp>
#include <incise/core/workers.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_text.hpp>
#include <incise/report/html_report.hpp>

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <ostream>

namespace incise::cli {
namespace {

using ExperimentJson = nlohmann::ordered_json;

struct ExperimentArguments {
  std::uint64_t specimens = 4;
  std::filesystem::path truth;
  bool is_quick = false;
  int tets = 25000;
};

/// Stiff tissue that slipped out of its clamp: far from all that is calibrated on, as the paper's failed specimen was.
const std::vector<std::pair<std::string, double>> kOutside{{"youngs_modulus_kpa", 48.0}, {"clamp_slip_mm", 9.0}};

class Experiment {
 public:
  Experiment(ExperimentArguments arguments, const CommonOptions& options, Console& console)
      : arguments_(std::move(arguments)), options_(options), console_(console), root_(options.required_output("study")),
        truth_(arguments_.truth.empty() ? root_ / "truth" : arguments_.truth), threads_(options.context().threads) {
    for (std::uint64_t i = 0; i < arguments_.specimens; ++i) {
      Trial trial;
      trial.name = fmt::format("S{}", i + 1);
      trial.seed = options.seed + i;
      trial.role = i < arguments_.specimens / 2 ? TrialRole::Calibrate : TrialRole::Test;
      trials_.push_back(std::move(trial));
    }
    if (arguments_.specimens == 4) {  // the paper's: two to calibrate, two corrected, and one that fails
      Trial failed;
      failed.name = "S5";
      failed.seed = options.seed + 4;
      failed.role = TrialRole::Outside;
      trials_.push_back(std::move(failed));
    }
  }

  ExperimentJson run();

 private:
  void run_trials(TrialRole first, TrialRole last);
  void run_trial(Trial& trial);
  void assess(SpecimenTrial& specimen, Trial& trial);
  void correct(SpecimenTrial& specimen, Trial& trial);
  void calibrate();
  void compare();
  void write_commands() const;
  [[nodiscard]] std::vector<std::filesystem::path> cut_files(TrialRole role, std::optional<TrialCut> Trial::*which) const;

  ExperimentArguments arguments_;
  const CommonOptions& options_;
  Console& console_;
  std::filesystem::path root_, truth_;
  int threads_;
  std::vector<Trial> trials_;
  std::optional<ChosenTool> tool_;
  ExperimentJson calibration_, table_1_, comparison_;
  std::vector<std::string> common_commands_;
  std::mutex mutex_;  // of the console while specimens go side by side
  std::size_t done_ = 0;
};

ExperimentJson Experiment::run() {
  const auto start = std::chrono::steady_clock::now();
  run_trials(TrialRole::Calibrate, TrialRole::Calibrate);
  calibrate();
  run_trials(TrialRole::Test, TrialRole::Outside);
  compare();
  write_table_2(root_ / "table_2.csv", trials_);
  write_commands();
  const TrialSummary summary = summary_of(trials_, TrialRole::Test);
  ExperimentJson result;
  result["specimen_is"] = "virtual";
  result["specimens"] = trials_.size();
  result["pairs"] = summary.pairs;
  result["mean_before_mm"] = summary.pairs > 0 ? ExperimentJson(summary.mean_before_mm) : ExperimentJson(nullptr);
  result["mean_after_mm"] = summary.pairs > 0 ? ExperimentJson(summary.mean_after_mm) : ExperimentJson(nullptr);
  result["gain_percent"] = summary.pairs > 0 ? ExperimentJson(summary.gain_percent) : ExperimentJson(nullptr);
  result["worse"] = summary.worse;
  result["most_worse_mm"] = summary.most_worse_mm;
  result["calibration"] = calibration_.is_object() ? calibration_.value("chosen", ExperimentJson()) : ExperimentJson(nullptr);
  result["specimens_test"] = comparison_.is_object() ? comparison_.value("specimens", ExperimentJson()) : ExperimentJson(nullptr);
  result["table_1"] = table_1_.is_object() ? table_1_.value("rows", ExperimentJson()) : ExperimentJson(nullptr);
  result["table_2"] = table_2_json(trials_);
  result["assessments"] = assessments_json(trials_);
  result["figures"] = ExperimentJson::array();
  for (const char* figure : {"comparison/box_plot.svg", "comparison/error_by_clock.svg", "table_1/table_1.svg", "calibration/fit.svg"}) {
    if (std::filesystem::exists(root_ / figure)) result["figures"].push_back((root_ / figure).string());
  }
  result["commands"] = (root_ / "commands.sh").string();
  write_report(experiment_report(trials_, result, root_), root_ / "report.html");
  result["report"] = (root_ / "report.html").string();
  result["wall_s"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_manifest(root_, manifest_of(options_, "{}", {}, result["wall_s"].get<double>()));
  write_json(root_ / "study.json", result);
  return result;
}

/// Specimens side by side, one thread each.
void Experiment::run_trials(TrialRole first, TrialRole last) {
  std::vector<Trial*> mine;
  for (Trial& trial : trials_)
    if (trial.role >= first && trial.role <= last) mine.push_back(&trial);
  Workers lanes(std::min<int>(threads_, static_cast<int>(mine.size())));
  lanes.for_each(mine.size(), 1, [&](std::size_t i) {
    run_trial(*mine[i]);
    const std::scoped_lock lock(mutex_);
    ++done_;
    if (!mine[i]->ended_at.empty()) console_.message(Severity::Warning, fmt::format("{} ended at {}", mine[i]->name, mine[i]->ended_at));
    console_.progress("virtual specimens", static_cast<double>(done_) / static_cast<double>(trials_.size()));
  });
}

void Experiment::run_trial(Trial& trial) {
  TrialSetup setup;
  setup.name = trial.name;
  setup.seed = trial.seed;
  if (trial.role == TrialRole::Outside) setup.given = kOutside;
  setup.folder = root_ / trial.name;
  setup.truth = truth_ / trial.name;
  setup.tets = arguments_.tets;
  SpecimenTrial specimen(setup, 1, console_);
  if (specimen.prepare(tool_)) {
    trial.planned = specimen.cut(specimen.planned_path(), "planned");
    if (trial.role != TrialRole::Calibrate) {
      assess(specimen, trial);
      correct(specimen, trial);
    }
  }
  trial.stretch_force_n = specimen.stretch_force_n();
  trial.youngs_modulus_kpa = specimen.youngs_modulus_kpa();
  trial.registration_rmse_mm = specimen.registration_rmse_mm();
  trial.ended_at = specimen.ended_at();
  trial.commands = specimen.commands();
}

/// What would be advised before the robot moves. The corrected cut is made on the bench whatever it says: whether the
/// advice was right is part of the experiment.
void Experiment::assess(SpecimenTrial& specimen, Trial& trial) {
  const std::filesystem::path folder = specimen.at("compensated"), calibration = root_ / "calibration/calibration.json";
  const StepRecord judged = specimen.ask({"assess",
                                          {"assess", specimen.case_file().string(), "--calibration", calibration.string(), "--registration",
                                           specimen.registration().string(), "--stretch-force-n", fmt::format("{}", specimen.stretch_force_n()), "-o",
                                           folder.string()},
                                          {specimen.case_file(), specimen.at("tumor.csv"), specimen.at("lab/ct"), calibration, specimen.registration()},
                                          folder / "assessment/assess.json"});
  trial.assessment = judged.result;
}

/// The correction, verified in simulation, and the second cut of the same specimen.
void Experiment::correct(SpecimenTrial& specimen, Trial& trial) {
  const std::filesystem::path folder = specimen.at("compensated");  // its case holds what was calibrated: tool, stiffness, bias
  const auto corrected = specimen.run({"compensate",
                                       {"compensate", specimen.case_file().string(), "-o", folder.string()},
                                       {specimen.case_file(), specimen.at("tumor.csv"), specimen.at("lab/ct")},
                                       folder / "correction/path.json"});
  if (!corrected) return;
  trial.compensation = corrected->result;
  trial.corrected = specimen.cut(folder / "correction/path.json", "corrected");
}

std::vector<std::filesystem::path> Experiment::cut_files(TrialRole role, std::optional<TrialCut> Trial::*which) const {
  std::vector<std::filesystem::path> files;
  for (const Trial& trial : trials_) {
    const bool is_whole = trial.planned && (role == TrialRole::Calibrate || trial.corrected);
    if (trial.role == role && is_whole) files.push_back((trial.*which)->evaluation);
  }
  return files;
}

void Experiment::calibrate() {
  std::vector<std::string> cases, observed{"--observed"}, forces{"--stretch-force-n"}, registrations{"--registration"};
  std::vector<std::filesystem::path> inputs;
  for (const Trial& trial : trials_) {
    if (trial.role != TrialRole::Calibrate || !trial.planned) continue;
    const std::filesystem::path file = root_ / trial.name / "case.yaml";
    cases.push_back(file.string());
    observed.push_back(trial.planned->evaluation.string());
    forces.push_back(fmt::format("{}", trial.stretch_force_n));
    const std::filesystem::path registration = root_ / trial.name / "registration/registration.json";
    registrations.push_back(registration.string());
    for (const std::filesystem::path& input : {file, root_ / trial.name / "tumor.csv", trial.planned->evaluation, registration}) inputs.push_back(input);
  }
  if (cases.empty()) throw DataError(root_, "", "no specimen whose planned cut could be measured", "at least one to calibrate on");
  StepRunner runner(root_, threads_, console_);
  const auto arguments = [&](const std::string& method, const std::filesystem::path& folder) {
    std::vector<std::string> words{"calibrate"};
    for (const auto* list : {&cases, &observed, &forces, &registrations}) words.insert(words.end(), list->begin(), list->end());
    for (const std::string& word : {std::string("--method"), method, std::string("-o"), folder.string()}) words.push_back(word);
    return words;
  };
  const StepRecord fit = runner.run({"calibrate", arguments("fit", root_ / "calibration"), inputs, root_ / "calibration/calibration.json"});
  calibration_ = fit.result;
  if (fit.status != kDone) throw DataError(root_ / "calibration", "", "a calibration in which every simulation failed", "one that can be used");
  const ExperimentJson& chosen = calibration_.at("chosen");
  tool_ = ChosenTool{chosen.at("speed_mm_s").get<double>(), chosen.at("dullness").get<double>(),
                     calibration_.at("posterior").at("bias_mm").at("mean").get<double>()};
  if (!arguments_.is_quick) table_1_ = runner.run({"table_1", arguments("paper", root_ / "table_1"), inputs, root_ / "table_1/table_1.csv"}).result;
  common_commands_ = runner.lines();
}

void Experiment::compare() {
  const auto before = cut_files(TrialRole::Test, &Trial::planned), after = cut_files(TrialRole::Test, &Trial::corrected);
  if (before.empty()) return;
  std::vector<std::string> words{"compare", "--before"};
  std::vector<std::filesystem::path> inputs;
  for (const auto& file : before) words.push_back(file.string());
  words.emplace_back("--after");
  for (const auto& file : after) words.push_back(file.string());
  for (const std::string& word : {std::string("--paired"), std::string("-o"), (root_ / "comparison").string()}) words.push_back(word);
  for (const auto* files : {&before, &after}) inputs.insert(inputs.end(), files->begin(), files->end());
  StepRunner runner(root_, threads_, console_);
  comparison_ = runner.run({"compare", words, inputs, root_ / "comparison/compare.json"}).result;
  for (const std::string& line : runner.lines()) common_commands_.push_back(line);
}

/// Every command in an order in which they could be given by hand.
void Experiment::write_commands() const {
  write_atomically(root_ / "commands.sh", [&](std::ostream& out) {
    out << "#!/bin/sh\n# The commands of this virtual experiment. Case files and tumor.csv are written between them by `incise study`.\nset -e\n";
    for (const Trial& trial : trials_) {
      out << "\n# " << trial.name << " (" << to_string(trial.role) << ")\n";
      for (const std::string& line : trial.commands) out << line << '\n';
    }
    out << "\n# all specimens\n";
    for (const std::string& line : common_commands_) out << line << '\n';
  });
}

int run_experiment(const ExperimentArguments& arguments, const CommonOptions& options) {
  if (arguments.specimens % 2 != 0)
    throw CaseError("command line", "--specimens", fmt::format("{}", arguments.specimens), "an even number: half to calibrate on, half to test");
  Console console(options.level());
  const std::filesystem::path root = options.required_output("study");
  std::filesystem::create_directories(root);
  ExperimentJson result;
  try {
    result = Experiment(arguments, options, console).run();
  } catch (const Cancelled& error) {
    throw StagesKept(error.what(), fmt::format("what was finished is kept in {}", root.string()));
  }
  print_result(options, result);
  return result.at("pairs").get<std::size_t>() > 0 ? kDone : kNotAcceptable;
}

}  // namespace

void add_study(Application& application) {
  auto arguments = std::make_shared<ExperimentArguments>();
  CLI::App* verb = application.add_verb(
      "study",
      "The paper's whole experiment on the virtual bench: specimens are cut as planned, the simulation is calibrated to their photographs, further "
      "specimens are cut as planned and corrected, and all is measured. Everything that it yields is virtual. Run again, it goes on where it was",
      "incise study --quick -o study", [arguments](const CommonOptions& options) { return run_experiment(*arguments, options); });
  verb->add_option("--specimens", arguments->specimens, "Half to calibrate on, half to test; 4: the paper's, and one outside the calibrated range")
      ->check(whole_between("--specimens", 2, 200));
  verb->add_flag("--quick", arguments->is_quick, "Without the grid of 25 pairs of speed and dullness (Table I)");
  verb->add_option("--tets", arguments->tets, "Of the planner's meshes")->check(CLI::Range(5000, 500000));
  verb->add_option("--truth", arguments->truth, "Folder for the hidden specimens; by default truth/ in the output");
}

}  // namespace incise::cli
