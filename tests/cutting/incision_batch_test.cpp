#include "cutting/ring_in_a_block.hpp"
#include "cutting/same_incision.hpp"

#include <incise/cutting/incision_batch.hpp>

#include <fmt/format.h>

#include <thread>

namespace incise {
namespace {

/// Rings of several dullnesses in one block.
class IncisionBatch : public testing::RingInABlock {
 protected:
  IncisionBatch() : RingInABlock(16) { settings_.cut.advance_per_step_mm = 1.6; }

  [[nodiscard]] std::vector<IncisionJob> jobs() const {
    std::vector<IncisionJob> jobs;
    for (const double dullness : {2.0, 4.0, 6.0}) {
      jobs.push_back({settings_, ring(3.0)});
      jobs.back().settings.cut.dullness = dullness;
    }
    return jobs;
  }

  [[nodiscard]] std::vector<IncisionJobResult> run(const std::vector<IncisionJob>& jobs, int threads,
                                                   Monitor& monitor) const {
    const TissueState stretched = rest_state(model_);
    std::vector<IncisionTask> tasks;
    for (const IncisionJob& job : jobs) tasks.push_back({&model_, &stretched, job});
    std::vector<IncisionJobResult> results(jobs.size());
    Workers workers(threads);
    simulate_incisions(tasks, workers, monitor,
                       [&results](std::size_t i, IncisionJobResult result) { results[i] = std::move(result); });
    return results;
  }

  Monitor silent_;
};

TEST_F(IncisionBatch, GivesTheBitsOfSingleRunsInTheOrderOfTheJobsAtAnyThreadCount) {
  const std::vector<IncisionJob> jobs = this->jobs();
  std::vector<IncisionResult> single;
  Workers alone(1);
  for (const IncisionJob& job : jobs) {
    single.push_back(simulate_incision(model_, rest_state(model_), job.path, job.settings, alone, silent_));
  }
  ASSERT_NE(single[0].record.removals.size(), single[2].record.removals.size());
  for (const int threads : {1, 2, 4}) {
    const std::vector<IncisionJobResult> together = run(jobs, threads, silent_);
    ASSERT_EQ(together.size(), jobs.size());
    for (std::size_t i = 0; i < jobs.size(); ++i) {
      EXPECT_EQ(together[i].problem, "");
      testing::expect_same(single[i], together[i].incision, fmt::format("job {} on {} threads", i, threads));
    }
  }
}

TEST_F(IncisionBatch, AJobThatCannotBeCarriedOutSaysWhyAndLeavesTheOthersAlone) {
  std::vector<IncisionJob> jobs = this->jobs();
  jobs[1].settings.cut.speed_mm_s = 0.0;
  jobs[2].path.frame = PathFrame::Robot;
  const std::vector<IncisionJobResult> results = run(jobs, 2, silent_);
  EXPECT_EQ(results[0].problem, "");
  EXPECT_EQ(results[0].incision.outcome, Outcome::Success);
  EXPECT_NE(results[1].problem.find("speed_mm_s"), std::string::npos) << results[1].problem;
  EXPECT_NE(results[2].problem.find("sim_stretched"), std::string::npos) << results[2].problem;
  EXPECT_EQ(results[1].incision.outcome, Outcome::NotConverged);
}

/// Asks to stop once the given share is done, and looks from which thread it is told.
class StopAt : public Monitor {
 public:
  explicit StopAt(double fraction) : limit_(fraction) {}
  void progress(std::string_view, double fraction) override {
    EXPECT_EQ(std::this_thread::get_id(), caller_);
    EXPECT_GE(fraction, last_);
    last_ = fraction;
    if (fraction >= limit_) is_cancelled_ = true;
  }
  [[nodiscard]] bool is_cancelled() const override { return is_cancelled_; }
  [[nodiscard]] double last() const { return last_; }

 private:
  double limit_;
  double last_ = 0.0;
  std::atomic<bool> is_cancelled_ = false;
  std::thread::id caller_ = std::this_thread::get_id();
};

TEST_F(IncisionBatch, StoppedItKeepsWhatHasEndedAndBeginsNothingMore) {
  StopAt monitor(0.5);  // on one thread: in the middle of the second of three
  const std::vector<IncisionJobResult> results = run(jobs(), 1, monitor);
  EXPECT_EQ(results[0].incision.outcome, Outcome::Success);
  EXPECT_EQ(results[1].incision.outcome, Outcome::Cancelled);
  EXPECT_FALSE(results[1].incision.steps.empty());
  EXPECT_EQ(results[2].incision.outcome, Outcome::Cancelled);
  EXPECT_TRUE(results[2].incision.steps.empty());
}

TEST_F(IncisionBatch, TellsTheProgressOfAllJobsFromTheCallersThreadOnly) {
  StopAt monitor(2.0);  // never
  static_cast<void>(run(jobs(), 3, monitor));
  EXPECT_EQ(monitor.last(), 1.0);
}

TEST_F(IncisionBatch, OverSeveralTissuesHandsOverEachResultWhenItEnds) {
  // The same job in the block and in one twice as stiff: the second is another cut, and each is what a single run
  // gives.
  Material stiff;
  stiff.youngs_modulus_kpa *= 2.0;
  const TissueModel other = make_tissue_model(model_.mesh, stiff, model_.constraints);
  const std::array<const TissueModel*, 2> models{&model_, &other};
  const std::array<TissueState, 2> stretched{rest_state(model_), rest_state(other)};
  std::vector<IncisionTask> tasks;
  for (std::size_t i = 0; i < 2; ++i) tasks.push_back({models[i], &stretched[i], jobs()[2]});
  std::vector<IncisionResult> taken(2);
  Workers workers(2);
  simulate_incisions(tasks, workers, silent_,
                     [&taken](std::size_t i, IncisionJobResult result) { taken[i] = std::move(result.incision); });
  Workers alone(1);
  for (std::size_t i = 0; i < 2; ++i) {
    const IncisionResult single =
        simulate_incision(*models[i], stretched[i], tasks[i].job.path, tasks[i].job.settings, alone, silent_);
    testing::expect_same(single, taken[i], fmt::format("tissue {}", i));
  }
  EXPECT_NE(taken[0].final_state.tissue.positions, taken[1].final_state.tissue.positions);
}

TEST_F(IncisionBatch, OfNoJobsIsEmpty) {
  EXPECT_TRUE(run({}, 2, silent_).empty());
}

}  // namespace
}  // namespace incise
