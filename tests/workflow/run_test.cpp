// From a case in memory to the checked program: which path is followed, what joins the verdict, when the gate is open.
#include "support/block_inputs.hpp"

#include <incise/workflow/run.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

/// A block of tissue under the arm with a round tumour edge on it, of which an assessment may have advised something.
class AssessedBlock : public testing::BlockInputs {
 public:
  std::string specimen_id() override { return "BLOCK-1"; }
  Verdict advice_against(bool is_corrected) const override {
    EXPECT_EQ(is_corrected, expects_correction);
    Verdict verdict;
    if (!advice.empty()) verdict.add("eligibility", {}, advice);
    return verdict;
  }

  std::string advice;
  bool expects_correction = true;
};

Case case_under_the_arm() {
  Case settings = testing::coarse_case();
  settings.is_virtual = true;
  Mat4 T_robot_sim = Mat4::Identity();
  T_robot_sim.topRightCorner<3, 1>() = Vec3(550.0, 0.0, 200.0);
  settings.T_robot_sim = T_robot_sim;
  return settings;
}

bool says(const ProgramHeader& header, const std::string& key, const std::string& value) {
  for (const auto& [name, text] : header)
    if (name == key && text.find(value) != std::string::npos) return true;
  return false;
}

TEST(Run, ChoosesThePathChecksItAndOpensTheGateForNobodyUnasked) {
  AssessedBlock block;
  Cache cache;
  const incise::Run first = incise::run(case_under_the_arm(), block, cache);
  ASSERT_TRUE(first.program) << first.why_without_program;
  EXPECT_TRUE(first.why_without_program.empty());
  EXPECT_TRUE(first.study.is_accepted);
  const CheckedProgram& made = *first.program;
  EXPECT_EQ(made.path.frame, PathFrame::Robot);
  EXPECT_EQ(made.path.specimen_id, "BLOCK-1");
  EXPECT_TRUE(made.path.is_virtual);
  const Vec3 moved = made.path.waypoints.front().position_mm - Vec3(550.0, 0.0, 200.0);
  EXPECT_LT((moved - first.study.correction->moves.path.waypoints.front().position_mm).norm(), 1e-9);
  EXPECT_TRUE(says(made.header, "verdict", std::string(to_string(first.verdict.status()))));
  EXPECT_TRUE(says(made.header, "specimen", "VIRTUAL"));
  EXPECT_GE(first.verdict.reasons().size(), first.study.verdict.reasons().size());
  EXPECT_NE(first.verdict.status(), VerdictStatus::Ok) << "the mesh is coarse";
  EXPECT_FALSE(first.gate.is_open);
  EXPECT_FALSE(made.replay) << "nobody may play what nobody may write";

  // The same cuts, and an assessment that advises against them.
  block.advice = "assess advises do_not_use";
  const incise::Run advised = incise::run(case_under_the_arm(), block, cache);
  EXPECT_EQ(advised.study.stages.back().state, StageState::Reused);
  EXPECT_TRUE(advised.verdict.has("eligibility"));
  EXPECT_TRUE(says(advised.program->header, "reason", "do_not_use"));

  // Whoever accepts every caution by name opens the gate, unless something is refused.
  std::vector<std::string> all = advised.gate.missing;
  const incise::Run taken = incise::run(case_under_the_arm(), block, cache, all);
  EXPECT_TRUE(taken.gate.missing.empty());
  EXPECT_EQ(taken.gate.is_open, taken.gate.refused.empty());
  EXPECT_EQ(taken.program->replay.has_value(), taken.gate.is_open);
}

TEST(Run, SaysWhyThereIsNoProgramAndRefusesAPlaceThatNoArmWorksAt) {
  AssessedBlock block;
  Cache cache;
  Case settings = case_under_the_arm();
  (*settings.T_robot_sim)(0, 3) = 1e5;
  EXPECT_THROW(static_cast<void>(incise::run(settings, block, cache)), CaseError);
  settings.T_robot_sim.reset();
  const incise::Run without = incise::run(settings, block, cache);
  EXPECT_FALSE(without.program);
  EXPECT_EQ(without.why_without_program, "robot.T_robot_sim is not given");
  EXPECT_FALSE(without.gate.is_open);
  EXPECT_TRUE(without.study.corrected);
}

}  // namespace
}  // namespace incise
