#include <incise/calibration/drag_response.hpp>
#include <incise/core/error.hpp>

#include <gmock/gmock.h>

#include <cmath>

namespace incise {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

SimulatedProfile flat(double drag_mm, double factor, double error_mm) {
  return {drag_mm, factor, std::vector<double>(4, error_mm)};
}

TEST(DragResponse, GoesStraightBetweenTheDragLengthsThatWereCut) {
  const DragResponse response({flat(3.0, 1.0, -2.0), flat(1.0, 1.0, -1.0), flat(2.0, 1.0, -1.2)});
  EXPECT_THAT(response.at(1.0), Each(-1.0));
  EXPECT_THAT(response.at(1.5), Each(::testing::DoubleNear(-1.1, 1e-12)));
  EXPECT_THAT(response.at(2.75), Each(::testing::DoubleNear(-1.8, 1e-12)));
  EXPECT_EQ(response.least_mm(), 1.0);
  EXPECT_EQ(response.most_mm(), 3.0);
}

TEST(DragResponse, TheSlopeByStiffnessIsPerLogarithmAndStaysBeyondWhereItWasCut) {
  const DragResponse response(
      {flat(1.0, 1.0, -1.0), flat(2.0, 1.0, -1.2), flat(3.0, 1.0, -2.0), flat(1.0, 2.0, -0.9), flat(2.0, 2.0, -0.8)});
  ASSERT_TRUE(response.knows_stiffness());
  EXPECT_NEAR(response.stiffness_slope(1.0)[0], 0.1 / std::log(2.0), 1e-12);
  EXPECT_NEAR(response.stiffness_slope(1.5)[0], 0.25 / std::log(2.0), 1e-12);
  EXPECT_NEAR(response.stiffness_slope(3.0)[0], 0.4 / std::log(2.0), 1e-12);
}

TEST(DragResponse, EndsBeforeTheFirstCutThatLeftNoRing) {
  const DragResponse response({flat(1.0, 1.0, -1.0), flat(2.0, 1.0, -1.2), {3.0, 1.0, {}}, flat(4.0, 1.0, -3.0)});
  EXPECT_EQ(response.most_mm(), 2.0);
  EXPECT_THROW(static_cast<void>(response.at(3.0)), InvalidArgument);
}

TEST(DragResponse, TellsBeforehandWhetherTwoRingsAreThere) {
  EXPECT_TRUE(DragResponse::can_be_made_of({{3.0, 1.0, {}}, flat(2.0, 1.0, -1.0), flat(1.0, 1.0, -1.0)}));
  EXPECT_FALSE(DragResponse::can_be_made_of({flat(2.0, 1.0, -1.0), {1.5, 1.0, {}}, flat(1.0, 1.0, -1.0)}));
  EXPECT_FALSE(DragResponse::can_be_made_of({flat(1.0, 1.0, -1.0), flat(1.0, 2.0, -1.0)}));
}

TEST(DragResponse, WithoutASecondStiffnessSaysSo) {
  const DragResponse response({flat(1.0, 1.0, -1.0), flat(2.0, 1.0, -1.2), {1.0, 2.0, {}}});
  EXPECT_FALSE(response.knows_stiffness());
  EXPECT_THAT(response.stiffness_slope(1.5), Each(0.0));
}

TEST(DragResponse, NeedsTwoRingsAndEquallyManySectors) {
  EXPECT_THROW(DragResponse({flat(1.0, 1.0, -1.0), {2.0, 1.0, {}}}), InvalidArgument);
  EXPECT_THROW(DragResponse({flat(1.0, 1.0, -1.0), {2.0, 1.0, {0.1, 0.2}}}), InvalidArgument);
}

}  // namespace
}  // namespace incise
