#include "calibrated_case.hpp"
#include "options.hpp"
#include "registration_trust.hpp"

#include <incise/core/error.hpp>
#include <incise/io/described_json.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/storage/registration_json.hpp>
#include <incise/workflow/assess.hpp>

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <memory>

namespace incise::cli {
namespace {

struct AssessOptions {
  std::filesystem::path case_path, registration;
  CutOptions cut;
  CalibratedOptions calibrated;
};

/// What the registration's file says of how well the specimen was found. @returns what is held against it.
Verdict read_specimens_registration(const std::filesystem::path& file, AssessmentRequest& request) {
  const RegistrationRecord record = read_registration(file);
  if (!record.is_converged)
    throw DataError(file, "converged", "nothing", "true or false, as `incise register` writes it");
  request.is_registered = record.T_target_source && *record.is_converged;
  request.registration.scale = record.scale;
  if (record.rmse_mm) {
    request.registration.rmse_mm = *record.rmse_mm;
  } else if (record.T_target_source) {
    throw DataError(file, "rmse_mm", "no number", "how far the surfaces lie apart, as `incise register` writes it");
  }
  return verdict_of(record, file);
}

/// What is foreseen is a ring that is corrected pass by pass.
void require_ring_by_default_method(const CaseFile& file) {
  const Case& settings = file.settings;
  if (settings.plan.kind != PlanKind::Ring)
    throw CaseError("case", "plan.kind", std::string(to_string(settings.plan.kind)), "ring")
        .in_file(file.file.string());
  if (settings.compensation.method == CompensationMethod::Default) return;
  throw CaseError("case", "compensation.method", std::string(to_string(settings.compensation.method)), "default")
      .in_file(file.file.string());
}

/// A correction by another tool than the calibration's is seldom what is meant. Empty: it is the same.
std::string other_tool(const CutSettings& cut, const Calibration& calibration) {
  if (!calibration.chosen) return {};
  constexpr double kSame = 1e-3;
  const double here_mm = cut.speed_mm_s * cut.dwell_s();
  const double calibrated_mm =
      calibration.chosen->speed_mm_s * calibration.chosen->dullness * calibration.reference_step_s;
  if (std::abs(here_mm / calibrated_mm - 1.0) <= kSame) return {};
  return fmt::format(
      "the case's cut.speed_mm_s and cut.dullness hold tissue over {:.2f} mm, those that the calibration chose over "
      "{:.2f} mm: the correction that is judged is not that of the calibrated tool",
      here_mm, calibrated_mm);
}

void print_assessment(const nlohmann::ordered_json& result) {
  fmt::print("{}\n", result.at("advice").get<std::string>());
  for (const char* key : {"reasons", "notes"})
    for (const auto& line : result.at(key))
      fmt::print("  {}{}\n", key == std::string("notes") ? "note: " : "", line.get<std::string>());
  for (const auto& d : result.at("distances"))
    fmt::print("{:<36} {:>10.4g}   {:+.2f} sd from the calibration's {:.4g}\n", d.at("name").get<std::string>(),
               d.at("value").get<double>(), d.at("in_sd").get<double>(), d.at("calibrated_mean").get<double>());
  for (const auto& s : result.at("sensitivity"))
    fmt::print("{:<36} {:>10.3f} mm of error per sd of {:.3g}\n", s.at("name").get<std::string>(),
               s.at("change_mm").get<double>(), s.at("sd").get<double>());
  for (const char* path : {"intended", "corrected"}) {
    const auto& risk = result.at(path);
    if (!risk.is_object() || risk.at("p_close_margin").is_null()) continue;
    fmt::print("{:<36} {:>10.3f} mm expected, P(close margin) {:.3f}\n", path,
               risk.at("expected_abs_error_mm").get<double>(), risk.at("p_close_margin").get<double>());
  }
}

int assess_case(const AssessOptions& chosen, const CommonOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Console console(options.level());
  const CalibrationInput calibration = read_calibration_input(chosen.calibrated);
  AssessmentRequest request;
  request.scenarios = scenario_request(chosen.calibrated, options);
  request.calibrated = range_of(calibration.found);
  request.is_calibration_virtual = calibration.found.is_virtual;
  const Verdict of_registration = read_specimens_registration(chosen.registration, request);
  tell(of_registration, console);
  const CaseFile asked = case_as_asked(chosen.case_path, chosen.cut);
  require_ring_by_default_method(asked);
  const std::string note = other_tool(asked.settings.cut, calibration.found);
  if (!note.empty()) console.message(Severity::Warning, note);
  const std::filesystem::path output = output_of(chosen.case_path, options);
  StudyRun run(chosen.case_path, output, Stage::Verify, options, chosen.cut);
  require_same_specimen(chosen.registration, run.folder.specimen_id(), "the case's");
  const Study study = run.study(console);
  Workers workers(options.threads);
  Assessment assessment = with_tissues(run, [&] {
    return assess(run.folder.case_file().settings, run.folder, run.folder.cache(), study, calibration.belief, request,
                  workers, console);
  });
  if (!note.empty()) assessment.notes.push_back(note);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  nlohmann::ordered_json result = to_json(assessment, request);
  result["specimen_is"] = run.folder.case_file().settings.is_virtual ? "virtual" : "real";
  result["calibration_is"] = calibration.found.is_virtual ? "virtual" : "real";
  result["specimen_id"] = run.folder.specimen_id();
  result["verdict"] = nullptr;  // known once the assessment is kept
  write_assessment(run.folder, result, calibration.file, chosen.registration, wall.count());
  Verdict verdict = study.verdict;
  verdict.add(of_registration);
  verdict.add(run.folder.advice_against(study.is_accepted));
  result["verdict"] = to_json(verdict);
  if (study.corrected) {
    Verdict of_corrected = study.about_inputs;
    of_corrected.add(study.corrected->verdict);
    run.folder.verdicts({}, of_corrected);
  }
  result["folder"] = run.folder.root().string();
  result["wall_s"] = wall.count();
  if (options.json)
    print_result(options, result);
  else
    print_assessment(result);
  return assessment.eligibility.advice == Advice::DoNotUse ? kNotAcceptable : kDone;
}

}  // namespace

void add_assess(Application& application) {
  auto chosen = std::make_shared<AssessOptions>();
  CLI::App* verb =
      application.add_verb("assess",
                           "Should this specimen be cut along the corrected path? compensate, cut_as_planned (both "
                           "exit status 0) or do_not_use (4): what the "
                           "correction is expected to win over a calibration's posterior, how sure that is, and how "
                           "far the specimen lies from those that were "
                           "calibrated on",
                           "incise assess specimen --calibration calibration/calibration.json --registration "
                           "registration/registration.json -o out",
                           [chosen](const CommonOptions& options) { return assess_case(*chosen, options); });
  verb->add_option("case", chosen->case_path, "Case file, or a folder with case.yaml")->required();
  add_calibrated_options(*verb, chosen->calibrated)->required();
  verb->add_option("--registration", chosen->registration, "registration.json of `incise register` for this specimen")
      ->required();
  add_cut_options(*verb, chosen->cut);
}

}  // namespace incise::cli
