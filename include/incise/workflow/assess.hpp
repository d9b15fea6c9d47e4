#pragma once

#include <incise/calibration/calibration.hpp>
#include <incise/planning/eligibility.hpp>
#include <incise/workflow/robust_correction.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise {

/// What is known of the specimens that a calibration is of; a list is shorter where something was not measured.
struct CalibratedRange {
  std::vector<double> youngs_modulus_kpa;
  std::vector<double> compliance_mm_n;  ///< stretch over pull
  std::vector<double> registration_rmse_mm;
  std::vector<double> registration_scale;
  std::vector<double> signed_error_mm;  ///< mean along the ring, as photographed
};

struct AssessmentRequest {
  ScenarioRequest scenarios;
  EligibilityRules rules;
  CalibratedRange calibrated;
  RegistrationQuality registration;  ///< of this specimen
  bool is_registered = true;         ///< nothing argued against its transform
  bool is_calibration_virtual = false;  ///< a specimen of the calibration is a synthetic body
};

struct Assessment {
  Eligibility eligibility;
  EligibilityEvidence evidence;
  std::optional<CorrectionOutlook> outlook;       ///< absent: there was no correction to look at
  std::vector<std::string> notes;                 ///< what was not known, and what that costs
  EligibilityRules rules;                         ///< that it was judged by
  double registration_scale = 1.0;
};
void describe(Visitor& v, Assessment& a);

/// Should this specimen be cut along the corrected path? Gathers what is known of it, cuts both paths in the tissue
/// that the calibration expects, adds what its photographs say of real cuts, and judges. A calibration of virtual
/// specimens never advises to correct a real one. See docs/models/eligibility.md.
/// @param done  the case's study up to Stage::Verify, however it ended.
/// @throws as correct_robustly.
[[nodiscard]] Assessment assess(const Case& settings, Inputs& inputs, Cache& cache, const Study& done,
                                const CalibratedBelief& belief, const AssessmentRequest& request, Workers& workers,
                                Monitor& monitor);

inline constexpr const char* kVirtualCalibration =
    "the calibration is of virtual specimens and this one is real: how its tissue drags was never measured on tissue";
/// What is left of a judgement of a real specimen whose calibration is of synthetic bodies: at best to cut as planned,
/// and kVirtualCalibration among the reasons.
[[nodiscard]] Eligibility by_virtual_calibration(Eligibility judged);

/// How far the case displaces the tissue that it pulls, mm: the farthest of its displacements; 0: it does not pull.
[[nodiscard]] double stretch_mm(const TissueModel& model);

}  // namespace incise
