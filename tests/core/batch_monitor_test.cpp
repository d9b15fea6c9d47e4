#include "support/monitors.hpp"

#include <incise/core/batch_monitor.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

namespace incise {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(BatchProgress, IsTheMeanOfItsJobsUnderOneName) {
  testing::RecordingMonitor outer;
  BatchProgress batch(4, "cutting", outer);
  JobMonitor(batch, 0).progress("anything", 0.5);
  JobMonitor(batch, 3).progress("anything", 1.0);
  EXPECT_THAT(outer.fractions, ElementsAre(0.125, 0.375));
  EXPECT_THAT(outer.stages, ElementsAre("cutting", "cutting"));
}

TEST(BatchProgress, OfAnotherThreadCountsButOnlyItsMakerTells) {
  testing::RecordingMonitor outer;
  BatchProgress batch(2, "cutting", outer);
  std::thread([&batch] { batch.note(0, 1.0); }).join();
  EXPECT_THAT(outer.fractions, IsEmpty());
  batch.note(1, 0.5);
  EXPECT_THAT(outer.fractions, ElementsAre(0.75));
}

TEST(JobMonitor, StopsWithTheOuterMonitorAndKeepsItsMessagesToItself) {
  testing::RecordingMonitor outer;
  BatchProgress batch(1, "cutting", outer);
  JobMonitor job(batch, 0);
  job.message(Severity::Warning, "heard by nobody");
  EXPECT_THAT(outer.messages, IsEmpty());
  EXPECT_FALSE(job.is_cancelled());
  outer.stop = true;
  EXPECT_TRUE(job.is_cancelled());
}

}  // namespace
}  // namespace incise
