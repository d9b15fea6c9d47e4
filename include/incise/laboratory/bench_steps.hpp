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

/// File format of a phantom's CT.
enum class PhantomForm { Dicom, Nrrd, Nifti };
inline constexpr std::array<std::string_view, 3> kPhantomFormNames{"dicom", "nrrd", "nifti"};
[[nodiscard]] constexpr Names names_of(PhantomForm) {
  return kPhantomFormNames;
}

/// Input of make_phantom_case: a phantom with the shape of a porcine tongue and a tumour. Its seed is the context's.
struct PhantomRequest {
  PhantomForm form = PhantomForm::Dicom;
  std::filesystem::path output;  ///< folder
};
/// Writes a phantom as a case: the CT (dicom: ct/, nrrd: ct.nrrd, nifti: ct.nii.gz), tumor.csv (the edge, marked where
/// it should lie on the stretched tissue), tumor.ply, case.yaml, and truth.json for tests; all or nothing.
/// @throws DataError
steps::StepResult make_phantom_case(const PhantomRequest& request, const steps::StepContext& context);

/// Input of make_virtual_cloud. The seed is the context's.
struct VirtualCloudRequest {
  std::filesystem::path case_file;
  std::filesystem::path output;  ///< .ply
};
/// Writes, for practice, a cloud of a case's stretched specimen as a depth camera might measure it, in the robot's
/// frame: the visible surface with points about 1 mm apart, turned and shifted at random from the place that the case
/// states, with noise, a tenth of the points missing, and marked virtual.
/// @throws DataError for a case whose stretch does not come to rest; CaseError
steps::StepResult make_virtual_cloud(const VirtualCloudRequest& request, const steps::StepContext& context);

/// Input of make_specimen: a virtual specimen, and the readings to take of it.
struct MakeSpecimenRequest {
  std::filesystem::path specimen;  ///< file of hidden parameters; empty: drawn from the seed of the context
  std::optional<int> bench;        ///< 1 or 2; absent: the file's, else 1
  std::optional<second_bench::Factors> factors;  ///< factors that vary in the second laboratory; absent: all
  std::optional<std::uint64_t> series;           ///< second laboratory: shares a hand-eye error; absent: the seed
  bool has_elasticity = false;     ///< also a noisy elasticity map
  std::filesystem::path output;    ///< folder of the readings
  std::filesystem::path truth;     ///< folder of the specimen itself, separate from the output; empty: not written
};
/// Writes the readings that a laboratory would take of a virtual specimen. Not acceptable: a specimen that cannot be
/// held and stretched. @throws DataError, CaseError
[[nodiscard]] steps::StepResult make_specimen(const MakeSpecimenRequest& request, const steps::StepContext& context);

/// Input of cut_specimen_by: a virtual specimen, and the robot program that cuts it.
struct CutSpecimenRequest {
  std::filesystem::path specimen;  ///< the hidden specimen.json
  std::filesystem::path program;
  double power_w = 35.0;
  double mm_per_pixel = PhotographSettings{}.mm_per_pixel;
  std::filesystem::path output;  ///< folder of the photograph
  std::filesystem::path truth;   ///< folder of the truth about the cut, separate from the output; empty: not written
};
/// Cuts a virtual specimen by a robot program and writes the photograph. Not acceptable: a specimen or a cut that does
/// not come to rest. @throws DataError for a program that the arm cannot run, or of another specimen.
[[nodiscard]] steps::StepResult cut_specimen_by(const CutSpecimenRequest& request, const steps::StepContext& context);

/// Input of cut_by_known_physics.
struct KnownPhysicsRequest {
  std::filesystem::path specimen;  ///< the hidden specimen.json
  double power_w = 35.0;
  int simulations = 3;           ///< simulations by the bench that correct the path, >= 2
  std::filesystem::path output;  ///< JSON
};
/// Cuts a specimen of the first laboratory by a planner that knows the bench's physics, but not the arm's errors, and
/// writes the error that remains. Not acceptable: a cut that leaves no closed ring. @throws DataError
[[nodiscard]] steps::StepResult cut_by_known_physics(const KnownPhysicsRequest& request,
                                                     const steps::StepContext& context);

inline constexpr const char* kVirtualCuts = "Cuts of incise's virtual bench: no real tissue.";

/// Input of find_power: the virtual specimens and settings of a power series.
struct PowerStepRequest {
  std::vector<std::filesystem::path> files;  ///< specimens; empty: they are drawn
  std::optional<std::uint64_t>
      specimens;                     ///< number to draw, from the context's seed on; absent: 4; not with files
  std::filesystem::path timed_cuts;  ///< cuts that a surgeon timed; empty: none
  std::optional<double> speed_mm_s;  ///< speed of the series; absent: from the timed cuts, else from `series`
  bool only_speed = false;           ///< only compute the speed of the timed cuts; cut nothing
  PowerRequest series;
  std::filesystem::path output;  ///< folder
};
struct PowerResult {
  steps::StepResult step;
  std::vector<PowerSubject> subjects;
  PowerRequest request;  ///< request that was carried out
  PowerSeries series;
  std::optional<SpeedEstimate> speed;  ///< of the timed cuts; absent: there are none
  double wall_s = 0.0;
};
/// Finds the lowest power that cuts virtual specimens without bulging and without thermal damage (paper II-B.3). Writes
/// into the folder: power.csv, bulge.svg and heat.svg against the power, speed.svg against the speed if speeds were
/// requested, cache/ with every cut, manifest.json, and power.json last. With `only_speed` nothing is written.
/// Not acceptable: no power fits. @throws DataError, CaseError; StagesKept in place of Cancelled.
[[nodiscard]] PowerResult find_power(const PowerStepRequest& request, const steps::StepContext& context);

}  // namespace incise::laboratory
