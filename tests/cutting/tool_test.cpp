#include <incise/core/described_bytes.hpp>
#include <incise/cutting/tool.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace incise {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(Needle, ADiameterOfZeroIsRefused) {
  Needle needle;
  EXPECT_THAT(validate(needle), IsEmpty());
  needle.diameter_mm = 0.0;
  EXPECT_THAT(sentences(validate(needle)), ElementsAre(HasSubstr("diameter_mm: found 0")));
}

TEST(Blade, EachDimensionOfZeroIsRefused) {
  EXPECT_THAT(validate(Blade{}), IsEmpty());
  EXPECT_THAT(sentences(validate(Blade{.thickness_mm = 0.0, .width_mm = -1.0, .length_mm = 0.0})),
              ElementsAre(HasSubstr("thickness_mm: found 0"), HasSubstr("width_mm: found -1"),
                          HasSubstr("length_mm: found 0")));
}

TEST(Ball, ADiameterThatIsNoNumberIsRefused) {
  EXPECT_THAT(validate(Ball{}), IsEmpty());
  EXPECT_THAT(sentences(validate(Ball{.diameter_mm = std::nan("")})), ElementsAre(HasSubstr("diameter_mm: found nan")));
}

TEST(Tool, IsTheSameAgainFromItsBytes) {
  for (const Tool& tool : {Tool(Needle{0.8, 20.0}), Tool(Blade{0.4, 3.0, 20.0}), Tool(Ball{3.0})}) {
    const auto back = from_bytes<Tool>(bytes_of(tool), "test");
    EXPECT_EQ(kind_of(back), kind_of(tool));
    EXPECT_EQ(bytes_of(back), bytes_of(tool));
  }
}

TEST(ToolPose, HalfWayBetweenTwoPosesTheAxisIsAUnitVector) {
  const ToolPose a{{0, 0, 0}, {0, 0, -1}};
  const ToolPose b{{2, 0, 0}, {0, 1, 0}};
  const ToolPose middle = between(a, b, 0.5);
  EXPECT_TRUE(middle.tip_mm.isApprox(Vec3(1, 0, 0)));
  EXPECT_TRUE(middle.axis.isApprox(Vec3(0, std::sqrt(0.5), -std::sqrt(0.5))));
}

TEST(ToolPose, TheHeadingTurnsEvenlyAboutTheAxisAlsoRightRound) {
  const ToolPose a{{0, 0, 0}, -Vec3::UnitZ(), Vec3::UnitX()};
  const ToolPose b{{0, 0, 0}, -Vec3::UnitZ(), -Vec3::UnitX()};
  EXPECT_NEAR(turn_rad(a.heading, between(a, b, 0.25).heading, a.axis), std::copysign(M_PI / 4, turn_rad(a.heading, b.heading, a.axis)), 1e-12);
  EXPECT_NEAR((between(a, b, 1.0).heading - b.heading).norm(), 0.0, 1e-12);
}

TEST(ToolPose, BetweenTiltedPosesTheHeadingStaysAcrossTheAxis) {
  const Vec3 tilted = Vec3(0.4, 0.1, -1).normalized();
  const ToolPose a{{0, 0, 0}, -Vec3::UnitZ(), Vec3::UnitX()};
  const ToolPose b{{1, 0, 0}, tilted, heading_across(Vec3(1, 2, 0), tilted)};
  const ToolPose middle = between(a, b, 0.3);
  EXPECT_NEAR(middle.heading.dot(middle.axis), 0.0, 1e-12);
  EXPECT_NEAR(middle.heading.norm(), 1.0, 1e-12);
}

TEST(TurnOfHeld, OfABladeFollowsItsHeadingAndOfANeedleDoesNot) {
  const ToolPose from{{0, 0, 0}, -Vec3::UnitZ(), Vec3::UnitX()};
  const ToolPose to{{0, 0, 0}, -Vec3::UnitZ(), Vec3::UnitY()};
  EXPECT_NEAR((turn_of_held(Blade{}, from, to) * Vec3::UnitX() - Vec3::UnitY()).norm(), 0.0, 1e-12);
  EXPECT_EQ(turn_of_held(Needle{}, from, to) * Vec3::UnitX(), Vec3::UnitX());
}

TEST(HeldDirections, ANeedleLetsTissueSlideAlongItAndABallDoesNot) {
  const ToolPose pose{{0, 0, 0}, -Vec3::UnitZ(), Vec3::UnitX()};
  EXPECT_NEAR((held_directions(Needle{}, pose) * Vec3(1, 2, 3) - Vec3(1, 2, 0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(held_directions(Ball{}, pose) * Vec3(1, 2, 3), Vec3(1, 2, 3));
}

}  // namespace
}  // namespace incise
