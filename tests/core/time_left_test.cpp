#include <incise/core/time_left.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

TEST(TimeLeft, IsNotToldBeforeAFiftiethIsDone) {
  TimeLeft left;
  left.note(0.0, 0.0);
  left.note(1.0, 0.019);
  EXPECT_FALSE(left.seconds().has_value());
  left.note(2.0, 0.04);
  EXPECT_DOUBLE_EQ(left.seconds().value(), 2.0 * 0.96 / 0.04);
}

TEST(TimeLeft, AtASteadyPaceCountsDownExactly) {
  TimeLeft left;
  for (int i = 0; i <= 100; ++i) {
    left.note(0.5 * i, 0.01 * i);
    if (i < 2) continue;
    EXPECT_NEAR(left.seconds().value(), 50.0 - 0.5 * i, 1e-9) << i;
  }
}

TEST(TimeLeft, OfAResumedComputationIsThatOfItsOwnPace) {
  TimeLeft left;
  left.note(10.0, 0.6);
  left.note(11.0, 0.7);
  EXPECT_NEAR(left.seconds().value(), 3.0, 1e-9);
}

TEST(TimeLeft, OfTheNextComputationBeginsAnew) {
  TimeLeft left;
  left.note(0.0, 0.0);
  left.note(100.0, 1.0);
  left.note(100.0, 0.0);
  EXPECT_FALSE(left.seconds().has_value());
  left.note(101.0, 0.5);
  EXPECT_NEAR(left.seconds().value(), 1.0, 1e-9);
}

TEST(TimeLeft, FollowsAChangedPaceWithoutJumping) {
  TimeLeft left;
  std::optional<double> last;
  for (int i = 0; i <= 400; ++i) {  // a hundred seconds at one pace, then three hundred at a third of it
    const double fraction = i <= 100 ? 0.005 * i : 0.5 + 0.5 * (i - 100) / 300.0;
    left.note(i, fraction);
    if (i < 4) continue;
    EXPECT_NEAR(left.seconds().value(), last.value_or(*left.seconds()), 4.0) << "from second " << i - 1;
    last = left.seconds();
  }
  EXPECT_NEAR(last.value(), 0.0, 5.0);
}

}  // namespace
}  // namespace incise
