#pragma once

#include <incise/bench_studies/power_series.hpp>
#include <incise/calibration/incision_speed.hpp>
#include <incise/core/names.hpp>
#include <incise/second_bench/specimen.hpp>
#include <incise/steps/step.hpp>
#include <incise/virtual_bench/readings.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace incise::laboratory {

/// What the CT of a phantom is written as.
enum class PhantomForm { Dicom, Nrrd, Nifti };
inline constexpr std::array<std::string_view, 3> kPhantomFormNames{"dicom", "nrrd", "nifti"};
[[nodiscard]] constexpr Names names_of(PhantomForm) {
  return kPhantomFormNames;
}

/// A phantom as a case of its own: the CT of a body like a porcine tongue, with a tumour. Its seed is the context's.
struct PhantomRequest {
  PhantomForm form = PhantomForm::Dicom;
  std::filesystem::path output;  ///< folder
};
/// Writes the CT (dicom: ct/, nrrd: ct.nrrd, nifti: ct.nii.gz), tumor.csv (the edge, marked where it is to lie on the
/// stretched tissue), tumor.ply, case.yaml, and truth.json for tests; all or nothing. @throws DataError
steps::StepResult make_phantom_case(const PhantomRequest& request, const steps::StepContext& context);

/// A cloud as a depth camera might give it of a case's stretched specimen, in the robot's frame, for practice: the
/// visible surface about 1 mm apart, turned and shifted at random from where the case says that it lies, with noise, a
/// tenth of its points missing, and marked virtual. The seed is the context's.
struct VirtualCloudRequest {
  std::filesystem::path case_file;
  std::filesystem::path output;  ///< .ply
};
/// @throws DataError for a case whose stretch does not come to rest; CaseError
steps::StepResult make_virtual_cloud(const VirtualCloudRequest& request, const steps::StepContext& context);

/// What a laboratory would have of a virtual specimen.
struct MakeSpecimenRequest {
  std::filesystem::path specimen;  ///< file of hidden parameters; empty: drawn from the seed of the context
  std::optional<int> bench;        ///< 1 or 2; absent: that of the file, else 1
  std::optional<second_bench::Factors> factors;  ///< what varies in the second laboratory; absent: everything
  std::optional<std::uint64_t> series;           ///< of the second laboratory: whose hand-eye error; absent: the seed
  bool has_elasticity = false;     ///< also a noisy elasticity map
  std::filesystem::path output;    ///< folder of the readings
  std::filesystem::path truth;     ///< folder of the specimen itself, apart from the output; empty: none
};
/// Not acceptable: a specimen that cannot be held and stretched. @throws DataError, CaseError
[[nodiscard]] steps::StepResult make_specimen(const MakeSpecimenRequest& request, const steps::StepContext& context);

/// The photograph of a virtual specimen that a robot program has cut.
struct CutSpecimenRequest {
  std::filesystem::path specimen;  ///< the hidden specimen.json
  std::filesystem::path program;
  double power_w = 35.0;
  double mm_per_pixel = PhotographSettings{}.mm_per_pixel;
  std::filesystem::path output;  ///< folder of the photograph
  std::filesystem::path truth;   ///< folder of what really happened, apart from the output; empty: none
};
/// Not acceptable: a specimen or a cut that does not come to rest. @throws DataError for a program that the arm cannot
/// run, or of another specimen.
[[nodiscard]] steps::StepResult cut_specimen_by(const CutSpecimenRequest& request, const steps::StepContext& context);

/// What is left to a planner that knows the bench's physics, but not the arm's errors.
struct KnownPhysicsRequest {
  std::filesystem::path specimen;  ///< the hidden specimen.json
  double power_w = 35.0;
  int simulations = 3;           ///< of the bench, by which the path is corrected, >= 2
  std::filesystem::path output;  ///< JSON
};
/// Not acceptable: a cut that leaves no closed ring. @throws DataError
[[nodiscard]] steps::StepResult cut_by_known_physics(const KnownPhysicsRequest& request,
                                                     const steps::StepContext& context);

inline constexpr const char* kVirtualCuts = "Cuts of incise's virtual bench: no real tissue.";

/// The lowest power that cuts virtual specimens without bulging and without thermal damage (paper II-B.3).
struct PowerStepRequest {
  std::vector<std::filesystem::path> files;  ///< specimens; empty: they are drawn
  std::optional<std::uint64_t>
      specimens;                     ///< how many are drawn, from the context's seed on; absent: 4; not with files
  std::filesystem::path timed_cuts;  ///< a surgeon's; empty: none
  std::optional<double> speed_mm_s;  ///< of the series; absent: that of the timed cuts, else that of `series`
  bool only_speed = false;           ///< nothing is cut: the speed of the timed cuts is all
  PowerRequest series;
  std::filesystem::path output;  ///< folder
};
struct PowerResult {
  steps::StepResult step;
  std::vector<PowerSubject> subjects;
  PowerRequest request;  ///< that was carried out
  PowerSeries series;
  std::optional<SpeedEstimate> speed;  ///< of the timed cuts, where there are some
  double wall_s = 0.0;
};
/// Fills the folder: power.csv, bulge.svg and heat.svg against the power, speed.svg against the speed where speeds were
/// asked for, cache/ with every cut, manifest.json, and power.json last.
/// Not acceptable: no power fits. @throws DataError, CaseError; StagesKept in place of Cancelled.
[[nodiscard]] PowerResult find_power(const PowerStepRequest& request, const steps::StepContext& context);

}  // namespace incise::laboratory
