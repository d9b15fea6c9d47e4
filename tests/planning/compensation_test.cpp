#include "planning/bodies.hpp"
#include "support/contour_shapes.hpp"
#include "support/directions.hpp"

#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/evaluation/evaluation.hpp>
#include <incise/planning/compensation.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace incise {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A stand-in for tissue: the cut is the path displaced along the radius by a smooth function of the angle, laid on the
/// surface.
template <class Drift>
Contour toy_cut(const ToolPath& path, const SurfaceQuery& surface, const Drift& drift_mm) {
  Contour cut = resample(entry_contour(path), 720);
  for (Vec3& p : cut.points) {
    const double angle = std::atan2(p.y(), p.x());
    const double radius = std::hypot(p.x(), p.y()) + drift_mm(angle);
    p = surface.seen_at(Vec3(radius * std::cos(angle), radius * std::sin(angle), 0.0), kDown)->position_mm;
  }
  return cut;
}

double mean_abs_error(const Contour& cut, const Contour& edge) {
  return evaluate(cut, edge).abs_error_mm->mean;
}

class Compensate : public ::testing::Test {
 protected:
  SurfaceQuery surface_{testing::flat_body()};
  Contour edge_ = testing::circle(10.0, 1440);
  ToolPath path_ = plan_ring(surface_, edge_, {.waypoints = 72});
};

TEST_F(Compensate, ChangesNothingWhenTheErrorIsZero) {
  // Errors of exactly 0: every point of this cut lies 5 mm beside one straight side of the edge.
  const Contour square{.points = {{-10, -10, 0}, {10, -10, 0}, {10, 10, 0}, {-10, 10, 0}}, .is_closed = true};
  const Contour cut{.points = {{15, -5, 0}, {15, 5, 0}}, .is_closed = false};
  const Compensation result = compensate_paper(path_, cut, square, surface_);
  for (std::size_t i = 0; i < 72; ++i) {
    EXPECT_LT((result.path.waypoints[i].position_mm - path_.waypoints[i].position_mm).norm(), 1e-12);
  }
  EXPECT_EQ(result.max_move_mm, 0.0);
  EXPECT_EQ(result.limited_waypoints, 0U);
}

TEST_F(Compensate, MovesTheRingOutByAUniformInwardError) {
  const Contour cut = testing::circle(13.5, 1440);
  const Compensation result = compensate_paper(path_, cut, edge_, surface_);
  for (std::size_t i = 0; i < 72; ++i) {
    EXPECT_NEAR(result.error_mm[i], -1.5, 1e-4);
    EXPECT_NEAR(result.move_mm[i], -result.error_mm[i], 1e-9);
    const Vec3& before = path_.waypoints[i].position_mm;
    EXPECT_NEAR((result.path.waypoints[i].position_mm - before * (1.0 + result.move_mm[i] / before.norm())).norm(), 0.0,
                1e-9);
    EXPECT_EQ(result.path.waypoints[i].depth_mm, 5.0);
    EXPECT_EQ(result.path.waypoints[i].axis, kDown);
  }
  EXPECT_NEAR(result.max_move_mm, 1.5, 1e-4);
  EXPECT_EQ(result.interpolated_waypoints, 0U);
}

TEST_F(Compensate, MovesTheRingInWhereTheCutIsTooFarOut) {
  const Compensation result =
      compensate_paper(path_, testing::circle(16.0, 1440), edge_, surface_, {.relaxation = 0.5});
  for (const double move : result.move_mm) EXPECT_NEAR(move, -0.5, 1e-4);
}

TEST_F(Compensate, DoesNotMoveWaypointsCloserThanTheCloseMargin) {
  const Compensation result =
      compensate_paper(path_, testing::circle(18.5, 1440), edge_, surface_);  // asks for 3.5 mm inwards
  EXPECT_EQ(result.limited_waypoints, 72U);
  for (const Waypoint& w : result.path.waypoints) {
    EXPECT_NEAR(nearest_on(edge_, w.position_mm).distance_mm, 2.7, 1e-6);  // 2.2 of tissue and the electrode's radius
  }
}

TEST_F(Compensate, KeepsTheSurfacesRimClear) {
  const SurfaceQuery narrow(testing::body_with_top([](double, double) { return 0.0; }, 20.0, 8));
  const Contour edge = testing::circle(10.0, 720, Vec3(23, 0, 0));  // the ring reaches x = 38 of 40
  const ToolPath path = plan_ring(narrow, edge, {});
  const Compensation result = compensate_paper(path, testing::circle(12.0, 720, Vec3(23, 0, 0)), edge, narrow);
  EXPECT_GT(result.limited_waypoints, 0U);
  EXPECT_LT(result.limited_waypoints, 24U);
  for (const Waypoint& w : result.path.waypoints) EXPECT_LT(w.position_mm.x(), 39.0 + 1e-9);
}

TEST_F(Compensate, BridgesAGapOfTheMeasuredContour) {
  Contour cut = testing::circle(14.0, 720);
  cut.is_closed = false;
  cut.points.resize(600);  // 60° missing
  const Compensation result = compensate_paper(path_, cut, edge_, surface_);
  EXPECT_NEAR(static_cast<double>(result.interpolated_waypoints), 12.0, 1.0);
  EXPECT_THAT(result.move_mm, Each(::testing::DoubleNear(1.0, 1e-3)));
}

TEST_F(Compensate, SmoothsOnlyWhenAsked) {
  const auto rough = [](double a) { return -1.0 + 0.5 * std::cos(30.0 * a); };
  const Contour cut = toy_cut(path_, surface_, rough);
  const auto roughness = [&](int passes) {
    const Compensation result = compensate_paper(path_, cut, edge_, surface_, {.smoothing_passes = passes});
    double sum = 0.0;
    for (std::size_t i = 1; i < 72; ++i) sum += std::abs(result.move_mm[i] - result.move_mm[i - 1]);
    return sum;
  };
  EXPECT_LT(roughness(4), 0.2 * roughness(0));
}

TEST_F(Compensate, OnePassRemovesMostOfASmoothErrorOnAFlatBody) {
  const auto drift = [](double a) { return -1.4 + 0.8 * std::sin(2.0 * a) + 0.4 * std::cos(3.0 * a); };
  const double before = mean_abs_error(toy_cut(path_, surface_, drift), edge_);
  const Compensation result = compensate_paper(path_, toy_cut(path_, surface_, drift), edge_, surface_);
  const double after = mean_abs_error(toy_cut(result.path, surface_, drift), edge_);
  EXPECT_GT(before, 1.2);
  EXPECT_LT(after, 0.05 * before);
}

TEST(CompensateOnADome, OnePassRemovesThreeQuartersOfASmoothErrorRoundAnIrregularTumour) {
  const SurfaceQuery surface(testing::dome());
  const Contour edge = project_tumor_edge(testing::irregular_tumor(), surface, kDown);
  const ToolPath path = plan_ring(surface, edge, {});
  const auto drift = [](double a) { return -1.2 + 0.8 * std::sin(2.0 * a); };
  const double before = mean_abs_error(toy_cut(path, surface, drift), edge);
  const Compensation result = compensate_paper(path, toy_cut(path, surface, drift), edge, surface);
  const double after = mean_abs_error(toy_cut(result.path, surface, drift), edge);
  EXPECT_GT(before, 1.0);
  EXPECT_LT(after, 0.25 * before);
  for (const Waypoint& w : result.path.waypoints) EXPECT_NEAR(surface.nearest(w.position_mm).distance_mm, 0.0, 1e-9);
}

TEST(CompensateOnASlope, MovesByTheErrorInSpaceNotInThePicture) {
  const SurfaceQuery surface(testing::wedge(1.0));
  Contour edge = testing::circle(10.0, 720);
  for (Vec3& p : edge.points) p.z() = p.x();
  edge = project_tumor_edge(edge, surface, kDown);
  const ToolPath path = plan_ring(surface, edge, {});
  const Compensation result = compensate_paper(path, entry_contour(path), edge, surface, {.target_mm = 6.0});
  for (std::size_t i = 0; i < path.waypoints.size(); ++i) {
    const double way = (result.path.waypoints[i].position_mm - path.waypoints[i].position_mm).norm();
    EXPECT_NEAR(way, -result.error_mm[i], 1e-9);
    EXPECT_NEAR(way, 1.0, 0.1);
  }
}

TEST_F(Compensate, RefusesAPathThatDoesNotRunOnceRoundTheTumour) {
  const SurfaceQuery surface(testing::flat_body());
  ToolPath beside = path_;
  const Contour far_edge = testing::circle(3.0, 90, Vec3(20, 20, 0));
  EXPECT_THROW(static_cast<void>(compensate_paper(beside, testing::circle(13, 90), far_edge, surface)), CaseError);
}

TEST_F(Compensate, TellsEveryViolationOfItsSettings) {
  const CompensationSettings bad{.target_mm = 0.0, .relaxation = 1.5, .smoothing_passes = -1};
  EXPECT_THAT(sentences(problems_of(bad)),
              ElementsAre(HasSubstr("target_mm"), HasSubstr("relaxation"), HasSubstr("smoothing_passes")));
  EXPECT_THROW(static_cast<void>(compensate_paper(path_, testing::circle(13, 90), edge_, surface_, bad)),
               InvalidArgument);
  ToolPath open = path_;
  open.is_closed = false;
  EXPECT_THROW(static_cast<void>(compensate_paper(open, testing::circle(13, 90), edge_, surface_)), InvalidArgument);
}

}  // namespace
}  // namespace incise
