#include <incise/io/atomic_file.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/manifest.hpp>
#include <incise/storage/robust_files.hpp>

#include <cmath>

namespace incise {
namespace {

using Json = nlohmann::ordered_json;

Json distances_json(const std::vector<SpecimenDistance>& distances) {
  Json list = Json::array();
  for (const SpecimenDistance& d : distances)
    list.push_back({{"name", d.name}, {"value", d.value}, {"calibrated_mean", d.mean}, {"in_sd", d.in_sd}});
  return list;
}

Json sensitivity_json(const std::vector<ParameterSensitivity>& sensitivity) {
  Json list = Json::array();
  for (const ParameterSensitivity& s : sensitivity) {
    list.push_back({{"name", s.name}, {"sd", s.sd}, {"change_mm", s.change_mm}, {"mean_change_mm", s.mean_change_mm}});
  }
  return list;
}

Json rules_json(const EligibilityRules& rules) {
  return {{"least_gain_sds", rules.least_gain_sds},       {"most_p_worse", rules.most_p_worse},
          {"most_distance_sds", rules.most_distance_sds}, {"most_rmse_mm", rules.most_rmse_mm},
          {"most_unmeasured", rules.most_unmeasured},     {"most_p_close_margin", rules.most_p_close_margin}};
}

}  // namespace

Json to_json(const Assessment& assessment, const AssessmentRequest& request) {
  const EligibilityEvidence& evidence = assessment.evidence;
  const std::optional<CutGain>& gain = evidence.gain;
  Json json;
  json["advice"] = to_string(assessment.eligibility.advice);
  json["reasons"] = assessment.eligibility.reasons;
  json["notes"] = assessment.notes;
  const bool is_foretold = gain && std::isfinite(gain->mean_mm) && std::isfinite(gain->sd_mm);
  json["expected_gain_mm"] = is_foretold ? Json{{"mean", gain->mean_mm}, {"sd", gain->sd_mm}} : Json(nullptr);
  const std::optional<double>& p_worse = assessment.eligibility.p_worse;
  json["p_worse"] = p_worse ? Json(*p_worse) : Json(nullptr);
  json["p_worse_if_alike"] = is_foretold ? Json(gain->p_worse) : Json(nullptr);
  const std::optional<double>& if_unlike = assessment.eligibility.p_worse_if_unlike;
  json["p_worse_if_unlike"] = if_unlike ? Json(*if_unlike) : Json(nullptr);
  json["p_unlike"] = assessment.eligibility.p_unlike;
  json["p_close_margin"] = nullptr;
  json["intended"] = nullptr;
  json["corrected"] = nullptr;
  json["scenarios"] = nullptr;
  if (assessment.outlook) {
    json["intended"] = to_json(evidence.intended);
    json["corrected"] = to_json(evidence.corrected);
    json["p_close_margin"] = {{"intended", json["intended"]["p_close_margin"]},
                              {"corrected", json["corrected"]["p_close_margin"]}};
    json["scenarios"] = scenarios_json(assessment.outlook->scenarios, assessment.outlook->settings);
  }
  json["registration"] = {{"converged", evidence.is_registered},
                          {"rmse_mm", evidence.registration_rmse_mm},
                          {"scale", request.registration.scale}};
  json["distances"] = distances_json(evidence.distances);
  json["sensitivity"] = sensitivity_json(assessment.sensitivity);
  json["rules"] = rules_json(request.rules);
  return json;
}

void write_assessment(RunFolder& run, const Json& assessment, const std::filesystem::path& calibration,
                      const std::filesystem::path& registration, double wall_s) {
  const std::filesystem::path folder = run.root() / "assessment";
  require_replaceable(folder);
  AtomicFolder target(folder);
  Json json = assessment;
  json["calibration_sha256"] = sha256_of_file(calibration);
  json["registration_sha256"] = sha256_of_file(registration);
  write_json(target.path() / "assess.json", json);
  run.write_manifest_to(target.path(), wall_s);
  target.commit();
}

}  // namespace incise
