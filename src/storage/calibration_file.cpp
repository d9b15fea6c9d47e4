#include <incise/io/json_file.hpp>
#include <incise/storage/calibration_file.hpp>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr const char* kCalibrationHint = "Write the file with `incise calibrate`";

/// Nothing where a specimen's pull or fit is not known.
std::optional<StiffnessTrend> trend_of(const Calibration& calibration) {
  std::vector<StiffnessReading> readings;
  if (calibration.fit->specimens.empty()) return std::nullopt;
  for (std::size_t i = 0; i < calibration.specimens.size(); ++i) {
    if (!calibration.specimens[i].stretch_force_n) return std::nullopt;
    readings.push_back({calibration.specimens[i].youngs_modulus_kpa, difference_mm(calibration.fit->specimens[i])});
  }
  if (readings.empty()) return std::nullopt;
  const ResidualEstimate& residual = calibration.fit->residual;
  const double ring_mm = residual.sd_mm / std::sqrt(std::max(1.0, residual.n_effective));
  return stiffness_trend(readings, std::hypot(residual.specimen_spread_mm, ring_mm));
}

}  // namespace

Calibration read_calibration(const std::filesystem::path& path) {
  return from_json<Calibration>(read_json(path), path, {}, kCalibrationHint);
}

CalibratedBelief belief_of(const Calibration& calibration, const std::filesystem::path& path) {
  if (calibration.method != CalibrationMethod::Fit)
    throw DataError(path, "method", "paper", "fit: a grid of scores does not state its uncertainty", kCalibrationHint);
  if (!calibration.chosen) throw DataError(path, "chosen", "null", "a setting with which a simulated ring closed");
  CalibratedBelief belief;
  belief.samples = calibration.fit->samples;
  belief.residual = calibration.fit->residual;
  belief.speed_mm_s = calibration.chosen->speed_mm_s;
  belief.knows_forces = !calibration.specimens.empty() &&
                        std::all_of(calibration.specimens.begin(), calibration.specimens.end(),
                                    [](const CalibratedSpecimen& s) { return s.stretch_force_n.has_value(); });
  belief.trend = trend_of(calibration);
  return belief;
}

CalibratedRange range_of(const Calibration& calibration) {
  CalibratedRange range;
  for (const CalibratedSpecimen& specimen : calibration.specimens) {
    if (specimen.stretch_force_n) range.youngs_modulus_kpa.push_back(specimen.youngs_modulus_kpa);
    if (specimen.stretch_force_n && specimen.stretch_mm > 0.0)
      range.compliance_mm_n.push_back(specimen.stretch_mm / *specimen.stretch_force_n);
    if (specimen.signed_mean_mm) range.signed_error_mm.push_back(*specimen.signed_mean_mm);
    if (!specimen.registration) continue;
    range.registration_rmse_mm.push_back(specimen.registration->rmse_mm);
    range.registration_scale.push_back(specimen.registration->scale);
  }
  return range;
}

}  // namespace incise
