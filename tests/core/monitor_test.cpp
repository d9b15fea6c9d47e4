#include <incise/core/error.hpp>
#include <incise/core/monitor.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

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
  try {
    throw_if_cancelled(StoppingMonitor(), "meshing");
    FAIL() << "expected Cancelled";
  } catch (const Cancelled& error) {
    EXPECT_STREQ(error.what(), "meshing was interrupted");
  }
}

}  // namespace
}  // namespace incise
