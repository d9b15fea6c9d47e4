#pragma once

#include <incise/calibration/calibration_run.hpp>
#include <incise/calibration/drag_fit.hpp>
#include <incise/calibration/identifiability.hpp>
#include <incise/calibration/picture_match.hpp>
#include <incise/calibration/ring_covariates.hpp>
#include <incise/calibration/score_table.hpp>
#include <incise/core/names.hpp>
#include <incise/core/verdict.hpp>
#include <incise/cutting/cut_settings.hpp>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

enum class CalibrationMethod {
  Paper,  ///< a grid of speeds and dullness values, scored (paper II-C.4, III-A.2)
  Fit,    ///< the signed error round the ring, few simulations, a posterior
};
inline constexpr std::array<std::string_view, 2> kCalibrationMethodNames{"paper", "fit"};
[[nodiscard]] constexpr Names names_of(CalibrationMethod) {
  return kCalibrationMethodNames;
}

/// A photographed cut, as its evaluation measured it.
struct PhotographedCut {
  std::string name;
  Contour incision;                       ///< inner edge, closed, mm
  Contour tumor_edge;                     ///< closed, mm, same frame
  Vec3 approach = -Vec3::UnitZ();         ///< direction in which the camera looked, same frame
  std::optional<double> stretch_force_n;  ///< measured pull of the specimen at its stretch, > 0
};

/// How well the simulated surface of a specimen fits its measured surface after registration.
struct RegistrationQuality {
  double rmse_mm = 0.0;  ///< root mean square of the remaining distances
  double scale = 1.0;    ///< measured size over simulated size
};
inline void describe(Visitor& v, RegistrationQuality& r) {
  v({"rmse_mm", "Root mean square of the distances that remain.", "mm"}, r.rmse_mm, kAnatomyMm);
  v("scale", r.scale, "Size of the measured surface over that of the simulated one.", {1e-3, 1e3});
}

/// One specimen of a calibration.
struct CalibratedSpecimen {
  std::string name;
  PhotographedErrors photographed;
  std::optional<double> signed_mean_mm;  ///< mean signed error of the photographed inner edge; absent in older files
  /// Mean distance by which the path that was cut lies outside the planned path; absent: the planned path was cut.
  std::optional<double> moved_mean_mm;
  double youngs_modulus_kpa = 70.0;       ///< reference: the case's modulus, or the one that the measured force implies
  double simulated_force_n = 0.0;         ///< pull of the simulated specimen at the case's modulus
  double stretch_mm = 0.0;                ///< how far its end was displaced
  std::optional<double> stretch_force_n;  ///< measured
  std::optional<RegistrationQuality> registration;  ///< absent: not given
  std::optional<RingCovariates> ring;               ///< absent in older files
  PictureMatch picture;
  std::string held;  ///< digest of the held specimen, see calibration_run_key
  std::vector<CalibrationRun> runs;
  std::size_t read_by_midline = 0;  ///< of a fit: runs whose ring closed, but not at the skin
};
void describe(Visitor& v, CalibratedSpecimen& specimen);

/// A specimen that a fit could not use.
struct LeftOutSpecimen {
  std::string name;
  std::string reason;
};
inline void describe(Visitor& v, LeftOutSpecimen& s) {
  v("name", s.name, "Name of the specimen.");
  v("reason", s.reason, "Why it was left out.");
}

/// Result of a calibration.
struct Calibration {
  CalibrationMethod method = CalibrationMethod::Fit;
  std::vector<CalibratedSpecimen> specimens;
  std::vector<LeftOutSpecimen> left_out;  ///< of a fit; not in `specimens`
  ScoreTable table;                       ///< row n scores the n-th runs of all specimens
  std::optional<DragFit> fit;             ///< method fit
  std::optional<Identifiability> identifiability;
  std::optional<RunSetting> chosen;     ///< absent: every setting failed
  std::optional<double> score_percent;  ///< of the chosen setting: ScoreRow::percent; of a fit ScoreRow::inner_percent
  double reference_step_s = 0.02;
  std::optional<CutRule>
      cut_rule;                 ///< of all simulated cuts; absent in files of version 0.1.0, which knew only Tets
  bool is_virtual = false;      ///< at least one specimen is virtual
  std::size_t simulations = 0;  ///< all runs, including reused ones
  Verdict verdict;              ///< `photo_specimen` for each photograph that may be of another specimen
};

/// Describes `calibration.json`, incise.calibration/1. The file omits the runs; its rows hold their figures. When it is
/// read, the weights of a fit's samples must add up to 1, and its fitted specimens must be those of the calibration.
void describe(Visitor& v, Calibration& calibration);

/// Returns the mean over the ring of the photographed minus the fitted signed error, mm. @pre lists of the same length,
/// not empty.
[[nodiscard]] double difference_mm(const SpecimenFit& fitted);

/// Returns whether the calibration found settings to cut with. Of a grid: a setting that did not fail. Of a fit: values
/// at which the rings of more than half of all specimens closed; specimens that were left out count as open.
[[nodiscard]] bool is_usable(const Calibration& calibration);

}  // namespace incise
