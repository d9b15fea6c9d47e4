#pragma once

#include "laboratory/specimen_trial.hpp"
#include "laboratory/virtual_laboratory.hpp"

#include <cstdint>
#include <filesystem>
#include <initializer_list>

namespace incise::laboratory {

/// A specimen of a virtual bench that one thread takes through its steps, in its own folder.
class TrialOnBench {
 public:
  /// @param folder  of what the planner receives. @param monitor  asked whether to stop; must outlive the trial.
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

/// Claims a folder for the specimens of one first seed. Removes `summaries`, the overall results of an earlier run, so
/// that nobody takes them for results of this run.
/// @param schema  of its bench.json.  @param what  its purpose: "an acceptance".
/// @throws DataError for a folder of another purpose or another seed.
void claim_folder(const std::filesystem::path& output, const char* schema, const char* what, std::uint64_t seed,
                  std::initializer_list<const char*> summaries);

}  // namespace incise::laboratory
