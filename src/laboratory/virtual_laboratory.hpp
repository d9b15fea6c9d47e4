#pragma once

#include "laboratory/experiment_steps.hpp"

#include <incise/second_bench/specimen.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace incise::laboratory {

/// A specimen of the virtual bench.
struct HiddenSpecimen {
  std::uint64_t seed = 1;
  std::vector<std::pair<std::string, double>> given;  ///< hidden parameters that are not drawn from the seed
  std::filesystem::path truth;  ///< folder of the specimen; what happened in a cut goes to TRUTH_TAG beside it
  int bench = 1;                ///< of which laboratory it is
  std::uint64_t series = 1;     ///< of the second laboratory, as all below
  second_bench::Factors factors = second_bench::all_factors();
};

/// The laboratory of the virtual bench: it alone knows where the truth is.
class VirtualLaboratory : public Laboratory {
 public:
  /// @param steps  of the specimen's folder.
  VirtualLaboratory(HiddenSpecimen hidden, ExperimentSteps& steps) : hidden_(std::move(hidden)), steps_(steps) {}

  StepAnswer take_readings(const std::filesystem::path& folder) override;
  StepAnswer cut(const std::filesystem::path& program, double power_w, const std::filesystem::path& folder,
                 const std::string& tag) override;
  /// What is left to a planner that knows how this very tissue is cut.
  [[nodiscard]] StepAnswer known_physics();

 private:
  [[nodiscard]] std::filesystem::path specimen() const { return hidden_.truth / "specimen.json"; }
  HiddenSpecimen hidden_;
  ExperimentSteps& steps_;
};

}  // namespace incise::laboratory
