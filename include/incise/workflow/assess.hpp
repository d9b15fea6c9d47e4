#pragma once

#include <incise/calibration/calibration.hpp>
#include <incise/planning/eligibility.hpp>
#include <incise/workflow/robust_correction.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise {

/// Quantities of a calibration's specimens. A list is shorter if something was not measured.
struct CalibratedRange {
  std::vector<double> youngs_modulus_kpa;
  std::vector<double> compliance_mm_n;  ///< stretch over pull
  std::vector<double> registration_rmse_mm;
  std::vector<double> registration_scale;
  std::vector<double> signed_error_mm;  ///< mean along the ring, as photographed
};

/// What is known beside the case, and the rules of the judgement.
struct AssessmentRequest {
  ScenarioRequest scenarios;
  EligibilityRules rules;
  CalibratedRange calibrated;
  RegistrationQuality registration;     ///< of this specimen
  bool is_registered = true;            ///< whether nothing objects to its transform
  bool is_calibration_virtual = false;  ///< whether a specimen of the calibration is a synthetic body
};

/// Result of assess.
struct Assessment {
  Eligibility eligibility;
  EligibilityEvidence evidence;
  std::optional<CorrectionOutlook> outlook;  ///< absent: there was no correction
  std::vector<std::string> notes;            ///< what was not known, and the consequence
  EligibilityRules rules;                    ///< by which it was judged
  double registration_scale = 1.0;
};
void describe(Visitor& v, Assessment& a);

/// Assesses whether a specimen should be cut along its corrected path. Gathers what is known of the specimen, cuts both
/// paths in the tissue that the calibration expects, adds the differences of real cuts that its photographs show, and
/// judges. A calibration of virtual specimens never advises to correct a real one. See docs/models/eligibility.md.
/// @param done  the case's study up to Stage::Verify, however it ended.
/// @throws as correct_robustly.
[[nodiscard]] Assessment assess(const Case& settings, Inputs& inputs, Cache& cache, const Study& done,
                                const CalibratedBelief& belief, const AssessmentRequest& request, Workers& workers,
                                Monitor& monitor);

inline constexpr const char* kVirtualCalibration =
    "the calibration is of virtual specimens and this one is real: drag was never measured on real tissue";
/// Returns a judgement of a real specimen as a calibration of synthetic bodies allows it: at best to cut as planned,
/// with kVirtualCalibration among the reasons.
[[nodiscard]] Eligibility by_virtual_calibration(Eligibility judged);

/// Returns how far the case displaces the tissue, mm: the greatest of its displacements; 0 without any.
[[nodiscard]] double stretch_mm(const TissueModel& model);

}  // namespace incise
