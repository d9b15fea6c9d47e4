#pragma once

#include <incise/calibration/calibration.hpp>
#include <incise/io/table_io.hpp>
#include <incise/workflow/assess.hpp>
#include <incise/workflow/calibrate.hpp>
#include <incise/workflow/robust_correction.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace incise {

/// `calibration.json` (incise.calibration/1): method, chosen, score_percent, rows, baseline_mm, specimens, and of a fit
/// its posterior, residual and what the data tell apart.
[[nodiscard]] nlohmann::ordered_json to_json(const Calibration& calibration);

/// Table I: speed, dullness, drag length, stiffness, each specimen's absolute error, the pooled columns, per cent.
/// Header with units; a failure is an empty field and `failure` in the column outcome.
[[nodiscard]] TextTable calibration_table(const Calibration& calibration);
/// The same rounded as the paper prints it, for LaTeX.
[[nodiscard]] TextTable calibration_table_rounded(const Calibration& calibration);

/// What a calibration's file says of one of its specimens.
struct CalibratedSpecimenRecord {
  std::string name;
  double youngs_modulus_kpa = 0.0;
  double simulated_force_n = 0.0;                   ///< at the case's modulus; 0: the case does not pull
  double stretch_mm = 0.0;                          ///< by which it was displaced; 0: not said
  std::optional<double> stretch_force_n;            ///< measured
  std::optional<RegistrationQuality> registration;  ///< absent where it was not given to the calibration
  std::optional<double> signed_error_mm;            ///< mean along the ring, as photographed
  std::optional<double> difference_mm;  ///< of a fit: mean along the ring of photographed less fitted signed error
};

/// What a calibration found, for those who plan by it.
struct CalibrationRecord {
  CalibrationMethod method = CalibrationMethod::Fit;
  bool is_virtual = false;
  std::optional<RunSetting> chosen;  ///< absent: every setting failed
  double reference_step_s = 0.02;
  double baseline_mm = 0.0;
  std::vector<CalibratedSpecimenRecord> specimens;
  std::vector<PosteriorSample> samples;  ///< of a fit; weights add up to 1
  ResidualEstimate residual;             ///< of a fit
};
/// @throws DataError naming the file and the key that is missing, of another kind, or out of range.
[[nodiscard]] CalibrationRecord read_calibration(const std::filesystem::path& path);

/// What it says of the next specimen. @param path  of the file, for the message.
/// @throws DataError for a calibration without a posterior (--method paper) or without a setting that worked.
[[nodiscard]] CalibratedBelief belief_of(const CalibrationRecord& record, const std::filesystem::path& path);

/// What it says of its specimens, to hold a further one against. A modulus counts only where the pull was measured.
[[nodiscard]] CalibratedRange range_of(const CalibrationRecord& record);

}  // namespace incise
