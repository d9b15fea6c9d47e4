#include "geometry/carved_block.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/kerf_depth.hpp>

#include <gtest/gtest.h>

namespace incise {
namespace {

/// A block of 20 x 8 x 5 mm in cells of 0.5 mm, from which every tet goes whose middle lies in one of the boxes.
KerfInput carved(const std::vector<Box3>& boxes) {
  static const TetMesh mesh = make_block({20, 8, 5}, {40, 16, 10});
  KerfInput kerf{.surface = boundary_surface(mesh)};
  for (const Tet& tet : mesh.tets) {
    const testing::Corners corners = corners_of(mesh.vertices, tet);
    const Vec3 middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
    for (const Box3& box : boxes) {
      if (box.contains(middle)) kerf.removed_tets.push_back(corners);
    }
  }
  return kerf;
}

/// A straight course over the top of the block.
Contour course(double y) {
  return {{Vec3(2, y, 5), Vec3(18, y, 5)}, false};
}

/// A trench of 1 mm width round y = 4 from x = 0 to 10, 3 mm deep.
const Box3 kTrench(Vec3(0, 3.5, 2), Vec3(10, 4.5, 5));

TEST(KerfDepth, IsThatOfTheTrenchAndZeroWhereNothingIsCut) {
  const DepthProfile profile = depth_along(carved({kTrench}), course(4.0));
  ASSERT_EQ(profile.depth_mm.size(), 64U);
  for (std::size_t i = 0; i < profile.depth_mm.size(); ++i) {
    const double x = profile.course.points[i].x();
    EXPECT_DOUBLE_EQ(profile.arclength_mm[i], x - 2.0);
    if (x < 9.9) {
      EXPECT_NEAR(profile.depth_mm[i], 3.0, 0.15) << x;  // a pixel of the trench's 1 mm may be missed
    }
    if (x > 10.1) {
      EXPECT_EQ(profile.depth_mm[i], 0.0) << x;
    }
  }
}

TEST(KerfDepth, FindsAKerfBesideTheCourseWithinReach) {
  EXPECT_NEAR(depth_along(carved({kTrench}), course(6.0)).depth_mm.front(), 3.0, 0.15);
  KerfDepthSettings settings{.reach_mm = 1.0};
  EXPECT_EQ(depth_along(carved({kTrench}), course(6.0), settings).depth_mm.front(), 0.0);
}

TEST(KerfDepth, CountsATunnelByItsFloor) {
  const Box3 tunnel(Vec3(0, 3.5, 1), Vec3(10, 4.5, 2));
  EXPECT_NEAR(depth_along(carved({tunnel}), course(4.0)).depth_mm.front(), 4.0, 0.2);
}

TEST(KerfDepth, AToothThinnerThanTheNeedleCountsByItsShare) {
  const Box3 tooth(Vec3(0, 3.5, 1), Vec3(10, 4.0, 2));  // half the needle's width goes 1 mm deeper
  EXPECT_NEAR(depth_along(carved({kTrench, tooth}), course(4.0)).depth_mm.front(), 3.5, 0.15);
}

TEST(KerfDepth, RefusesWhatItCannotMeasure) {
  KerfDepthSettings settings{.reach_mm = 0.4};
  EXPECT_THROW(static_cast<void>(depth_along(carved({kTrench}), course(4.0), settings)), InvalidArgument);
  EXPECT_THROW(static_cast<void>(depth_along(carved({kTrench}), Contour{{Vec3(1, 1, 5)}, false})), InvalidArgument);
  EXPECT_THROW(static_cast<void>(depth_along(carved({kTrench}), Contour{{Vec3(1, 1, 5), Vec3(1, 1, 5)}, false})),
               InvalidArgument);
}

}  // namespace
}  // namespace incise
