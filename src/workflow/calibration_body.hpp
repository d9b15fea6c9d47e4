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

/// One specimen of a calibration: the case's study up to its plan, and the same body with other stiffnesses, made when
/// they are asked for.
class CalibrationBody {
 public:
  /// @throws CaseError naming the case where it cannot be stretched or is no ring.
  CalibrationBody(const CalibrationSubject& subject, Workers& workers, Monitor& monitor);

  /// @param stiffness_of_case  over the case's Young's modulus, > 0.
  /// @throws CaseError where it cannot be stretched, or its path not be planned, at that stiffness.
  const HeldBody& with_stiffness(double stiffness_of_case, Workers& workers, Monitor& monitor);
  /// The tumour edge on the stretched tissue before the cut.
  [[nodiscard]] const Contour& tumor_edge() const { return study_.plan->tumor_edge; }
  /// What the specimen has to be stiffened by to pull as was measured; 1 without a measurement.
  [[nodiscard]] double reference_stiffness() const;
  /// Pull of the simulated specimen at the case's modulus, N: of all constraints that displace.
  [[nodiscard]] double simulated_force_n() const { return simulated_force_n_; }
  /// How far the case displaces what it pulls, mm.
  [[nodiscard]] double stretched_by_mm() const;
  /// How far the case's own path lies outside the planned one, by sector, mm; empty: the cut follows the plan.
  /// @throws CaseError for a path that does not go round the middle of the tumour's edge.
  [[nodiscard]] std::vector<double> moved_mm() const;
  /// Its covariates, the modulus being that of the reference.
  [[nodiscard]] RingCovariates ring() const;
  /// Of all that its cuts depend on beside their setting.
  [[nodiscard]] const std::string& digest() const { return digest_; }

 private:
  [[nodiscard]] HeldBody make(double stiffness_of_case, Workers& workers, Monitor& monitor);
  void require_stretched(const StaticResult& stretched, double stiffness_of_case) const;

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

/// The case with another Young's modulus, and the simulated tool's speed and dullness.
[[nodiscard]] Case with_setting(const Case& settings, const RunSetting& setting);

/// How the errors of a case's inner edge become a profile from its start direction on.
[[nodiscard]] ProfileSettings profile_of_inner_edge(const Case& settings);

/// What is kept of a simulated cut.
[[nodiscard]] CalibrationRun run_of(const Case& settings, const RunSetting& setting, IncisionJobResult result,
                                    const HeldBody& body);

}  // namespace incise
