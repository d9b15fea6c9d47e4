#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/core/monitor.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

class Listener : public Monitor {
 public:
  void message(Severity, std::string_view) override { ++heard; }
  void progress(std::string_view, double) override { ++heard; }
  [[nodiscard]] bool is_cancelled() const override { return stops; }
  int heard = 0;
  bool stops = false;
};

class StoppingMonitor : public Monitor {
 public:
  [[nodiscard]] bool is_cancelled() const override { return true; }
};

TEST(Monitor, NeverStopsByDefault) {
  Monitor monitor;
  monitor.message(Severity::Notice, "heard by nobody");
  monitor.progress("cutting", 0.5);
  EXPECT_NO_THROW(throw_if_cancelled(monitor, "cutting"));
}

TEST(Monitor, StopsAComputationByNameWhenAsked) {
  EXPECT_EQ(testing::refusal_of<Cancelled>([] { throw_if_cancelled(StoppingMonitor(), "meshing"); }),
            "meshing was interrupted");
}

TEST(StopOnly, StopsWithTheOuterMonitorAndTellsItNothing) {
  Listener outer;
  StopOnly inner(outer);
  inner.message(Severity::Warning, "inner");
  inner.progress("inner", 0.5);
  EXPECT_EQ(outer.heard, 0);
  EXPECT_FALSE(inner.is_cancelled());
  outer.stops = true;
  EXPECT_TRUE(inner.is_cancelled());
}

}  // namespace
}  // namespace incise
