#include "support/directions.hpp"

#include <incise/calibration/picture_match.hpp>
#include <incise/core/units.hpp>

#include <gmock/gmock.h>

#include <cmath>

namespace incise {
namespace {

/// A tumour edge without any symmetry, 20 mm across.
Contour irregular_edge() {
  Contour edge;
  for (int i = 0; i < 120; ++i) {
    const double a = 2.0 * units::kPi * i / 120.0;
    const double r = 10.0 + 1.2 * std::cos(2.0 * a + 0.3) + 0.8 * std::sin(3.0 * a) + 0.4 * std::cos(a);
    edge.points.emplace_back(r * std::cos(a), r * std::sin(a), 0.0);
  }
  return edge;
}

Contour placed(Contour edge, double turn_deg, const Vec3& shift, bool is_mirrored = false) {
  const Eigen::AngleAxisd turn(units::rad_from_deg(turn_deg), Vec3::UnitZ());
  for (Vec3& p : edge.points) {
    if (is_mirrored) p.x() = -p.x();
    p = turn * p + shift;
  }
  return edge;
}

TEST(PictureMatch, FindsASmallTurnAndTheShift) {
  const PictureMatch match =
      match_picture(placed(irregular_edge(), -12.0, Vec3(40.0, 25.0, 0.0)), kDown, irregular_edge(), kDown);
  EXPECT_EQ(match.objection, "");
  EXPECT_NEAR(match.turn_deg, 12.0, 1.0);  // the prior pulls a little
  EXPECT_LT(match.rms_mm, 0.1);
  EXPECT_NEAR(match.shift_mm.x(), -40.0, 0.05);
}

TEST(PictureMatch, DoesNotTurnAnEdgeThatIsRoundForNothing) {
  Contour round;
  for (int i = 0; i < 120; ++i)
    round.points.emplace_back(10.0 * std::cos(i * units::kPi / 60.0), 10.0 * std::sin(i * units::kPi / 60.0), 0.0);
  EXPECT_NEAR(match_picture(round, kDown, round, kDown).turn_deg, 0.0, 0.2);
}

TEST(PictureMatch, ObjectsToAMirroredPicture) {
  const PictureMatch match =
      match_picture(placed(irregular_edge(), 0.0, Vec3::Zero(), true), kDown, irregular_edge(), kDown);
  EXPECT_THAT(match.objection, ::testing::HasSubstr("mirrored"));
}

TEST(PictureMatch, ObjectsToAPictureThatIsTurnedFar) {
  const PictureMatch match =
      match_picture(placed(irregular_edge(), 180.0, Vec3(5.0, 0.0, 0.0)), kDown, irregular_edge(), kDown);
  EXPECT_THAT(match.objection, ::testing::HasSubstr("turned by -180 degrees"));
}

TEST(PictureMatch, SeesBothAlongTheirOwnAxes) {
  // The same edge drawn in the plane x = 0, seen along x: the picture's axes are those of view_along.
  const Vec3 along = Vec3::UnitX();
  const ViewFrame view = view_along(along);
  Contour upright = irregular_edge();
  for (Vec3& p : upright.points) p = view.from_view(p);
  const PictureMatch match = match_picture(irregular_edge(), kDown, upright, along);
  EXPECT_EQ(match.objection, "");
  EXPECT_NEAR(match.turn_deg, 0.0, 0.2);
  EXPECT_LT(match.rms_mm, 0.05);
}

}  // namespace
}  // namespace incise
