#include <incise/core/error.hpp>
#include <incise/workflow/assess.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace incise {
namespace {

// Usual spread between specimens that are alike, blended with that of the calibrated ones (see distance_from). Chosen,
// see the model page.
constexpr UsualSpread kUsualStiffness{.sd = 0.3, .is_logarithmic = true};
constexpr UsualSpread kUsualCompliance{.sd = 0.3, .is_logarithmic = true};
constexpr UsualSpread kUsualResidual{.sd = 0.3, .is_logarithmic = true, .is_better_below = true};
constexpr const char* kModulusName = "youngs_modulus_kpa";
constexpr UsualSpread kUsualScale{.sd = 0.01, .is_logarithmic = true};

/// Adds the distance of this specimen from the calibration's specimens in one quantity.
void add_distance(const char* name, double value, const std::vector<double>& calibrated, const UsualSpread& usual,
                  Assessment& assessment) {
  if (calibrated.empty()) {
    assessment.notes.push_back(
        fmt::format("{}: the calibration states it for no specimen, so its distance is not known", name));
    return;
  }
  assessment.evidence.distances.push_back(distance_from(name, value, calibrated, usual));
}

void compare_registration(const AssessmentRequest& request, Assessment& assessment) {
  if (!(request.registration.rmse_mm > 0.0)) return;  // none was found, or the surface was registered to itself
  add_distance("registration_rmse_mm", request.registration.rmse_mm, request.calibrated.registration_rmse_mm,
               kUsualResidual, assessment);
  add_distance("registration_scale", request.registration.scale, request.calibrated.registration_scale, kUsualScale,
               assessment);
}

void compare_stiffness(const AssessmentRequest& request, const ScenarioSet& scenarios, const TissueModel& model,
                       Assessment& assessment) {
  if (!request.scenarios.stretch_force_n) {
    assessment.notes.push_back(
        fmt::format("the pull was not measured: the case's modulus of {:.3g} kPa is assumed, with an uncertainty of "
                    "{:.2g} in its logarithm; whether the modulus lies in the calibrated range is not known",
                    scenarios.reference_kpa, scenarios.own_stiffness_sd));
    return;
  }
  add_distance(kModulusName, scenarios.reference_kpa, request.calibrated.youngs_modulus_kpa, kUsualStiffness,
               assessment);
  add_distance("compliance_mm_n", stretch_mm(model) / *request.scenarios.stretch_force_n,
               request.calibrated.compliance_mm_n, kUsualCompliance, assessment);
}

/// Why there is no correction to assess; empty: there is one.
std::string without_correction(const Study& done) {
  if (!done.stretched || done.stretched->outcome != Outcome::Success)
    return "the specimen could not be stretched in simulation";
  if (!done.as_planned) return "the cut as planned was not simulated";
  if (!done.corrected || !done.correction)
    return fmt::format("the cut as planned left nothing to correct: it {}", in_words(done.as_planned->outcome));
  return "";
}

}  // namespace

Eligibility by_virtual_calibration(Eligibility judged) {
  if (judged.advice == Advice::Compensate) {
    judged.advice = Advice::CutAsPlanned;
    judged.reasons.clear();  // they belong to the withdrawn advice
  }
  judged.reasons.emplace_back(kVirtualCalibration);
  return judged;
}

double stretch_mm(const TissueModel& model) {
  double farthest = 0.0;
  for (const Constraint& constraint : model.constraints) {
    if (const auto* pulled = std::get_if<DisplacedConstraint>(&constraint))
      farthest = std::max(farthest, pulled->displacement_mm.norm());
  }
  return farthest;
}

Assessment assess(const Case& settings, Inputs& inputs, Cache& cache, const Study& done, const CalibratedBelief& belief,
                  const AssessmentRequest& request, Workers& workers, Monitor& monitor) {
  Assessment assessment{.rules = request.rules, .registration_scale = request.registration.scale};
  EligibilityEvidence& evidence = assessment.evidence;
  evidence.is_registered = request.is_registered;
  evidence.calibrated_error_mm = request.calibrated.signed_error_mm;
  if (evidence.calibrated_error_mm.empty()) {
    assessment.notes.emplace_back(
        "the calibration does not state the mean errors of its cuts: for a specimen unlike its own, either cut is "
        "assumed equally likely to be the worse one");
  }
  evidence.registration_rmse_mm = request.registration.rmse_mm;
  compare_registration(request, assessment);
  evidence.no_gain_because = without_correction(done);
  if (evidence.no_gain_because.empty()) {
    evidence.is_accepted = done.is_accepted;
    assessment.outlook = foresee_correction(settings, inputs, cache, done, belief, request.scenarios, workers, monitor);
    const PathOutlook& paths = assessment.outlook->paths;
    evidence.intended = paths.intended;
    evidence.corrected = paths.corrected;
    evidence.gain = paths.gain;
    if (!paths.gain) evidence.no_gain_because = "in no tissue of the calibration did the ring close along both paths";
    compare_stiffness(request, assessment.outlook->scenarios, *done.model, assessment);
  }
  evidence.is_stiffness_compared =
      std::ranges::any_of(evidence.distances, [](const SpecimenDistance& d) { return d.name == kModulusName; });
  assessment.eligibility = judge_eligibility(evidence, request.rules);
  if (request.is_calibration_virtual && !settings.is_virtual)
    assessment.eligibility = by_virtual_calibration(std::move(assessment.eligibility));
  return assessment;
}

void describe(Visitor& v, Assessment& a) {
  EligibilityEvidence& evidence = a.evidence;
  v("advice", a.eligibility.advice, "Whether to cut along the corrected path.");
  v("reasons", a.eligibility.reasons, "Reasons for the advice, with their numbers.");
  v("notes", a.notes, "What was not known, and what follows from it.");
  std::optional<CutGain> gain = evidence.gain;
  if (gain && !(std::isfinite(gain->mean_mm) && std::isfinite(gain->sd_mm))) gain.reset();
  if (v.optional({"expected_gain_mm"}, gain.has_value())) {
    v.begin({"expected_gain_mm", "Expected gain of the correction.", "mm"});
    v("mean", gain->mean_mm, "Mean over scenarios and residuals.");
    v("sd", gain->sd_mm, "Standard deviation over scenarios and residuals.");
    describe_interval(v, {"middle_80", "Middle 80 % of the gain over scenarios and residuals.", "mm"},
                      gain->interval_80);
    describe_interval(v, {"middle_95", "Middle 95 % of the gain over scenarios and residuals.", "mm"},
                      gain->interval_95);
    v.end();
  }
  v("p_worse", a.eligibility.p_worse, "Probability that the corrected cut is the worse one.");
  v.derived("p_worse_if_alike", gain ? std::optional(gain->p_worse) : std::nullopt,
            "The same probability, if the specimen is like the calibrated ones.");
  v("p_worse_if_unlike", a.eligibility.p_worse_if_unlike,
    "The same probability, if the specimen is unlike the calibrated ones.");
  v("p_unlike", a.eligibility.p_unlike, "Probability that the specimen is unlike the calibrated ones.");
  const bool is_foreseen = a.outlook.has_value();
  if (v.optional({"p_close_margin"}, is_foreseen)) {
    v.begin({"p_close_margin", "Probability that somewhere less tissue is left than the close margin."});
    for (auto& [name, risk] : {std::pair("intended", &evidence.intended), std::pair("corrected", &evidence.corrected)})
      v.derived(name, risk->unmeasured_weight < 1.0 ? std::optional(risk->p_close_margin) : std::nullopt,
                "Along this path.");
    v.end();
  }
  if (v.optional({"intended"}, is_foreseen)) v("intended", evidence.intended, "Risk of the intended path.");
  if (v.optional({"corrected"}, is_foreseen)) v("corrected", evidence.corrected, "Risk of the corrected path.");
  if (v.optional({"scenarios"}, is_foreseen)) describe_scenarios(v, a.outlook->scenarios);
  v.begin({"registration", "Registration of this specimen."});
  v("converged", evidence.is_registered, "Whether a transform was found that nothing argues against.");
  v({"rmse_mm", "Root mean square distance of the simulated surface from the measured one.", "mm"},
    evidence.registration_rmse_mm);
  v("scale", a.registration_scale, "Scale that was found.");
  v.end();
  v("distances", evidence.distances,
    "Distances of this specimen from the calibrated ones, in everything that is known of both.");
  v("rules", a.rules, "Rules by which the specimen was judged.");
}

}  // namespace incise
