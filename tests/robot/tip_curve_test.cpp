#include "robot/tip_curve.hpp"

#include "robot/ring_path.hpp"

#include <gtest/gtest.h>

namespace incise::robot_detail {
namespace {

ToolPath uneven_path() {
  ToolPath path = incise::testing::ring_path(24);
  for (std::size_t i = 0; i < path.waypoints.size(); i += 3) {
    const Vec3 outwards = (path.waypoints[i].position_mm - Vec3(600.0, 0.0, 100.0)).normalized();
    path.waypoints[i].position_mm += 1.5 * outwards;
    path.waypoints[i].axis = (-Vec3::UnitZ() + 0.2 * outwards).normalized();
  }
  return path;
}

TEST(TipCurve, GoesThroughEveryTip) {
  const ToolPath path = uneven_path();
  const TipCurve curve(path);
  for (std::size_t i = 0; i < path.waypoints.size(); ++i) {
    const TipSample at = curve.at(curve.arc_at_waypoint(i));
    EXPECT_LT((at.tip_mm - path.waypoints[i].position_mm - 5.0 * path.waypoints[i].axis).norm(), 1e-9) << i;
    EXPECT_LT((at.axis - path.waypoints[i].axis).norm(), 1e-9) << i;
  }
}

TEST(TipCurve, IsMeasuredByItsLength) {
  const TipCurve curve(uneven_path());
  const double h = 1e-3;
  for (double arc = h; arc < curve.length_mm(); arc += 0.0731) {
    EXPECT_NEAR((curve.at(arc).tip_mm - curve.at(arc - h).tip_mm).norm() / h, 1.0, 1e-4) << arc;
  }
}

TEST(TipCurve, HasNoStepInDirectionCurvatureOrTurningAtItsWaypoints) {
  const TipCurve curve(uneven_path());
  const double h = 2e-3;
  for (std::size_t i = 1; i < 24; ++i) {
    const double s = curve.arc_at_waypoint(i);
    const auto bend = [&](double at) {
      return Vec3((curve.at(at + h).tip_mm - 2.0 * curve.at(at).tip_mm + curve.at(at - h).tip_mm) / (h * h));
    };
    const auto swing = [&](double at) { return Vec3((curve.at(at + h).axis - curve.at(at - h).axis) / (2.0 * h)); };
    // Curvature reaches 0.6/mm on this course; over 0.02 mm it may change a little, but not step.
    EXPECT_LT((bend(s + 0.01) - bend(s - 0.01)).norm(), 0.03) << i;
    EXPECT_LT((swing(s + 0.01) - swing(s - 0.01)).norm(), 2e-3) << i;
  }
}

}  // namespace
}  // namespace incise::robot_detail
