#include "calibrated_case.hpp"

#include <fmt/format.h>

namespace incise::cli {
namespace {

struct AssessOptions : CaseArguments {
  std::filesystem::path registration;
  steps::CalibratedRequest calibrated;
};

void print_assessment(const nlohmann::ordered_json& result) {
  fmt::print("{}\n", result.at("advice").get<std::string>());
  for (const char* key : {"reasons", "notes"})
    for (const auto& line : result.at(key))
      fmt::print("  {}{}\n", key == std::string("notes") ? "note: " : "", line.get<std::string>());
  for (const auto& d : result.at("distances"))
    fmt::print("{:<36} {:>10.4g}   {:+.2f} sd from the calibration's mean {:.4g}\n", d.at("name").get<std::string>(),
               d.at("value").get<double>(), d.at("in_sd").get<double>(), d.at("calibrated_mean").get<double>());
  for (const char* path : {"intended", "corrected"}) {
    const auto& risk = result.at(path);
    if (!risk.is_object() || risk.at("p_close_margin").is_null()) continue;
    const auto& middle = risk.at("abs_error_80_mm");
    fmt::print("{:<36} {:>10.3f} mm expected (80 %: {:.2f} to {:.2f}), P(close margin) {:.3f}\n", path,
               risk.at("expected_abs_error_mm").get<double>(), middle.at(0).get<double>(), middle.at(1).get<double>(),
               risk.at("p_close_margin").get<double>());
  }
}

int assess_case(const AssessOptions& chosen, const CommonOptions& options) {
  const steps::CalibrationInput calibration = steps::read_calibration_input(chosen.calibrated);
  return run_step(
      options,
      [&](const auto& context) {
        return steps::assess_case(case_request(chosen, Stage::Verify, options), calibration, chosen.registration,
                                  context);
      },
      print_assessment);
}

}  // namespace

void add_assess(Application& application) {
  auto [verb, a] = application.add_verb<AssessOptions>(
      "assess",
      "Advise whether to cut this specimen along the corrected path: compensate, cut_as_planned (both exit status 0) "
      "or do_not_use (4). States the correction's gain, averaged over a calibration's posterior, its uncertainty, and "
      "how far the specimen lies from those of the calibration",
      "incise assess specimen --calibration calibration/calibration.json --registration "
      "registration/registration.json -o out",
      assess_case);
  add_case(*verb, a.case_path);
  add_calibrated_options(*verb, a.calibrated)->required();
  verb->add_option("--registration", a.registration, "registration.json of `incise register` for this specimen")
      ->required();
  add_cut_options(*verb, a.cut);
}

}  // namespace incise::cli
