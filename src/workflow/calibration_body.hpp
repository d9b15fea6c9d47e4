#pragma once

#include <incise/core/error.hpp>
#include <incise/cutting/incision_batch.hpp>
#include <incise/evaluation/error_profile.hpp>
#include <incise/workflow/calibrate.hpp>
#include <incise/workflow/study.hpp>

#include <map>
#include <memory>

namespace incise {

/// A stretched specimen with the path that its cut follows.
struct HeldBody {
  TissueModel model;
  StaticResult stretched;
  ToolPath plan;
  ToolPath followed;  ///< the case's own path, or the plan
};

/// One specimen of a calibration: the case's study up to its plan, and the same body with other stiffnesses, made on
/// request.
class CalibrationBody {
 public:
  /// @throws CaseError naming the case if it cannot be stretched or is not a ring.
  CalibrationBody(const CalibrationSubject& subject, Workers& workers, Monitor& monitor);

  /// Returns the body with another stiffness.
  /// @param stiffness_of_case  Young's modulus over the case's, > 0.
  /// @throws CaseError if it cannot be stretched, or its path cannot be planned, at that stiffness.
  const HeldBody& with_stiffness(double stiffness_of_case, Workers& workers, Monitor& monitor);
  /// The tumour edge on the stretched tissue before the cut.
  [[nodiscard]] const Contour& tumor_edge() const { return study_.plan->tumor_edge; }
  /// Factor on the case's modulus with which the specimen pulls as measured; 1 without a measurement.
  [[nodiscard]] double reference_stiffness() const;
  /// Pull of the simulated specimen at the case's modulus, N: sum over all displaced constraints.
  [[nodiscard]] double simulated_force_n() const { return simulated_force_n_; }
  /// How far the case displaces the tissue, mm (see stretch_mm).
  [[nodiscard]] double stretched_by_mm() const;
  /// Returns how far the case's own path lies outside the planned one, by sector, mm; empty: the cut follows the plan.
  /// @throws CaseError for a path that does not go round the middle of the tumour's edge.
  [[nodiscard]] std::vector<double> moved_mm() const;
  /// Covariates of its ring, with the reference modulus.
  [[nodiscard]] RingCovariates ring() const;
  /// Digest of everything that determines its cuts except their setting.
  [[nodiscard]] const std::string& digest() const { return digest_; }

 private:
  [[nodiscard]] HeldBody make(double stiffness_of_case, Workers& workers, Monitor& monitor);

  const CalibrationSubject& subject_;
  [[nodiscard]] std::string digest_of_all() const;

  Study study_;
  std::string digest_;
  std::optional<Contour> drawn_edge_;
  std::optional<ToolPath> given_path_;
  double simulated_force_n_ = 0.0;
  std::map<double, std::unique_ptr<HeldBody>> bodies_;
  std::map<double, CaseError> refusals_;  ///< stiffnesses at which it cannot be held
};

/// Returns the case with another Young's modulus and the simulated tool's speed and dullness.
[[nodiscard]] Case with_setting(const Case& settings, const RunSetting& setting);

/// Returns the settings of a profile of the inner edge, from the case's start direction on.
[[nodiscard]] ProfileSettings profile_of_inner_edge(const Case& settings);

/// Returns the stored result of a simulated cut.
[[nodiscard]] CalibrationRun run_of(const Case& settings, const RunSetting& setting, IncisionJobResult result,
                                    const HeldBody& body);

}  // namespace incise
