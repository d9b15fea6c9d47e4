#include <incise/calibration/ring_forecast.hpp>
#include <incise/core/error.hpp>
#include <incise/io/json_file.hpp>
#include <incise/storage/calibration_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr const char* kCalibrationHint = "Write the file with `incise calibrate`";

constexpr std::size_t kLeastSectors = 9, kMostSectors = 360;
constexpr double kMostErrorMm = 10.0;  // largest error that a case's lists accept

/// Returns the rings of a calibration; refuses profiles that cannot be used together.
std::vector<RingObservation> rings_of(const Calibration& calibration, const std::filesystem::path& file) {
  std::vector<RingObservation> rings = ring_observations(calibration);
  if (rings.empty())
    throw DataError(file, "specimens", "no specimen with its ring and fitted errors",
                    "a calibration by method fit, made by this version",
                    "Calibrate again: finished simulations are kept");
  const std::size_t sectors = rings.front().photographed_mm.size();
  for (const RingObservation& one : rings) {
    const std::size_t count = one.photographed_mm.size();
    if (count < kLeastSectors || count > kMostSectors || count != sectors)
      throw DataError(file, "fitted", fmt::format("a profile of {} numbers", count),
                      sectors < kLeastSectors || sectors > kMostSectors
                          ? fmt::format("{} to {}", kLeastSectors, kMostSectors)
                          : fmt::format("{}, as in the first profile", sectors));
    for (const auto* list : {&one.photographed_mm, &one.simulated_mm})
      for (const double error : *list)
        if (!(std::abs(error) <= kMostErrorMm))
          throw DataError(file, "fitted", fmt::format("an error of {} mm", error),
                          fmt::format("at most {} mm either way", kMostErrorMm));
  }
  return rings;
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
  belief.file = path;
  belief.samples = calibration.fit->samples;
  belief.rings = rings_of(calibration, path);
  belief.specimens = calibration.fit->specimens.size();
  belief.speed_mm_s = calibration.chosen->speed_mm_s;
  belief.knows_forces = !calibration.specimens.empty() &&
                        std::all_of(calibration.specimens.begin(), calibration.specimens.end(),
                                    [](const CalibratedSpecimen& s) { return s.stretch_force_n.has_value(); });
  return belief;
}

CalibratedRange range_of(const Calibration& calibration) {
  CalibratedRange range;
  for (const CalibratedSpecimen& specimen : calibration.specimens) {
    if (specimen.stretch_force_n) range.youngs_modulus_kpa.push_back(specimen.youngs_modulus_kpa);
    if (specimen.stretch_force_n && specimen.stretch_mm > 0.0)
      range.compliance_mm_n.push_back(specimen.stretch_mm / *specimen.stretch_force_n);
    if (specimen.signed_mean_mm)
      range.signed_error_mm.push_back(*specimen.signed_mean_mm - specimen.moved_mean_mm.value_or(0.0));
    if (!specimen.registration) continue;
    range.registration_rmse_mm.push_back(specimen.registration->rmse_mm);
    range.registration_scale.push_back(specimen.registration->scale);
  }
  return range;
}

}  // namespace incise
