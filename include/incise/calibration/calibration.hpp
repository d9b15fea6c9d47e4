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

/// A cut that was carried out and photographed, as an evaluation has it.
struct PhotographedCut {
  std::string name;
  Contour incision;                       ///< inner edge, closed, mm
  Contour tumor_edge;                     ///< closed, mm, same frame
  Vec3 approach = -Vec3::UnitZ();         ///< in which the camera looked, in that frame
  std::optional<double> stretch_force_n;  ///< measured pull of the specimen at its stretch, > 0
};

/// How well a specimen's simulated surface could be laid on its measured one.
struct RegistrationQuality {
  double rmse_mm = 0.0;
  double scale = 1.0;  ///< of the measured surface over the simulated one
};
inline void describe(Visitor& v, RegistrationQuality& r) {
  v({"rmse_mm", "Of the distances that are left.", "mm"}, r.rmse_mm, kAnatomyMm);
  v("scale", r.scale, "Of the measured surface over the simulated one.", {1e-3, 1e3});
}

/// What a calibration holds of one specimen.
struct CalibratedSpecimen {
  std::string name;
  PhotographedErrors photographed;
  std::optional<double> signed_mean_mm;             ///< of the photographed inner edge; absent: an older file
  /// How far its path lay outside the planned one, mean; absent: it was cut along that.
  std::optional<double> moved_mean_mm;
  double youngs_modulus_kpa = 70.0;                 ///< reference: the case's, or what the measured force makes of it
  double simulated_force_n = 0.0;                   ///< pull of the simulated specimen at the case's modulus
  double stretch_mm = 0.0;                          ///< how far its end was displaced
  std::optional<double> stretch_force_n;            ///< measured
  std::optional<RegistrationQuality> registration;  ///< where it was given
  std::optional<RingCovariates> ring;               ///< absent: an older file
  PictureMatch picture;
  std::string held;  ///< digest of the held specimen, see calibration_run_key
  std::vector<CalibrationRun> runs;
  std::size_t read_by_midline = 0;  ///< of a fit: runs whose ring closed, but not at the skin
};
void describe(Visitor& v, CalibratedSpecimen& specimen);

/// A specimen that a fit could make nothing of.
struct LeftOutSpecimen {
  std::string name;
  std::string reason;
};
inline void describe(Visitor& v, LeftOutSpecimen& s) {
  v("name", s.name, "Of the specimen.");
  v("reason", s.reason, "Why it was left out.");
}

struct Calibration {
  CalibrationMethod method = CalibrationMethod::Fit;
  std::vector<CalibratedSpecimen> specimens;
  std::vector<LeftOutSpecimen> left_out;  ///< of a fit; not among specimens
  ScoreTable table;                       ///< of the n-th runs of all specimens
  std::optional<DragFit> fit;             ///< method fit
  std::optional<Identifiability> identifiability;
  std::optional<RunSetting> chosen;     ///< absent: every setting failed
  std::optional<double> score_percent;  ///< of the chosen setting: the paper's, of a fit ScoreRow::inner_percent
  double reference_step_s = 0.02;
  std::optional<CutRule>
      cut_rule;                 ///< of all its simulated cuts; absent in files of version 0.1.0, which knew Tets alone
  bool is_virtual = false;      ///< one specimen at least is
  std::size_t simulations = 0;  ///< runs in all, those reused too
  Verdict verdict;              ///< `photo_specimen` for each photograph that may be of another specimen
};

/// `calibration.json`, incise.calibration/1: without the runs, whose figures are in its rows. Where it is read, a fit's
/// weights have to add up to 1, and its fitted specimens to be those of the calibration.
void describe(Visitor& v, Calibration& calibration);

/// Mean over the ring of photographed less fitted signed error, mm. @pre lists of the same length, not empty.
[[nodiscard]] double difference_mm(const SpecimenFit& fitted);

/// Whether something was found to cut with: of a grid a setting that did not fail; of a fit, values at which the rings
/// of more than half of all specimens closed, those that were left out counted as open.
[[nodiscard]] bool is_usable(const Calibration& calibration);

}  // namespace incise
