#include "steps/calibrated_case.hpp"

#include <incise/core/described_json.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/steps/registration_trust.hpp>
#include <incise/storage/registration_json.hpp>
#include <incise/workflow/assess.hpp>
#include <incise/workflow/cut_verdict.hpp>

#include <cmath>

namespace incise::steps {
namespace {

/// Reads from the registration's file how well the specimen was found. @returns the objections to the registration.
Verdict read_specimens_registration(const std::filesystem::path& file, AssessmentRequest& request) {
  const RegistrationRecord record = read_registration(file);
  if (!record.is_converged)
    throw DataError(file, "converged", "nothing", "true or false, as `incise register` writes it");
  request.is_registered = record.T_target_source && *record.is_converged;
  request.registration.scale = record.scale;
  if (record.rmse_mm) {
    request.registration.rmse_mm = *record.rmse_mm;
  } else if (record.T_target_source) {
    throw DataError(file, "rmse_mm", "no number", "the distance between the surfaces, as `incise register` writes it");
  }
  return verdict_of(record, file);
}

/// Only a ring that is corrected pass by pass can be assessed.
void require_ring_by_default_method(const CaseFile& file) {
  const Case& settings = file.settings;
  if (settings.plan.kind != PlanKind::Ring)
    throw CaseError("case", "plan.kind", std::string(to_string(settings.plan.kind)), "ring")
        .in_file(file.file.string());
  if (settings.compensation.method != CompensationMethod::Default)
    throw CaseError("case", "compensation.method", std::string(to_string(settings.compensation.method)), "default")
        .in_file(file.file.string());
  require_planned_path(file);
}

}  // namespace

std::string other_tool(const CutSettings& cut, const Calibration& calibration) {
  if (!calibration.chosen) return {};
  constexpr double kSame = 1e-3;
  const double here_mm = cut.speed_mm_s * cut.dwell_s();
  const double calibrated_mm =
      calibration.chosen->speed_mm_s * calibration.chosen->dullness * calibration.reference_step_s;
  if (std::abs(here_mm / calibrated_mm - 1.0) <= kSame) return {};
  return fmt::format(
      "the drag length of the case's cut.speed_mm_s and cut.dullness is {:.2f} mm, that of the calibration's choice "
      "{:.2f} mm: the calibration does not apply to this tool",
      here_mm, calibrated_mm);
}

StepResult assess_case(const CaseRequest& of, const CalibrationInput& calibration,
                       const std::filesystem::path& registration, const StepContext& context) {
  AssessmentRequest request;
  request.scenarios = scenario_request(calibration.request, context);
  request.calibrated = range_of(calibration.found);
  request.is_calibration_virtual = calibration.found.is_virtual;
  const Verdict of_registration = read_specimens_registration(registration, request);
  report_reasons(of_registration, context.monitor);
  require_ring_by_default_method(of.file);
  require_rule_of(calibration, of.file);
  const std::string note = other_tool(of.file.settings.cut, calibration.found);
  if (!note.empty()) context.monitor.message(Severity::Warning, note);
  CaseRun run(of.file, of.output, of.options, context.run);
  require_same_specimen(registration, run.folder.specimen_id(), "the case's");
  const Study study = run.study(context.workers, context.monitor);
  Assessment assessment = with_tissues(run, [&] {
    return assess(run.folder.case_file().settings, run.folder, run.folder.cache(), study, calibration.belief, request,
                  context.workers, context.monitor);
  });
  if (!note.empty()) assessment.notes.push_back(note);
  const double wall_s = context.wall_s();
  StepResult done{to_json(assessment)};
  nlohmann::ordered_json& result = done.json;
  result["specimen_is"] = run.folder.case_file().settings.is_virtual ? "virtual" : "real";
  result["calibration_is"] = calibration.found.is_virtual ? "virtual" : "real";
  result["specimen_id"] = run.folder.specimen_id();
  result["verdict"] = nullptr;  // known once the assessment is kept
  write_assessment(run.folder, result, calibration.request.calibration, registration, wall_s);
  Verdict verdict = study.verdict;
  verdict.add(of_registration);
  const Verdict advice = run.folder.advice_against(study.is_accepted);
  verdict.add(advice);
  run.folder.remove_program_made_without(advice, context.monitor);
  result["verdict"] = to_json(verdict);
  if (study.corrected) {
    Verdict of_corrected = study.about_inputs;
    of_corrected.add(study.corrected->verdict);
    if (!study.is_accepted) of_corrected.add("not_corrected", {}, rejected_correction(study.correction_note));
    run.folder.verdicts({}, of_corrected);
  }
  result["folder"] = run.folder.root().string();
  result["wall_s"] = wall_s;
  done.is_acceptable = assessment.eligibility.advice != Advice::DoNotUse;
  return done;
}

}  // namespace incise::steps
