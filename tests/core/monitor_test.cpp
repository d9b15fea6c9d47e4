#include "support/monitors.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/core/monitor.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

TEST(Monitor, NeverStopsByDefault) {
  Monitor monitor;
  monitor.message(Severity::Notice, "heard by nobody");
  monitor.progress("cutting", 0.5);
  EXPECT_NO_THROW(throw_if_cancelled(monitor, "cutting"));
}

TEST(Monitor, StopsAComputationByNameWhenAsked) {
  EXPECT_EQ(testing::refusal_of<Cancelled>([] { throw_if_cancelled(testing::StopAfter(), "meshing"); }),
            "meshing was interrupted");
}

TEST(StopOnly, StopsWithTheOuterMonitorAndTellsItNothing) {
  testing::RecordingMonitor outer;
  StopOnly inner(outer);
  inner.message(Severity::Warning, "inner");
  inner.progress("inner", 0.5);
  EXPECT_TRUE(outer.messages.empty());
  EXPECT_TRUE(outer.fractions.empty());
  EXPECT_FALSE(inner.is_cancelled());
  outer.stop = true;
  EXPECT_TRUE(inner.is_cancelled());
}

}  // namespace
}  // namespace incise
