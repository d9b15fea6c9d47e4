#include "planning/bodies.hpp"
#include "support/contour_shapes.hpp"
#include "support/directions.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/planning/plan_path.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace incise {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::refusal_of;

TEST(ProjectTumorEdge, LaysPointsOntoTheSurfaceAlongTheApproach) {
  const SurfaceQuery surface(testing::wedge(0.5));
  const Contour edge = testing::circle(10.0, 90, Vec3(0, 0, 3.0));
  const Contour laid = project_tumor_edge(edge, surface, kDown, 9.0);
  ASSERT_EQ(laid.points.size(), 90U);
  for (std::size_t i = 0; i < 90; ++i) {
    EXPECT_NEAR(laid.points[i].x(), edge.points[i].x(), 1e-9);
    EXPECT_NEAR(laid.points[i].z(), 0.5 * laid.points[i].x(), 1e-9);
  }
}

TEST(ProjectTumorEdge, SubdividesLongSegmentsSoThatTheEdgeHugsTheSurface) {
  const SurfaceQuery surface(testing::dome());
  const Contour edge = project_tumor_edge(testing::circle(10.0, 8, Vec3(0, 0, -1)), surface, kDown);
  EXPECT_GT(edge.points.size(), 8U * 7U);
  for (std::size_t i = 0; i < edge.points.size(); ++i) {
    EXPECT_LT((edge.points[(i + 1) % edge.points.size()] - edge.points[i]).norm(), 1.2);
    EXPECT_NEAR(surface.nearest(edge.points[i]).distance_mm, 0.0, 1e-9);
  }
}

TEST(ProjectTumorEdge, NamesThePointThatIsOffTheSurface) {
  const SurfaceQuery surface(testing::flat_body());
  Contour edge = testing::circle(10.0, 60);
  edge.points[7].z() = 6.5;
  EXPECT_THAT(refusal_of<CaseError>([&] { return project_tumor_edge(edge, surface, kDown); }),
              AllOf(HasSubstr("tumour edge off the surface"), HasSubstr("point 7 "), HasSubstr("6.50 mm above"),
                    HasSubstr("within 5 mm")));
  edge.points[7].z() = -6.5;
  EXPECT_THAT(refusal_of<CaseError>([&] { return project_tumor_edge(edge, surface, kDown); }),
              HasSubstr("6.50 mm below"));
}

TEST(ProjectTumorEdge, NamesThePointThatLiesBesideTheTissue) {
  const SurfaceQuery surface(testing::flat_body());
  EXPECT_THAT(refusal_of<CaseError>([&] {
                static_cast<void>(project_tumor_edge(testing::circle(10.0, 60, Vec3(35, 0, 0)), surface, kDown));
              }),
              AllOf(HasSubstr("tumour edge off the surface"), HasSubstr("point 0 "), HasSubstr("beside it")));
}

TEST(ProjectTumorEdge, RefusesWhatIsNoOutline) {
  const SurfaceQuery surface(testing::flat_body());
  const auto refusal = [&](Contour edge) {
    return refusal_of<CaseError>([&] { return project_tumor_edge(edge, surface, kDown); });
  };
  EXPECT_THAT(refusal({.points = {{0, 0, 0}, {1, 0, 0}}, .is_closed = true}), HasSubstr("2 points"));
  EXPECT_THAT(refusal({.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, .is_closed = true}), HasSubstr("without an area"));
  EXPECT_THAT(refusal({.points = {{0, 0, 0}, {9, 9, 0}, {9, 0, 0}, {0, 6, 0}}, .is_closed = true}),
              HasSubstr("crosses itself"));
  Contour broken = testing::circle(10.0, 60);
  broken.points[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(broken), HasSubstr("point 3"));
}

TEST(ProjectLine, LaysAnOpenCurveDown) {
  const SurfaceQuery surface(testing::wedge(0.2));
  const Contour line = project_line({.points = {{-10, 0, 0}, {10, 0, 0}}, .is_closed = false}, surface, kDown);
  EXPECT_EQ(line.points.size(), 21U);
  EXPECT_FALSE(line.is_closed);
  EXPECT_NEAR(line.points.back().z(), 2.0, 1e-9);
}

}  // namespace
}  // namespace incise
