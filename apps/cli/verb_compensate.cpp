#include "calibrated_case.hpp"
#include "compensation_figures.hpp"
#include "option_checks.hpp"

#include <incise/core/error.hpp>
#include <incise/io/described_json.hpp>
#include <incise/storage/result_json.hpp>
#include <incise/workflow/assess.hpp>

#include <fmt/format.h>

#include <chrono>
#include <memory>

namespace incise::cli {
namespace {

struct CompensateOptions {
  std::filesystem::path case_path;
  CutOptions cut;
  bool is_robust = false;
  CalibratedOptions calibrated;
  double max_probability = ScenarioRequest{}.max_probability;
};

/// What was left of the mean error per pass; one pass of the paper's: after over before.
nlohmann::ordered_json contraction_of(const Study& study) {
  if (!study.correction) return nullptr;
  if (study.correction->iteration) {
    const std::optional<double>& contraction = study.correction->iteration->contraction;
    return contraction ? nlohmann::ordered_json(*contraction) : nlohmann::ordered_json(nullptr);
  }
  if (!study.corrected || !study.corrected->centerline.abs_error_mm) return nullptr;
  return study.corrected->centerline.abs_error_mm->mean / study.as_planned->centerline.abs_error_mm->mean;
}

nlohmann::ordered_json summary_of(const Study& study) {
  nlohmann::ordered_json json;
  if (!study.as_planned) return to_json(*study.stretched);
  const std::size_t simulations = study.correction && study.correction->iteration
                                      ? study.correction->iteration->passes.size()
                                  : study.corrected ? 2
                                                    : 1;
  json["outcome"] = to_string(study.outcome);
  json["verdict"] = to_json(study.verdict);
  json["accepted"] = study.is_accepted;
  json["passes"] = simulations - 1;
  json["simulations"] = simulations;
  json["contraction"] = contraction_of(study);
  json["compensation_outcome"] = nullptr;
  if (study.correction && study.correction->iteration)
    json["compensation_outcome"] = to_string(study.correction->iteration->outcome);
  json["floor_mm"] = nullptr;
  if (study.correction && study.correction->floor_mm) json["floor_mm"] = *study.correction->floor_mm;
  json["before"] = to_json(*study.as_planned);
  json["after"] = study.corrected ? to_json(*study.corrected) : nlohmann::ordered_json(nullptr);
  json["correction"] = study.correction ? correction_summary_json(*study.correction) : nlohmann::ordered_json(nullptr);
  return json;
}

/// --robust and what it needs go together.
void require_robust_options(const CompensateOptions& chosen) {
  const bool has_calibration = !chosen.calibrated.calibration.empty();
  if (chosen.is_robust && !has_calibration) {
    throw CaseError("command line", "--robust", "no --calibration",
                    "--calibration C.json, whose posterior the path has to be right for");
  }
  if (!chosen.is_robust && (has_calibration || chosen.calibrated.stretch_force_n)) {
    throw CaseError("command line", has_calibration ? "--calibration" : "--stretch-force-n", "no --robust",
                    "--robust: the other methods do not look at a posterior");
  }
}

void require_default_method(const CaseFile& file) {
  if (file.settings.compensation.method == CompensationMethod::Default) return;
  throw CaseError("command line", "--robust", "the paper's method", "--method default, from whose path it starts");
}

/// The path that is right for the whole posterior; what is said of it.
nlohmann::ordered_json add_robust_path(const CompensateOptions& chosen, const CalibrationInput& calibration,
                                       StudyRun& run, const Study& study, const CommonOptions& options,
                                       Console& console) {
  const auto start = std::chrono::steady_clock::now();
  Workers workers(options.threads);
  ScenarioRequest request = scenario_request(chosen.calibrated, options);
  request.max_probability = chosen.max_probability;
  const RobustCorrection robust = with_tissues(run, [&] {
    return correct_robustly(run.folder.case_file().settings, run.folder, run.folder.cache(), study, calibration.belief,
                            request, workers, console);
  });
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  write_robust(run.folder, robust, calibration.file, wall.count());
  nlohmann::ordered_json json = robust_summary_json(robust);
  json["path"] = (run.folder.root() / "robust" / "path.json").string();
  json["wall_s"] = wall.count();
  if (calibration.found.is_virtual && !run.folder.case_file().settings.is_virtual)
    console.message(Severity::Warning, fmt::format("robust path: {}", kVirtualCalibration));
  const RobustCompensation& made = robust.compensation;
  if (made.outcome != RobustOutcome::Met) {
    console.message(
        Severity::Warning,
        fmt::format(
            "robust path: {}: a margin below {} mm somewhere has a probability of {:.3f}, or {:.3f} if the tissues "
            "whose ring stayed open count, and not at most {}",
            to_string(made.outcome), robust.settings.region.close_margin_mm, made.robust.p_close_margin,
            made.robust.p_close_bound(), chosen.max_probability));
  }
  return json;
}

int compensate(const CompensateOptions& chosen, const CommonOptions& options) {
  Console console(options.level());
  require_robust_options(chosen);
  std::optional<CalibrationInput> calibration;
  if (chosen.is_robust) calibration = read_calibration_input(chosen.calibrated);
  const std::filesystem::path output = output_of(chosen.case_path, options);
  if (chosen.is_robust) require_default_method(case_as_asked(chosen.case_path, chosen.cut));
  StudyRun run(chosen.case_path, output, Stage::Verify, options, chosen.cut);
  const Study study = run.study(console);
  nlohmann::ordered_json result = summary_of(study);
  bool is_robust_enough = true;
  if (chosen.is_robust) {
    result["robust"] = nullptr;
    is_robust_enough = false;
    if (study.corrected) {
      result["robust"] = add_robust_path(chosen, *calibration, run, study, options, console);
      is_robust_enough = result["robust"]["outcome"] == to_string(RobustOutcome::Met);
    }
  }
  result["folder"] = run.folder.folder("correction").string();
  if (study.correction) result["path"] = (run.folder.folder("correction") / "path.json").string();
  result["figures"] = nlohmann::ordered_json::array();
  for (const auto& figure : write_compensation_figures(output, output / "figures"))
    result["figures"].push_back(figure.string());
  result["stages"] = to_json(study.stages);
  print_study(options, result);
  if (study.outcome == Outcome::Success && !study.is_accepted) {
    console.message(Severity::Warning,
                    "the correction is not accepted: the mean error has to be below the electrode's radius and smaller than before, and "
                    "depth and closure no worse");
  }
  return study.is_accepted && is_robust_enough && study.verdict.status() != VerdictStatus::Refused ? kDone : kNotAcceptable;
}

}  // namespace

void add_compensation_method(CLI::App& verb, CutOptions& options) {
  verb.add_option_function<std::string>(
          "--method", [&options](const std::string& name) { options.method = value_named<CompensationMethod>(name); },
          "default: pass by pass until the cut lies where it was intended, at most 4 cuts in all (8 where something is "
          "held against the nearest); paper: each waypoint moves once by the error "
          "measured there. In place of the case's compensation.method")
      ->check(name_of_any<CompensationMethod>());
}

void add_compensate(Application& application) {
  auto chosen = std::make_shared<CompensateOptions>();
  CLI::App* verb =
      application.add_verb("compensate", "Correct the path by the simulated error and verify it by cutting again",
                           "incise compensate specimen -o out",
                           [chosen](const CommonOptions& options) { return compensate(*chosen, options); });
  verb->add_option("case", chosen->case_path, "Case file, or a folder with case.yaml")->required();
  add_cut_options(*verb, chosen->cut);
  add_compensation_method(*verb, chosen->cut);
  verb->add_flag(
      "--robust", chosen->is_robust,
      "Also choose the path of least expected error over the calibration's posterior, with a probability of a close "
      "margin anywhere of at most --max-probability: OUT/robust/path.json. Status 4 where there is none");
  add_calibrated_options(*verb, chosen->calibrated);
  verb->add_option("--max-probability", chosen->max_probability,
                   "Of less tissue than the close margin anywhere, with --robust")
      ->check(between("--max-probability", 1e-4, 0.9999));
}

}  // namespace incise::cli
