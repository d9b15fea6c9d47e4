#include <incise/core/batch_monitor.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

namespace incise {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Keeps what it is told.
class BatchListener : public Monitor {
 public:
  void message(Severity, std::string_view) override { ++messages; }
  void progress(std::string_view stage, double fraction) override {
    stages.emplace_back(stage);
    fractions.push_back(fraction);
  }
  [[nodiscard]] bool is_cancelled() const override { return stops; }
  std::vector<std::string> stages;
  std::vector<double> fractions;
  int messages = 0;
  bool stops = false;
};

TEST(BatchProgress, IsTheMeanOfItsJobsUnderOneName) {
  BatchListener outer;
  BatchProgress batch(4, "cutting", outer);
  JobMonitor(batch, 0).progress("anything", 0.5);
  JobMonitor(batch, 3).progress("anything", 1.0);
  EXPECT_THAT(outer.fractions, ElementsAre(0.125, 0.375));
  EXPECT_THAT(outer.stages, ElementsAre("cutting", "cutting"));
}

TEST(BatchProgress, OfAnotherThreadCountsButOnlyItsMakerTells) {
  BatchListener outer;
  BatchProgress batch(2, "cutting", outer);
  std::thread([&batch] { batch.note(0, 1.0); }).join();
  EXPECT_THAT(outer.fractions, IsEmpty());
  batch.note(1, 0.5);
  EXPECT_THAT(outer.fractions, ElementsAre(0.75));
}

TEST(JobMonitor, StopsWithTheOuterMonitorAndKeepsItsMessagesToItself) {
  BatchListener outer;
  BatchProgress batch(1, "cutting", outer);
  JobMonitor job(batch, 0);
  job.message(Severity::Warning, "heard by nobody");
  EXPECT_EQ(outer.messages, 0);
  EXPECT_FALSE(job.is_cancelled());
  outer.stops = true;
  EXPECT_TRUE(job.is_cancelled());
}

}  // namespace
}  // namespace incise
