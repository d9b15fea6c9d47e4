#include "laboratory/experiment_steps.hpp"

#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

namespace incise::laboratory {
namespace {

TEST(ExperimentSteps, CountWhatNoEarlierRunAnswered) {
  const testing::TemporaryFolder folder;
  Workers workers(1);
  Monitor silent;
  const auto step = [](const char* name) {
    return ExperimentStep{name, {name}, {}, {}, [](const steps::StepContext&) { return steps::StepResult{}; }};
  };
  ExperimentSteps first(folder.path() / "S1", workers, silent);
  EXPECT_EQ(first.computed(), 0U);
  static_cast<void>(first.run(step("cut")));
  EXPECT_EQ(first.computed(), 1U);

  ExperimentSteps second(folder.path() / "S1", workers, silent);
  static_cast<void>(second.run(step("cut")));
  EXPECT_EQ(second.computed(), 0U);
  static_cast<void>(second.run(step("evaluate")));
  EXPECT_EQ(second.computed(), 1U);
}

TEST(RefusalOf, NamesOutcomeAndReasonsInWords) {
  StepAnswer answer;
  EXPECT_EQ(refusal_of("register", answer), "register: not acceptable");
  answer.result = {{"outcome", "other_shape"}, {"reasons", {"another shape", "a second \"reason\""}}};
  EXPECT_EQ(refusal_of("register", answer),
            "register: not acceptable: other_shape (another shape; a second \"reason\")");
  answer.result = {{"outcome", "success"},
                   {"verdict", {{"status", "refused"}, {"reasons", {{{"id", "program_check"}}}}}}};
  EXPECT_EQ(refusal_of("export", answer), "export: not acceptable: success (refused: program_check)");
}

}  // namespace
}  // namespace incise::laboratory
