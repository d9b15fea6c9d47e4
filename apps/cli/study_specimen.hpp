#pragma once

#include "study_steps.hpp"

#include <incise/core/monitor.hpp>
#include <incise/workflow/case.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise::cli {

/// A specimen of the virtual laboratory on its way through an experiment. Everything that a planner's command is given
/// lies in `folder`; the specimen itself lies in `truth`, which only `bench make` and `bench cut` are told of.
struct TrialSetup {
  std::string name;                                      ///< "S1"
  std::uint64_t seed = 1;                                ///< of the specimen
  std::vector<std::pair<std::string, double>> given;     ///< hidden parameters that are not drawn from the seed
  std::filesystem::path folder, truth;
  double power_w = 35.0;
  int tets = 25000;                                      ///< of the planner's mesh
};

/// The simulated tool that a calibration chose, and by how much real inner edges lie farther out than simulated ones.
struct ChosenTool {
  double speed_mm_s = 13.0;
  double dullness = 9.0;
  double bias_mm = 0.0;
};

/// A cut whose photograph shows a closed ring.
struct MeasuredCut {
  std::filesystem::path evaluation;   ///< file of `incise evaluate`
  nlohmann::ordered_json measures;    ///< what it printed: of the photograph
};

/// What came of a path.
struct TrialCut {
  bool is_made = false;                  ///< the bench cut along it; else a step before refused, or it was not asked for
  std::optional<MeasuredCut> measured;   ///< absent: not made, or its ring is open, or not found in the photograph
  std::string ended_at;                  ///< the step that refused, and why; empty: none did
};

class SpecimenTrial {
 public:
  SpecimenTrial(TrialSetup setup, int threads, const Monitor& monitor);

  /// From the readings to the planned path: the specimen is made; its CT is meshed, clamped and stretched; that surface
  /// is laid on the camera's cloud, whose scale the platform of known height gives; the marked edge is carried into the
  /// simulation; stiffness follows from the suture's pull; the path is planned. @returns false where a step refused.
  bool prepare(const std::optional<ChosenTool>& tool);
  /// Projects a path (sim_stretched) on the tissue, exports the program after its checks, has the bench cut, and
  /// measures the photograph. @param tag  of the files: planned, corrected …
  [[nodiscard]] TrialCut cut(const std::filesystem::path& path, const std::string& tag);
  /// Writes another case of the same specimen into its folder. @returns the file.
  [[nodiscard]] std::filesystem::path write_variant(const std::string& name, const std::optional<ChosenTool>& tool, double youngs_modulus_kpa,
                                                    CompensationMethod method) const;
  /// Runs one more command in this specimen's folder, whose refusal is an answer.
  StepRecord ask(const ExperimentStep& step) { return runner_.run(step); }

  [[nodiscard]] const TrialSetup& setup() const { return setup_; }
  [[nodiscard]] std::filesystem::path at(const std::string& name) const { return setup_.folder / name; }
  [[nodiscard]] std::filesystem::path case_file() const { return at("case.yaml"); }
  [[nodiscard]] std::filesystem::path registration() const { return at("registration/registration.json"); }
  [[nodiscard]] std::filesystem::path planned_path() const { return at("planned/plan/path.json"); }
  [[nodiscard]] double stretch_force_n() const { return stretch_force_n_; }
  [[nodiscard]] double youngs_modulus_kpa() const { return youngs_modulus_kpa_; }
  [[nodiscard]] const std::optional<double>& registration_rmse_mm() const { return registration_rmse_mm_; }
  /// The step of prepare() that refused, and why; empty: none did.
  [[nodiscard]] const std::string& ended_at() const { return ended_at_; }
  [[nodiscard]] const std::vector<std::string>& commands() const { return runner_.lines(); }

 private:
  /// @returns nothing where it refused: see ended_at().
  std::optional<StepRecord> run(const ExperimentStep& step);
  bool make();
  bool find_shape();
  bool find_place();
  void write_edge(const nlohmann::ordered_json& registration) const;

  TrialSetup setup_;
  StepRunner runner_;
  std::string ended_at_;
  double stretch_force_n_ = 0.0;
  double youngs_modulus_kpa_ = 0.0;
  double camera_scale_ = 1.0;
  std::optional<double> registration_rmse_mm_;  ///< absent: no registration was accepted
};

}  // namespace incise::cli
