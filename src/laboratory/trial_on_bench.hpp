#pragma once

#include "laboratory/specimen_trial.hpp"
#include "laboratory/virtual_laboratory.hpp"

#include <cstdint>
#include <filesystem>
#include <initializer_list>

namespace incise::laboratory {

/// A specimen of a virtual bench on its way through a folder, by one thread.
class TrialOnBench {
 public:
  /// @param folder  of what its planner is given. @param monitor  asked whether to stop; outlives the trial.
  TrialOnBench(const std::filesystem::path& folder, const TrialSetup& setup, const HiddenSpecimen& hidden,
               const Monitor& monitor)
      : steps_(folder, one_, monitor), bench_(hidden, steps_), specimen_(setup, steps_, bench_) {}

  [[nodiscard]] SpecimenTrial& specimen() { return specimen_; }

 private:
  Workers one_{1};
  ExperimentSteps steps_;
  VirtualLaboratory bench_;
  SpecimenTrial specimen_;
};

/// What a folder is of.
struct FolderClaim {
  const char* schema = "";  ///< of its bench.json
  const char* what = "";    ///< "an acceptance"
};

/// One folder holds the specimens of one first seed. What an earlier run said of the whole would be taken for this
/// one's, and is removed. @throws DataError for a folder of something else, or of another seed.
void claim_folder(const std::filesystem::path& output, const FolderClaim& claim, std::uint64_t seed,
                  std::initializer_list<const char*> summaries);

}  // namespace incise::laboratory
