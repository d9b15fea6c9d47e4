#pragma once

#include <incise/calibration/calibration.hpp>
#include <incise/core/cache.hpp>
#include <incise/core/describe.hpp>
#include <incise/core/monitor.hpp>
#include <incise/core/problem.hpp>
#include <incise/core/workers.hpp>
#include <incise/workflow/case.hpp>
#include <incise/workflow/inputs.hpp>
#include <incise/workflow/product_sink.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise {

/// A specimen that was cut and photographed, and the case that states how it was held and along which path it was cut.
struct CalibrationSubject {
  PhotographedCut photographed;
  std::string photograph_file;                      ///< file named in messages about the photograph
  std::string case_file;                            ///< file named in messages about the case
  Case settings;                                    ///< plan.kind: ring
  std::optional<RegistrationQuality> registration;  ///< kept, so that later specimens can be compared with this one
  Inputs* inputs = nullptr;                         ///< of the case; not null
  Cache* cache = nullptr;                           ///< for products of the case; not null
  ProductSink* sink = nullptr;                      ///< receives products of the case; may be null
};

/// Returns the cache key of a simulated cut of a specimen.
/// @param held  digest of the held and planned specimen: everything that determines its cuts except their setting.
[[nodiscard]] CacheKey calibration_run_key(const std::string& held, const RunSetting& setting);

/// Simulations of a calibration. Defaults: the paper's grid; for the fit, seven cuts of each specimen, then one or two
/// near the fitted drag length, and one that checks the fit.
struct CalibrationRequest {
  CalibrationMethod method = CalibrationMethod::Fit;
  std::vector<double> speeds_mm_s{1.0, 5.0, 9.0, 13.0, 17.0};
  std::vector<double> dullnesses{1.0, 5.0, 9.0, 13.0, 17.0};
  double fit_speed_mm_s = 13.0;
  std::vector<double> drag_lengths_mm{0.26, 1.04, 1.82, 2.6, 3.38};
  std::vector<double> second_drag_lengths_mm{1.04, 2.6};
  double second_stiffness = 2.0;
  double force_sd = 0.05;
  double stiffness_sd_with_force = 0.1;
  DragFitSettings fit;
};
inline void describe(Visitor& v, CalibrationRequest& r) {
  v("method", r.method, "A fit of drag and stiffness, or the paper's grid of speed and dullness.");
  v({"speeds_mm_s", "Speeds of the paper's grid.", "mm/s"}, r.speeds_mm_s, kPositive);
  v("dullnesses", r.dullnesses, "Dullnesses of the paper's grid.", kPositive);
  v({"fit_speed_mm_s", "Simulated speed of all cuts of a fit.", "mm/s"}, r.fit_speed_mm_s, kPositive);
  v({"drag_lengths_mm", "Drag lengths (speed x dwell) of the fit's simulations at the reference stiffness; at least 2.",
     "mm"},
    r.drag_lengths_mm, kPositive);
  v({"second_drag_lengths_mm", "Those of drag_lengths_mm that are also simulated with the second stiffness.", "mm"},
    r.second_drag_lengths_mm, kPositive);
  v("second_stiffness", r.second_stiffness, "Second stiffness, divided by the reference; not 1.", kPositive);
  v("force_sd", r.force_sd, "Relative standard deviation of a measured force.", kPositive);
  v("stiffness_sd_with_force", r.stiffness_sd_with_force,
    "Standard deviation of ln(stiffness factor) if every specimen's force was measured.", kPositive);
  describe(v, r.fit);
}
/// Returns every violation; empty if the request is valid.
[[nodiscard]] std::vector<Problem> validate(const CalibrationRequest& request);

/// Finds the settings with which simulated cuts match the photographed ones. Simulations run side by side, one thread
/// each; those in the cache are not repeated. A simulation that fails is a row of the result.
/// @param subjects  at least one; all with the same cut.rule.
/// @throws CaseError, naming the file, for a case that cannot be held, stretched or planned, or has another cut.rule;
/// DataError for a photograph that is mirrored, turned far, of another case, or without a ring round the tumour;
/// InvalidArgument for an invalid request; Cancelled when the monitor asks to stop: finished runs are in the cache.
[[nodiscard]] Calibration calibrate(const std::vector<CalibrationSubject>& subjects, const CalibrationRequest& request,
                                    Cache& runs, Workers& workers, Monitor& monitor);

}  // namespace incise
