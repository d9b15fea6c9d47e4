#pragma once

#include <incise/laboratory/step.hpp>
#include <incise/virtual_bench/laboratory.hpp>

#include <filesystem>

namespace incise::laboratory {

/// What a laboratory would have of a virtual specimen.
struct MakeSpecimenRequest {
  std::filesystem::path specimen;  ///< file of hidden parameters; empty: drawn from the seed of the context
  bool has_elasticity = false;     ///< also a noisy elasticity map
  std::filesystem::path output;    ///< folder of the readings
  std::filesystem::path truth;     ///< folder of the specimen itself, apart from the output; empty: none
};
/// Not acceptable: a specimen that cannot be held and stretched. @throws DataError, CaseError
[[nodiscard]] StepResult make_specimen(const MakeSpecimenRequest& request, const StepContext& context);

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
[[nodiscard]] StepResult cut_specimen_by(const CutSpecimenRequest& request, const StepContext& context);

/// What is left to a planner that knows the bench's physics, but not the arm's errors.
struct KnownPhysicsRequest {
  std::filesystem::path specimen;  ///< the hidden specimen.json
  double power_w = 35.0;
  int simulations = 3;           ///< of the bench, by which the path is corrected, >= 2
  std::filesystem::path output;  ///< JSON
};
/// Not acceptable: a cut that leaves no closed ring. @throws DataError
[[nodiscard]] StepResult cut_by_known_physics(const KnownPhysicsRequest& request, const StepContext& context);

}  // namespace incise::laboratory
