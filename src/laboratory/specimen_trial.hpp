#pragma once

#include "laboratory/experiment_steps.hpp"

#include <incise/core/monitor.hpp>
#include <incise/steps/case_steps.hpp>
#include <incise/workflow/case.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise::laboratory {

/// A specimen on its way through an experiment. Everything that its planner is given lies in the runner's folder; the
/// specimen itself is behind the laboratory.
struct TrialSetup {
  std::string name;  ///< "S1"
  double power_w = 35.0;
  std::optional<double> given_power_w;  ///< whatever is prescribed
  std::vector<std::string> overrides;   ///< checks of the program that whoever cuts takes on them
  int tets = 25000;  ///< of the planner's mesh
  CutRule rule = CutRule::Tets;  ///< of the planner's cuts
};

/// The simulated tool that a calibration chose, and by how much real inner edges lie farther out than simulated ones.
struct ChosenTool {
  double speed_mm_s = 13.0;
  double dullness = 9.0;
  double bias_mm = 0.0;
};

/// The correction that a calibrated planner makes: of the inner edge, which is what photographs show.
[[nodiscard]] CompensationChoice calibrated_choice(const ChosenTool& tool);

/// What one case file of a specimen says beyond the readings.
struct CaseVariant {
  std::optional<ChosenTool> tool;                  ///< absent: the default one
  double youngs_modulus_kpa = 70.0;                ///< > 0
  std::optional<CompensationChoice> compensation;  ///< absent: nothing is said of it
};

/// A cut whose photograph shows a closed ring.
struct MeasuredCut {
  std::filesystem::path evaluation;  ///< file of `incise evaluate`
  nlohmann::ordered_json measures;   ///< what it printed: of the photograph
};

/// What came of a path.
struct TrialCut {
  bool is_made = false;                 ///< the bench cut along it; else a step before refused, or it was not asked for
  std::optional<MeasuredCut> measured;  ///< absent: not made, or its ring is open, or not found in the photograph
  std::string ended_at;                 ///< the step that refused, and why; empty: none did
};

/// A correction and the cut along it.
struct SecondCut {
  nlohmann::ordered_json compensation;  ///< what `incise compensate` printed
  TrialCut cut;
};

class SpecimenTrial {
 public:
  /// @param steps  of the specimen's folder; both outlive the trial.
  SpecimenTrial(TrialSetup setup, ExperimentSteps& steps, Laboratory& laboratory)
      : setup_(std::move(setup)), steps_(steps), laboratory_(laboratory) {}

  /// From the readings to the planned path: the specimen is made; its CT is meshed, clamped and stretched; that surface
  /// is laid on the camera's cloud, whose scale the platform of known height gives; the marked edge is carried into the
  /// simulation; stiffness follows from the suture's pull; the path is planned. @returns false where a step refused.
  bool prepare(const std::optional<ChosenTool>& tool);
  /// Projects a path (sim_stretched) on the tissue, exports the program after its checks, has the bench cut, and
  /// measures the photograph. @param tag  of the files: planned, corrected …
  [[nodiscard]] TrialCut cut(const std::filesystem::path& path, const std::string& tag);
  /// The correction of a case, and another cut of the same specimen along it. Where its own simulation does not accept
  /// it, it is cut all the same: whether that was right is part of an experiment.
  /// @param is_simulated  the correction is verified in simulation; else no simulated cut takes part.
  [[nodiscard]] SecondCut cut_again(const std::filesystem::path& file, const std::filesystem::path& folder,
                                    const std::string& tag, bool is_simulated = true);
  /// The path of least expected error over all that a calibration leaves possible, and a cut along it.
  [[nodiscard]] TrialCut cut_robustly(const std::filesystem::path& file, const steps::CalibratedRequest& known,
                                      const std::filesystem::path& folder, const std::string& tag);
  /// Copies what an earlier run of this specimen has cached into `folder`, for a run there of the same stages.
  void begin_run(const std::filesystem::path& folder, Stage until) const;
  /// Writes another case of the same specimen into its folder. @returns the file.
  [[nodiscard]] std::filesystem::path write_variant(const std::string& name, const CaseVariant& variant) const;
  /// Runs one more step in this specimen's folder, whose refusal is an answer.
  StepAnswer ask(const ExperimentStep& step) { return steps_.run(step); }
  [[nodiscard]] std::size_t computed() const { return steps_.computed(); }

  [[nodiscard]] std::filesystem::path at(const std::string& name) const { return steps_.folder() / name; }
  [[nodiscard]] std::filesystem::path case_file() const { return at("case.yaml"); }
  [[nodiscard]] std::filesystem::path registration() const { return at("registration/registration.json"); }
  [[nodiscard]] std::filesystem::path planned_path() const { return at("planned/plan/path.json"); }
  /// What the surgeon asks for; null: nothing.
  [[nodiscard]] const nlohmann::ordered_json& prescription() const { return prescription_; }
  [[nodiscard]] double stretch_force_n() const { return stretch_force_n_; }
  [[nodiscard]] double youngs_modulus_kpa() const { return youngs_modulus_kpa_; }
  [[nodiscard]] const std::optional<double>& registration_rmse_mm() const { return registration_rmse_mm_; }
  /// The step of prepare() that refused, and why; empty: none did.
  [[nodiscard]] const std::string& ended_at() const { return ended_at_; }

 private:
  /// @returns nothing where it refused: see ended_at().
  std::optional<nlohmann::ordered_json> run(const ExperimentStep& step);
  bool read();
  bool find_shape();
  bool find_place();
  void write_edge(const nlohmann::ordered_json& registration) const;

  TrialSetup setup_;
  ExperimentSteps& steps_;
  Laboratory& laboratory_;
  std::string ended_at_;
  nlohmann::ordered_json prescription_;  ///< null: the plan's defaults
  double stretch_force_n_ = 0.0;
  double youngs_modulus_kpa_ = 0.0;
  double camera_scale_ = 1.0;
  std::optional<double> registration_rmse_mm_;  ///< absent: no registration was accepted
};

}  // namespace incise::laboratory
