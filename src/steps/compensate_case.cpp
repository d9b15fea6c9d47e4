#include "steps/calibrated_case.hpp"

#include <incise/core/described_json.hpp>
#include <incise/io/path_io.hpp>
#include <incise/steps/compensation_figures.hpp>
#include <incise/storage/result_json.hpp>
#include <incise/workflow/assess.hpp>

namespace incise::steps {
namespace {

/// Fraction of the mean error that remains after a pass; of a single pass: after over before.
nlohmann::ordered_json contraction_of(const Study& study) {
  if (!study.correction) return nullptr;
  if (study.correction->iteration) {
    const std::optional<double>& contraction = study.correction->iteration->contraction;
    return contraction ? nlohmann::ordered_json(*contraction) : nlohmann::ordered_json(nullptr);
  }
  if (!study.corrected || !study.corrected->centerline.abs_error_mm || !study.as_planned->centerline.abs_error_mm)
    return nullptr;
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
  json["correction_note"] =
      study.correction_note.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(study.correction_note);
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

void require_default_method(const CaseFile& file) {
  const CompensationMethod method = file.settings.compensation.method;
  if (method != CompensationMethod::Default)
    throw CaseError("command line", "--robust", fmt::format("method {}", to_string(method)),
                    "--method default: the robust path starts from its path");
  require_planned_path(file);
}

/// Computes and writes the robust path. @returns its summary.
nlohmann::ordered_json add_robust_path(const RobustRequest& chosen, CaseRun& run, const Study& study,
                                       const StepContext& context) {
  const CalibrationInput& calibration = chosen.calibration;
  const auto start = std::chrono::steady_clock::now();
  ScenarioRequest request = scenario_request(calibration.request, context);
  request.max_probability = chosen.max_probability;
  const RobustCorrection robust = with_tissues(run, [&] {
    return correct_robustly(run.folder.case_file().settings, run.folder, run.folder.cache(), study, calibration.belief,
                            request, context.workers, context.monitor);
  });
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  write_robust(run.folder, robust, calibration.request.calibration, wall.count());
  nlohmann::ordered_json json = to_json(robust);
  json["path"] = (run.folder.root() / "robust" / "path.json").string();
  json["wall_s"] = wall.count();
  if (calibration.found.is_virtual && !run.folder.case_file().settings.is_virtual)
    context.monitor.message(Severity::Warning, fmt::format("robust path: {}", kVirtualCalibration));
  const RobustCompensation& made = robust.compensation;
  if (made.outcome != RobustOutcome::Met) {
    context.monitor.message(
        Severity::Warning,
        fmt::format("robust path: {}: a margin below {} mm somewhere has a probability of {:.3f}, or {:.3f} if tissue "
                    "whose ring stays open counts as too close; at most {} is allowed",
                    to_string(made.outcome), robust.settings.region.close_margin_mm, made.robust.p_close_margin,
                    made.robust.p_close_bound(), chosen.max_probability));
  }
  return json;
}

}  // namespace

CalibrationInput read_calibration_input(const CalibratedRequest& request) {
  Calibration found = read_calibration(request.calibration);
  CalibratedBelief belief = belief_of(found, request.calibration);
  if (request.stretch_force_n && !belief.knows_forces) {
    throw CaseError("command line", "--stretch-force-n", "a pull, but a calibration without pulls",
                    "both with the pull of the suture, or both without");
  }
  return {request, std::move(found), std::move(belief)};
}

ScenarioRequest scenario_request(const CalibratedRequest& request, const StepContext& context) {
  ScenarioRequest scenarios;
  scenarios.stretch_force_n = request.stretch_force_n;
  scenarios.seed = context.run.seed;
  return scenarios;
}

void require_rule_of(const CalibrationInput& calibration, const CaseFile& file) {
  const CutRule rule = file.settings.cut.rule, calibrated = calibration.found.cut_rule.value_or(CutRule::Tets);
  if (rule == calibrated) return;
  throw CaseError(
      "case", "cut.rule", std::string(to_string(rule)),
      fmt::format("{}, the rule of the cuts in {}", to_string(calibrated), calibration.request.calibration.string()))
      .in_file(file.file.string());
}

void require_planned_path(const CaseFile& file) {
  if (file.inputs.tool_path.empty()) return;
  throw CaseError("case", "path", "a path of its own", "none",
                  "Photographs of earlier cuts show how far a cut along the planned path errs")
      .in_file(file.file.string());
}

StepResult compensate_case(const CaseRequest& request, const std::optional<RobustRequest>& robust,
                           const StepContext& context) {
  if (robust) {
    require_default_method(request.file);
    require_rule_of(robust->calibration, request.file);
  }
  CaseRun run(request.file, request.output, request.options, context.run);
  const Study study = run.study(context.workers, context.monitor);
  StepResult done{summary_of(study)};
  nlohmann::ordered_json& result = done.json;
  bool is_robust_enough = true;
  if (robust) {
    result["robust"] = nullptr;
    is_robust_enough = false;
    if (study.corrected) {
      result["robust"] = add_robust_path(*robust, run, study, context);
      is_robust_enough = result["robust"]["outcome"] == to_string(RobustOutcome::Met);
    }
  }
  result["folder"] = run.folder.folder("correction").string();
  if (study.correction) result["path"] = (run.folder.folder("correction") / "path.json").string();
  result["figures"] = nlohmann::ordered_json::array();
  for (const auto& figure : write_compensation_figures(run.folder.root(), run.folder.root() / "figures"))
    result["figures"].push_back(figure.string());
  result["stages"] = to_json(study.stages);
  if (study.outcome == Outcome::Success && !study.is_accepted) {
    context.monitor.message(Severity::Warning,
                            fmt::format("the correction is not accepted: {}", study.correction_note));
  }
  done.is_acceptable = study.is_accepted && is_robust_enough && study.verdict.status() != VerdictStatus::Refused;
  return done;
}

StepResult run_stages(const CaseRequest& request, const StepContext& context) {
  const Stage until = request.options.until;
  CaseRun run(request.file, request.output, request.options, context.run);
  const Study study = run.study(context.workers, context.monitor);
  const bool is_stretched = study.stretched && study.stretched->outcome == Outcome::Success;
  StepResult result;
  const char* product = "stretched";
  if (until == Stage::Plan) product = "plan";
  if (until == Stage::Simulate) product = "as_planned";
  if (until == Stage::Compensate) product = "correction";
  if (is_stretched && until == Stage::Plan) {
    result.json = plan_summary_json(*study.plan);
  } else if (is_stretched && until == Stage::Simulate) {
    result.json = to_json(*study.as_planned);
  } else if (is_stretched && until == Stage::Compensate && study.correction) {
    result.json = correction_summary_json(*study.correction);
    result.json["path"] = (run.folder.folder(product) / "path.json").string();
  } else {
    result.json = to_json(*study.stretched);
  }
  result.json["folder"] = run.folder.folder(product).string();
  result.json["stages"] = to_json(study.stages);
  bool is_refused = until == Stage::Simulate && study.verdict.status() == VerdictStatus::Refused;
  if (until == Stage::Compensate && study.correction) {  // objections to a path that was not cut
    const Verdict verdict = read_path_verdict(run.folder.folder(product) / "path.json");
    result.json["verdict"] = to_json(verdict);
    is_refused = verdict.status() == VerdictStatus::Refused;
  }
  const bool is_missing = until == Stage::Compensate && !study.correction;
  result.is_acceptable = study.outcome == Outcome::Success && !is_refused && !is_missing;
  return result;
}

}  // namespace incise::steps
