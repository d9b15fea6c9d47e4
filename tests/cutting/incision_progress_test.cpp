#include "cutting/ring_in_a_block.hpp"
#include "cutting/same_incision.hpp"
#include "support/monitors.hpp"

#include <incise/core/described_bytes.hpp>
#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <optional>

namespace incise {
namespace {

/// The ring of some ninety steps, with drag and frames.
class InterruptedIncision : public testing::RingInABlock {
 protected:
  InterruptedIncision() : RingInABlock(16) {
    settings_.cut.dullness = 4.0;
    settings_.frames = 7;
  }

  [[nodiscard]] IncisionProgress begin() const { return begin_incision(model_, rest_state(model_), path_, settings_); }

  IncisionResult go_on(IncisionProgress progress, int threads, Monitor& monitor,
                       const ProgressKeeper& keep = {}) const {
    Workers workers(threads);
    return continue_incision(model_, rest_state(model_), path_, settings_, std::move(progress), workers, monitor, keep);
  }

  /// What is left of the cut when it is stopped after so many steps.
  [[nodiscard]] std::optional<IncisionProgress> interrupted_after(int steps, IncisionProgress from, int threads) const {
    std::optional<IncisionProgress> last;
    testing::StopAfter monitor(steps);
    const IncisionResult result =
        go_on(std::move(from), threads, monitor, [&](const IncisionProgress& progress, bool is_interrupted) {
          if (is_interrupted) last = progress;
        });
    EXPECT_EQ(result.outcome, last ? Outcome::Cancelled : Outcome::Success);
    return last;
  }

  IncisionResult straight() const {
    Monitor silent;
    return go_on(begin(), 1, silent);
  }

  /// Lengthens the overlap until the tool is out one step before a renewal step.
  void end_before_a_renewal_step() {
    const double steps = ToolProgram(path_, settings_.cut, settings_.tool).duration_s() / settings_.cut.step_s();
    const int wanting = 19 - static_cast<int>(std::ceil(steps)) % 20;
    settings_.cut.overlap_mm += wanting * settings_.cut.advance_per_step_mm;
  }

  ToolPath path_ = ring(4.0);
  Monitor silent_;
};

TEST_F(InterruptedIncision, GoesOnWithTheBitsOfAnUninterruptedOneAtAnyThreadCount) {
  const IncisionResult expected = straight();
  ASSERT_EQ(expected.outcome, Outcome::Success);
  ASSERT_GT(expected.record.removals.size(), 300U);
  for (const auto& [steps, threads] : {std::pair{1, 2}, std::pair{33, 4}, std::pair{79, 1}}) {
    const auto left = interrupted_after(steps, begin(), threads);
    ASSERT_TRUE(left.has_value());
    EXPECT_GE(left->state.step, steps);
    EXPECT_LT(left->state.step, steps + 20) << "it may take twenty steps to stop";
    testing::expect_same(expected, go_on(*left, threads, silent_),
                         fmt::format("stopped after {} steps on {} threads", steps, threads));
  }
}

TEST_F(InterruptedIncision, GoesOnFromBytesWithTheBitsOfAnUninterruptedOne) {
  const auto left = interrupted_after(33, begin(), 1);
  ASSERT_TRUE(left.has_value());
  ASSERT_FALSE(left->state.record.removals.empty() || left->state.bonds.empty() || left->frames.empty());
  const auto back = from_bytes<IncisionProgress>(bytes_of(*left), "bytes");
  const IncisionResult expected = straight(), resumed = go_on(back, 1, silent_);
  testing::expect_same(expected, resumed, "from bytes");
  IncisionResult alike = resumed;
  alike.wall_s = expected.wall_s;
  EXPECT_EQ(bytes_of(alike), bytes_of(expected)) << "in every field but the time that it took";
  EXPECT_EQ(bytes_of(from_bytes<IncisionResult>(bytes_of(expected), "bytes")), bytes_of(expected));
}

TEST_F(InterruptedIncision, CanBeInterruptedAgainAndAgain) {
  IncisionProgress progress = begin();
  int interruptions = 0;
  while (const auto left = interrupted_after(15, progress, 1)) {
    ASSERT_GT(left->state.step, progress.state.step) << "an interrupted run gets on";
    progress = *left;
    ++interruptions;
  }
  EXPECT_GE(interruptions, 3);
  testing::expect_same(straight(), go_on(progress, 1, silent_), "resumed from the last interruption");
}

TEST_F(InterruptedIncision, ShowsEveryRenewalStepOfAnUninterruptedRunWhileTheTissueComesToRestToo) {
  end_before_a_renewal_step();
  std::vector<IncisionProgress> shown;
  const IncisionResult expected =
      go_on(begin(), 1, silent_, [&](const IncisionProgress& progress, bool is_interrupted) {
        EXPECT_FALSE(is_interrupted);
        shown.push_back(progress);
      });
  ASSERT_EQ(shown.size(), (expected.steps.size() + 19) / 20);
  for (const IncisionProgress& progress : shown) EXPECT_TRUE(is_renewal_step(progress.state));
  ASSERT_GT(shown.back().relaxation_steps, 0) << "the last is after the tool is out";
  testing::expect_same(expected, go_on(shown.back(), 1, silent_), "resumed while coming to rest");
}

TEST_F(InterruptedIncision, KeepsALastFrameWithTheToolIn) {
  testing::StopAfter monitor(5);
  const IncisionResult stopped = go_on(begin(), 1, monitor);
  ASSERT_EQ(stopped.outcome, Outcome::Cancelled);
  ASSERT_FALSE(stopped.frames.empty());
  EXPECT_EQ(stopped.frames.back().step, 5);
  EXPECT_TRUE(stopped.frames.back().is_tool_in);
}

TEST_F(InterruptedIncision, AddsUpTheTimeOfAllItsRuns) {
  IncisionProgress progress = begin();
  progress.wall_s = 1000.0;
  const IncisionResult result = go_on(progress, 1, silent_);
  EXPECT_GT(result.wall_s, 1000.0);
  EXPECT_LT(result.wall_s, 1100.0);
}

TEST_F(InterruptedIncision, OfAnotherMeshIsRefused) {
  const TissueModel other = make_tissue_model(make_block({32, 32, 8}, {12, 12, 3}), Material{},
                                              {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(33, 33, 0.1))}}});
  Workers workers(1);
  EXPECT_THROW(
      static_cast<void>(continue_incision(other, rest_state(other), path_, settings_, begin(), workers, silent_)),
      InvalidArgument);
}

}  // namespace
}  // namespace incise
