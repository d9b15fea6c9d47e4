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
  std::filesystem::path truth;  ///< folder of the specimen; the truth of a cut goes to TRUTH_TAG beside it
  int bench = 1;                ///< its laboratory
  std::uint64_t series = 1;     ///< only of the second laboratory, as is `factors`
  second_bench::Factors factors = second_bench::all_factors();
};

/// The names of factors, in their order.
[[nodiscard]] std::vector<std::string> names_of_factors(const second_bench::Factors& factors);

/// The laboratory of the virtual bench: it alone knows where the truth is.
class VirtualLaboratory : public Laboratory {
 public:
  /// @param steps  of the specimen's folder.
  VirtualLaboratory(HiddenSpecimen hidden, ExperimentSteps& steps) : hidden_(std::move(hidden)), steps_(steps) {}

  StepAnswer take_readings(const std::filesystem::path& folder) override;
  StepAnswer cut(const std::filesystem::path& program, double power_w, const std::filesystem::path& folder,
                 const std::string& tag) override;
  /// Returns the error that remains if the planner knows how this tissue is cut.
  [[nodiscard]] StepAnswer known_physics();

 private:
  [[nodiscard]] std::filesystem::path specimen() const { return hidden_.truth / "specimen.json"; }
  HiddenSpecimen hidden_;
  ExperimentSteps& steps_;
};

}  // namespace incise::laboratory
