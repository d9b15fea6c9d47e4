#include "laboratory/experiment_steps.hpp"

#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

namespace incise::laboratory {
namespace {

TEST(ExperimentSteps, KnowWhetherAnEarlierRunHadAnsweredAll) {
  const testing::TemporaryFolder folder;
  Workers workers(1);
  Monitor silent;
  const auto step = [](const char* name) {
    return ExperimentStep{name, {name}, {}, {}, [](const steps::StepContext&) { return steps::StepResult{}; }};
  };
  ExperimentSteps first(folder.path() / "S1", workers, silent);
  EXPECT_FALSE(first.has_computed());
  static_cast<void>(first.run(step("cut")));
  EXPECT_TRUE(first.has_computed());

  ExperimentSteps second(folder.path() / "S1", workers, silent);
  static_cast<void>(second.run(step("cut")));
  EXPECT_FALSE(second.has_computed());
  static_cast<void>(second.run(step("evaluate")));
  EXPECT_TRUE(second.has_computed());
}

}  // namespace
}  // namespace incise::laboratory
