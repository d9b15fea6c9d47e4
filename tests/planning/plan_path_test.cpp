#include "planning/bodies.hpp"
#include "support/contour_shapes.hpp"
#include "support/directions.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/evaluation/evaluation.hpp>
#include <incise/planning/plan_path.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::refusal_of;

double margin_error(const ToolPath& path, double margin) {
  double worst = 0.0;
  for (const Waypoint& w : path.waypoints) {
    worst = std::max(worst, std::abs(nearest_on(path.tumor_edge, w.position_mm).distance_mm - margin));
  }
  return worst;
}

double uneven_spacing(const ToolPath& path) {
  const Contour entries = entry_contour(path);
  const std::size_t n = entries.points.size();
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double spacing = (entries.points[(i + 1) % n] - entries.points[i]).norm();
    least = std::min(least, spacing);
    most = std::max(most, spacing);
  }
  return most / least - 1.0;
}

TEST(PlanRing, RoundACircularTumourIsACircleOfFiveMillimetresMore) {
  const SurfaceQuery surface(testing::flat_body());
  const ToolPath path = plan_ring(surface, project_tumor_edge(testing::circle(10.0, 720), surface, kDown), {});
  ASSERT_EQ(path.waypoints.size(), 48U);
  EXPECT_TRUE(path.is_closed);
  EXPECT_EQ(path.frame, PathFrame::SimStretched);
  for (const Waypoint& w : path.waypoints) {
    EXPECT_NEAR(w.position_mm.norm(), 15.0, 1e-4);
    EXPECT_NEAR(w.position_mm.z(), 0.0, 1e-12);
    EXPECT_EQ(w.axis, kDown);
    EXPECT_EQ(w.depth_mm, 5.0);
    EXPECT_EQ(w.speed_mm_s, 7.0);
  }
  EXPECT_LT(uneven_spacing(path), 0.01);
}

TEST(PlanRing, RunsCounterClockwiseFromTheAnteriorEnd) {
  const SurfaceQuery surface(testing::flat_body());
  Contour edge = testing::irregular_tumor();
  std::reverse(edge.points.begin(), edge.points.end());
  const ToolPath path = plan_ring(surface, project_tumor_edge(edge, surface, kDown), {});
  EXPECT_GT(signed_area_mm2(entry_contour(path), kDown), 0.0);
  for (const Waypoint& w : path.waypoints) EXPECT_GE(w.position_mm.y(), path.waypoints[0].position_mm.y());
}

TEST(PlanRing, KeepsTheMarginInSpaceOnACurvedSurface) {
  const SurfaceQuery surface(testing::dome());
  const Contour edge = project_tumor_edge(testing::irregular_tumor(), surface, kDown);
  const ToolPath path = plan_ring(surface, edge, {});
  EXPECT_LT(margin_error(path, 5.0), 1e-6);
  for (const Waypoint& w : path.waypoints) EXPECT_NEAR(surface.nearest(w.position_mm).distance_mm, 0.0, 1e-9);
  EXPECT_LT(uneven_spacing(path), 0.05);
  // Straight between waypoints, the mid-line of an ideal cut is off by a chord's height, mostly towards the tumour.
  const Evaluation ideal = evaluate(entry_contour(path), edge);
  EXPECT_LT(ideal.abs_error_mm->mean, 0.04);
  EXPECT_LT(ideal.abs_error_mm->max, 0.15);
}

TEST(PlanRing, IsNarrowerInThePictureWhereTheSurfaceSlopes) {
  // On a plane at 45° the margin of 5 mm uphill shows as 5 cos 45° in the picture; across the slope it stays 5.
  const SurfaceQuery surface(testing::wedge(1.0));
  Contour edge = testing::circle(10.0, 720);
  for (Vec3& p : edge.points) p.z() = p.x();
  const ToolPath path = plan_ring(surface, project_tumor_edge(edge, surface, kDown), {.waypoints = 96});
  double right = 0.0, back = 0.0;
  for (const Waypoint& w : path.waypoints) {
    right = std::max(right, w.position_mm.x());
    back = std::max(back, w.position_mm.y());
  }
  EXPECT_NEAR(right, 10.0 + 5.0 * std::sqrt(0.5), 0.02);
  EXPECT_NEAR(back, 15.0, 0.02);
  EXPECT_LT(margin_error(path, 5.0), 1e-6);
}

TEST(PlanRing, DoesNotCrossItselfRoundADentDeeperThanTheMargin) {
  const SurfaceQuery surface(testing::dome());
  const Contour edge = project_tumor_edge(testing::kidney(), surface, kDown, 6.0);
  const ToolPath path = plan_ring(surface, edge, {});
  EXPECT_FALSE(crosses_itself_in_view(entry_contour(path), kDown));
  EXPECT_LT(margin_error(path, 5.0), 0.01);
  EXPECT_EQ(evaluate(entry_contour(path), edge).outcome, Outcome::Success);
}

TEST(PlanRing, HoldsTheToolAgainstTheNormalWhenAsked) {
  const SurfaceQuery surface(testing::dome());
  const Contour edge = project_tumor_edge(testing::circle(10.0, 360), surface, kDown);
  const ToolPath path = plan_ring(surface, edge, {.axis_mode = AxisMode::SurfaceNormal});
  for (const Waypoint& w : path.waypoints) {
    const Vec3 normal = (w.position_mm + Vec3(0, 0, 40)).normalized();  // of the sphere
    EXPECT_LT(std::acos(std::min(1.0, -w.axis.dot(normal))), 0.03);
    EXPECT_NEAR(w.axis.norm(), 1.0, 1e-12);
  }
}

TEST(PlanRing, TurnsWithTheBodyAndTheApproach) {
  const Mat3 turn = Eigen::AngleAxisd(0.8, Vec3(1, -2, 1).normalized()).toRotationMatrix();
  TriMesh body = testing::dome();
  const SurfaceQuery upright(body);
  Contour edge = project_tumor_edge(testing::irregular_tumor(), upright, kDown);
  const ToolPath expected = plan_ring(upright, edge, {});
  for (Vec3& p : body.vertices) p = turn * p;
  for (Vec3& p : edge.points) p = turn * p;
  const SurfaceQuery turned(body);
  const ToolPath found = plan_ring(turned, edge, {.approach = turn * kDown, .start_direction = turn * -Vec3::UnitY()});
  for (std::size_t i = 0; i < 48; ++i) {
    // The grid along which the curve is traced does not turn with it, so only the curve is the same to rounding.
    EXPECT_LT((turn.transpose() * found.waypoints[i].position_mm - expected.waypoints[i].position_mm).norm(), 0.15);
    EXPECT_NEAR(nearest_on(edge, found.waypoints[i].position_mm).distance_mm, 5.0, 1e-6);
  }
}

TEST(PlanRing, RefusesAPathOutsideTheTissue) {
  const SurfaceQuery surface(testing::flat_body());  // ends at x = 40
  const Contour near_rim = project_tumor_edge(testing::circle(10.0, 90, Vec3(27, 0, 0)), surface, kDown);
  EXPECT_THAT(refusal_of<CaseError>([&] { return plan_ring(surface, near_rim, {}); }),
              AllOf(HasSubstr("a path outside the tissue"), HasSubstr("the surface ends")));
  const Contour at_rim = project_tumor_edge(testing::circle(10.0, 90, Vec3(24.3, 0, 0)), surface, kDown);
  EXPECT_THAT(refusal_of<CaseError>([&] { return plan_ring(surface, at_rim, {}); }),
              AllOf(HasSubstr("a path outside the tissue"), HasSubstr("too close to the surface's rim")));
  EXPECT_NO_THROW(static_cast<void>(plan_ring(surface, at_rim, {.rim_clearance_mm = 0.5})));
}

TEST(PlanRing, RefusesADepthThroughTheTissue) {
  const SurfaceQuery surface(testing::flat_body(4.0));
  const Contour edge = project_tumor_edge(testing::circle(10.0, 90), surface, kDown);
  EXPECT_THAT(refusal_of<CaseError>([&] { return plan_ring(surface, edge, {}); }),
              AllOf(HasSubstr("depth_mm"), HasSubstr("waypoint 0"), HasSubstr("4.00 mm thick")));
  EXPECT_NO_THROW(static_cast<void>(plan_ring(surface, edge, {.depth_mm = 3.9})));
}

TEST(PlanSettings, TellEveryViolation) {
  PlanSettings settings;
  EXPECT_THAT(validate(settings), ElementsAre());
  settings = {.lateral_margin_mm = 0.0, .depth_mm = -1.0, .start_direction = Vec3::UnitZ(), .waypoints = 3};
  EXPECT_THAT(sentences(validate(settings)), ElementsAre(HasSubstr("lateral_margin_mm"), HasSubstr("depth_mm"),
                                                         HasSubstr("waypoints"), HasSubstr("start_direction")));
  const SurfaceQuery surface(testing::flat_body());
  EXPECT_THROW(static_cast<void>(plan_ring(surface, testing::circle(10.0, 90), settings)), InvalidArgument);
}

TEST(PlanLine, SpacesWaypointsEvenlyFromTheAnteriorEnd) {
  const SurfaceQuery surface(testing::flat_body());
  const Contour line{.points = {{5, 20, 0}, {5, -10, 0}}, .is_closed = false};
  const ToolPath path = plan_line(surface, line, {.kind = PlanKind::Line, .waypoints = 31});
  ASSERT_EQ(path.waypoints.size(), 31U);
  EXPECT_FALSE(path.is_closed);
  for (std::size_t i = 0; i < 31; ++i) {
    EXPECT_NEAR((path.waypoints[i].position_mm - Vec3(5, -10.0 + static_cast<double>(i), 0)).norm(), 0.0, 1e-9);
  }
}

TEST(PlanLine, RefusesALineThatLeavesTheTissue) {
  const SurfaceQuery surface(testing::flat_body());
  const Contour line{.points = {{0, 0, 0}, {39.8, 0, 0}}, .is_closed = false};
  EXPECT_THAT(refusal_of<CaseError>([&] { return plan_line(surface, line, {.kind = PlanKind::Line}); }),
              HasSubstr("a path outside the tissue"));
}

class CheckPath : public ::testing::Test {
 protected:
  [[nodiscard]] std::string refusal() const {
    return refusal_of<CaseError>([&] { check_path(path_, surface_, kDown); });
  }
  SurfaceQuery surface_{testing::flat_body()};
  ToolPath path_ = plan_ring(surface_, testing::circle(10.0, 360), {});
};

TEST_F(CheckPath, AcceptsWhatWasPlanned) {
  EXPECT_NO_THROW(check_path(path_, surface_, kDown));
}

TEST_F(CheckPath, RefusesTooFewWaypoints) {
  path_.waypoints.resize(7);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("7 waypoints"), HasSubstr("at least 8")));
}

TEST_F(CheckPath, RefusesWaypointsBesideOrAboveTheTissue) {
  path_.waypoints[5].position_mm.z() = 3.0;
  EXPECT_THAT(refusal(), AllOf(HasSubstr("a path outside the tissue: waypoint 5"), HasSubstr("3.00 mm above")));
  for (Waypoint& w : path_.waypoints) w.position_mm.x() += 50.0;
  EXPECT_THAT(refusal(), HasSubstr("beside the surface"));
}

TEST_F(CheckPath, RefusesAPathThatCrossesItself) {
  std::swap(path_.waypoints[3], path_.waypoints[20]);
  EXPECT_THAT(refusal(), HasSubstr("crosses itself"));
}

TEST_F(CheckPath, RefusesAnAxisThatIsNoDirectionIntoTheTissue) {
  path_.waypoints[2].axis = Vec3(0, 0, -2);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("axis of length 2"), HasSubstr("waypoint 2")));
  path_.waypoints[2].axis = Vec3::UnitZ();
  EXPECT_THAT(refusal(), HasSubstr("points out of the tissue"));
}

TEST_F(CheckPath, RefusesDepthsAndSpeedsThatAreNone) {
  path_.waypoints[9].depth_mm = 0.0;
  EXPECT_THAT(refusal(), AllOf(HasSubstr("depth_mm"), HasSubstr("waypoint 9")));
  path_.waypoints[9].depth_mm = 25.0;
  EXPECT_THAT(refusal(), HasSubstr("through the tissue"));
  path_.waypoints[9].depth_mm = 5.0;
  path_.waypoints[9].speed_mm_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(), HasSubstr("speed_mm_s"));
}

TEST(Thickness, IsMeasuredAlongTheAxis) {
  const SurfaceQuery surface(testing::flat_body(20.0));
  EXPECT_NEAR(thickness_mm(surface, Vec3(0, 0, 0), kDown).value(), 20.0, 1e-9);
  EXPECT_NEAR(thickness_mm(surface, Vec3(0, 0, 0.5), kDown).value(), 20.5, 1e-9);
  EXPECT_NEAR(thickness_mm(surface, Vec3(0, 0, 0), Vec3(0.6, 0, -0.8)).value(), 25.0, 1e-9);
  EXPECT_FALSE(thickness_mm(surface, Vec3(0, 0, 0), Vec3::UnitZ()).has_value());
}

}  // namespace
}  // namespace incise
