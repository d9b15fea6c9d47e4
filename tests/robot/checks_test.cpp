#include "robot/ring_path.hpp"

#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/robot/checks.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace incise {
namespace {

using incise::testing::failures;
using incise::testing::line_path;
using incise::testing::ring_path;

std::vector<std::string> failures_of(const ToolPath& path, const CheckSettings& settings = {},
                                     const CheckInputs& inputs = {}) {
  return failures(check_program(make_program(path), path, settings, inputs));
}

const ProgramCheck& named(const ProgramChecks& checks, const std::string& name) {
  for (const auto& check : checks.checks) {
    if (check.name == name) return check;
  }
  throw std::runtime_error("no check " + name);
}

TEST(CheckProgram, PassesASoundRingAndSaysWhatItFound) {
  const ToolPath path = ring_path();
  const ProgramChecks checks = check_program(make_program(path), path, {}, {.intended = &path});
  EXPECT_THAT(failures(checks), ::testing::IsEmpty());
  std::vector<std::string> names;
  for (const auto& check : checks.checks) names.push_back(check.name);
  EXPECT_THAT(names,
              ::testing::ElementsAre("finite", "frame", "closed", "gap", "self_crossing", "speed_min", "speed_max",
                                     "depth", "margin", "encloses", "deviation", "chord_error", "tilt", "tool_table",
                                     "reach", "joint_limits", "joint_speed", "joint_acceleration", "singularity",
                                     "tip_speed", "table", "self_collision", "base"));
  EXPECT_NEAR(named(checks, "margin").value, 5.0, 0.05);
  EXPECT_NEAR(named(checks, "speed_max").value, 7.0, 1e-12);
  EXPECT_LT(named(checks, "deviation").value, 0.05);
  EXPECT_LT(named(checks, "tip_speed").value, 1e-3);
  EXPECT_LT(named(checks, "joint_speed").value, 0.1);
}

TEST(CheckProgram, SaysWhatNobodyHasLookedAt) {
  const ToolPath path = line_path();
  const auto checks = check_program(make_program(path), path, {.must_be_ring = false});
  EXPECT_THAT(failures(checks), ::testing::IsEmpty());
  const std::string all = ::testing::PrintToString(checks.not_made);
  for (const char* word :
       {"forces", "collisions", "controller", "margin", "deviation", "power", "registration", "shaft"}) {
    EXPECT_THAT(all, ::testing::HasSubstr(word));
  }
}

TEST(CheckProgram, FindsNumbersThatAreNotFiniteAndLooksNoFurther) {
  const ToolPath path = ring_path();
  RobotProgram program = make_program(path);
  program.poses[7].tip_mm.x() = std::numeric_limits<double>::infinity();
  const auto checks = check_program(program, path);
  EXPECT_THAT(failures(checks), ::testing::ElementsAre("finite"));
  EXPECT_EQ(checks.checks.size(), 1u);
  EXPECT_EQ(checks.checks[0].pose, 7u);
}

TEST(CheckProgram, FindsAnotherFrame) {
  ToolPath path = ring_path();
  const RobotProgram program = make_program(path);
  path.frame = PathFrame::SimRest;
  EXPECT_THAT(failures(check_program(program, path)), ::testing::ElementsAre("frame"));
}

TEST(CheckProgram, FindsAnOpenRing) {
  ToolPath path = ring_path();
  path.is_closed = false;
  EXPECT_THAT(failures_of(path), ::testing::ElementsAre("closed"));
}

TEST(CheckProgram, FindsACourseThatCrossesItself) {
  ToolPath path = ring_path();
  std::swap(path.waypoints[10].position_mm, path.waypoints[13].position_mm);
  EXPECT_THAT(failures_of(path), ::testing::Contains("self_crossing"));
}

TEST(CheckProgram, FindsSpeedsOutOfRange) {
  ToolPath path = ring_path();
  for (auto& waypoint : path.waypoints) waypoint.speed_mm_s = 31.0;
  EXPECT_THAT(failures_of(path), ::testing::ElementsAre("speed_max"));
  for (auto& waypoint : path.waypoints) waypoint.speed_mm_s = 0.4;
  EXPECT_THAT(failures_of(path), ::testing::ElementsAre("speed_min"));
}

TEST(CheckProgram, FindsADepthThatIsNotThePlannedOne) {
  ToolPath path = ring_path();
  path.waypoints[20].depth_mm = 5.8;
  EXPECT_THAT(failures_of(path), ::testing::ElementsAre("depth"));
  for (Waypoint& waypoint : path.waypoints) waypoint.depth_mm = 1.5;
  const std::string said = named(check_program(make_program(path), path), "depth").message();
  EXPECT_THAT(said, ::testing::HasSubstr("the path's depth (1.5 mm there) and the planned 5 mm"));
}

TEST(CheckProgram, FindsHeatThatReachesTheTumourEdge) {
  const ToolPath path = ring_path();  // 5 mm outside it
  EXPECT_THAT(failures_of(path, {}, {.heat_half_width_mm = 4.9}), ::testing::IsEmpty());
  const auto checks = check_program(make_program(path), path, {}, {.heat_half_width_mm = 39.5});
  EXPECT_THAT(failures(checks), ::testing::ElementsAre("heat"));
  EXPECT_EQ(named(checks, "heat").value, named(checks, "margin").value);
  EXPECT_EQ(named(checks, "heat").limit, 39.5);
  EXPECT_TRUE(can_be_overridden("heat"));
  EXPECT_THAT(::testing::PrintToString(check_program(make_program(path), path).not_made), ::testing::HasSubstr("heat"));
}

TEST(CheckProgram, FindsACourseTooCloseToTheTumourEdge) {
  ToolPath path = ring_path();
  path.waypoints[12].position_mm = Vec3(600.0, 12.0, 100.0);  // 2 mm from the edge, on its outside
  EXPECT_THAT(failures_of(path), ::testing::ElementsAre("margin"));
}

TEST(CheckProgram, FindsACourseInsideTheTumourEdgeHoweverFarFromIt) {
  ToolPath path = ring_path();
  for (auto& point : path.tumor_edge.points) point = Vec3(600.0, 0.0, 100.0) + 2.0 * (point - Vec3(600.0, 0.0, 100.0));
  const auto checks = check_program(make_program(path), path);
  EXPECT_THAT(failures(checks), ::testing::ElementsAre("margin", "encloses"));
  EXPECT_LT(named(checks, "margin").value, -4.9);
}

TEST(CheckProgram, FindsARingBesideOrAboveTheTumourEdge) {
  for (const Vec3& shift : {Vec3(40, 0, 0), Vec3(100, 0, 0), Vec3(0, 0, 100)}) {
    ToolPath path = ring_path();
    for (auto& point : path.tumor_edge.points) point += shift;
    EXPECT_THAT(failures_of(path), ::testing::ElementsAre("encloses")) << shift.transpose();
  }
}

TEST(CheckProgram, NamesTheEdgePointThatIsWorst) {
  ToolPath path = ring_path();
  EXPECT_NEAR(named(check_program(make_program(path), path), "encloses").value, 0.0, 1e-9);
  path.tumor_edge.points[12].z() += 25.0;  // at 600, 10
  const auto high = check_program(make_program(path), path);
  EXPECT_THAT(failures(high), ::testing::ElementsAre("encloses"));
  EXPECT_NEAR(named(high, "encloses").value, 25.0, 1e-9);
  EXPECT_NEAR(static_cast<double>(named(high, "encloses").waypoint.value()), 12.0, 1.0);
  EXPECT_THAT(
      named(high, "encloses").message(),
      ::testing::AllOf(::testing::HasSubstr("encloses: 25 mm at waypoint 1"), ::testing::HasSubstr("must be <= 20 mm"),
                       ::testing::HasSubstr("lies above the ring, at 600.00, 10.00, 125.00 mm")));
  path.tumor_edge.points[12].z() -= 50.0;
  EXPECT_THAT(named(check_program(make_program(path), path), "encloses").message(),
              ::testing::HasSubstr("lies below the ring, at 600.00, 10.00, 75.00 mm"));
  path = ring_path();
  path.tumor_edge.points[12].y() = 25.0;  // the ring's radius is 15: 10 mm outside it, next to its waypoint 12
  const auto beyond = check_program(make_program(path), path);
  EXPECT_THAT(failures(beyond), ::testing::Contains("encloses"));
  EXPECT_THAT(named(beyond, "encloses").message(),
              ::testing::AllOf(::testing::HasSubstr("encloses: not satisfied at waypoint 1"),
                               ::testing::HasSubstr("outside it at 600.00, 25.00, 100.00 mm, by 10.0")));
}

TEST(CheckProgram, FindsATumourEdgeThatCrossesItself) {
  ToolPath path = ring_path();
  auto& edge = path.tumor_edge.points;
  std::reverse(edge.begin() + 1, edge.begin() + 24);  // an eight: 0, 23, 22 … 1, 24, 25 …
  for (const double lift_mm : {0.0, 3.0}) {           // a crossing is one that is seen: the strands need not touch
    for (std::size_t i = 1; i < 24; ++i) edge[i].z() = 100.0 + lift_mm;
    const auto checks = check_program(make_program(path), path);
    EXPECT_THAT(failures(checks), ::testing::ElementsAre("margin"));
    // The strands 0 to 23 and 1 to 24 meet above the centre: 10 sin 7.5° · 10 / (10 + 10 cos 7.5°) = 0.655.
    EXPECT_THAT(named(checks, "margin").message(),
                ::testing::HasSubstr("margin: not satisfied: the tumour edge is a simple curve, seen along the mean "
                                     "axis: it crosses itself at 600.00, 0.66, 100.00 mm"));
  }
}

TEST(CheckProgram, FindsARingWithoutATumourEdge) {
  for (const std::size_t points : {0U, 1U, 2U}) {
    ToolPath path = ring_path();
    path.tumor_edge.points.resize(points);
    EXPECT_THAT(failures_of(path), ::testing::ElementsAre("margin")) << points;
  }
}

TEST(CheckProgram, FindsATumourEdgeThatEnclosesNothing) {
  const Vec3 middle(600.0, 0.0, 100.0);
  for (const Points& edge : {Points(3, middle), Points{middle, middle + Vec3::UnitX(), middle + 2.0 * Vec3::UnitX()},
                             Points{middle, middle + Vec3::UnitZ(), middle + 2.0 * Vec3::UnitX()}}) {
    ToolPath path = ring_path();
    path.tumor_edge.points = edge;
    const auto checks = check_program(make_program(path), path);
    EXPECT_THAT(failures(checks), ::testing::ElementsAre("margin"));
    EXPECT_THAT(named(checks, "margin").message(), ::testing::HasSubstr("3 points lie on a line or coincide"));
  }
}

TEST(CheckProgram, AnOpenTumourEdgeHidesNoCutThroughTheTumour) {
  ToolPath path = ring_path();
  path.tumor_edge.is_closed = false;
  for (Waypoint& w : path.waypoints) w.position_mm = Vec3(600, 0, 100) + 0.3 * (w.position_mm - Vec3(600, 0, 100));
  path.is_closed = false;
  EXPECT_THAT(failures_of(path, {.must_be_ring = false}), ::testing::Contains("margin"));
  path.tumor_edge.is_closed = true;
  EXPECT_THAT(failures_of(path, {.must_be_ring = false}), ::testing::Contains("margin"));
}

TEST(CheckProgram, ListsWhatAnOpenCutIsNotHeldTo) {
  const ToolPath path = line_path();
  const auto checks = check_program(make_program(path), path, {.must_be_ring = false});
  EXPECT_THAT(checks.not_made, ::testing::Contains("closed, gap, encloses: the path need not be a ring"));
}

TEST(CheckProgram, FindsWaypointsThatAreMissing) {
  ToolPath path = ring_path();
  path.waypoints.erase(path.waypoints.begin(), path.waypoints.begin() + 5);
  EXPECT_THAT(failures_of(path), ::testing::ElementsAre("gap"));
  EXPECT_THAT(named(check_program(make_program(path), path), "gap").message(), ::testing::HasSubstr("gap: 11.48 mm"));
}

TEST(CheckProgram, LongStraightSidesPassOnceTheyAreSampledEvenly) {
  // A square of 30 mm with round corners of 4 mm, whose corners are sampled every 0.5 mm and whose sides not at all.
  ToolPath path = ring_path();
  Contour square;
  for (int corner = 0; corner < 4; ++corner) {
    for (int k = 0; k <= 12; ++k) {
      const double angle = 0.5 * units::kPi * (corner + k / 12.0);
      const double middle = 0.5 * units::kPi * (corner + 0.5);
      const Vec3 center =
          Vec3(600.0, 0.0, 100.0) + 11.0 * std::sqrt(2.0) * Vec3(std::cos(middle), std::sin(middle), 0.0);
      square.points.push_back(center + 4.0 * Vec3(std::cos(angle), std::sin(angle), 0.0));
    }
  }
  const auto follow = [&](const Contour& contour) {
    path.waypoints.clear();
    for (const Vec3& point : contour.points) path.waypoints.push_back({point, -Vec3::UnitZ(), 5.0, 7.0});
  };
  follow(square);
  const auto sparse = check_program(make_program(path), path);
  EXPECT_THAT(failures(sparse), ::testing::Contains("gap"));
  EXPECT_NEAR(named(sparse, "gap").value, 22.0, 1e-9);
  EXPECT_THAT(named(sparse, "gap").message(), ::testing::HasSubstr("sample long straight sides"));
  follow(resample(square, 113));
  EXPECT_THAT(failures_of(path), ::testing::IsEmpty());
}

TEST(CheckProgram, FindsANeedleThatLeansUnderTheTumour) {
  ToolPath path = ring_path();
  for (auto& waypoint : path.waypoints) {
    const Vec3 inwards = (Vec3(600.0, 0.0, 100.0) - waypoint.position_mm).normalized();
    waypoint.axis = (inwards * std::sin(0.7) - Vec3::UnitZ() * std::cos(0.7)).normalized();  // 40 degrees
  }
  const auto checks = check_program(make_program(path), path);
  EXPECT_THAT(failures(checks), ::testing::Contains("margin"));
  EXPECT_NEAR(named(checks, "margin").value, 5.0 - 5.0 * std::sin(0.7), 0.05);
}

TEST(CheckProgram, FindsAToolThatComesFromBelow) {
  ToolPath path = ring_path();
  for (auto& waypoint : path.waypoints) waypoint.axis = Vec3::UnitZ();
  const auto checks = check_program(make_program(path), path);
  EXPECT_THAT(failures(checks), ::testing::Contains("tilt"));
  EXPECT_NEAR(named(checks, "tilt").value, 180.0, 1e-6);
}

TEST(CheckProgram, FindsATipBelowTheTable) {
  ArmSetup setup;
  setup.table_z_mm = 97.0;  // the ring's entries are 3 mm above it, its tips 2 mm below
  const ToolPath path = ring_path();
  const auto checks = check_program(make_program(path, {}, setup), path, {.table_clearance_mm = -1000.0});
  EXPECT_THAT(failures(checks), ::testing::ElementsAre("tool_table"));
  EXPECT_NEAR(named(checks, "tool_table").value, -2.0, 1e-6);
}

TEST(CheckProgram, AnIntendedPathThatIsLeftOutInPartIsADeviation) {
  const ToolPath intended = ring_path();
  ToolPath path = intended;
  path.waypoints.erase(path.waypoints.begin(), path.waypoints.begin() + 20);
  EXPECT_THAT(failures_of(path, {.max_gap_ratio = 100.0}, {.intended = &intended}), ::testing::Contains("deviation"));
}

TEST(CheckProgram, FindsADeviationBeyondTheCap) {
  const ToolPath intended = ring_path();
  ToolPath path = intended;
  for (auto& waypoint : path.waypoints) waypoint.position_mm.x() += 1.5;
  EXPECT_TRUE(failures_of(path, {.max_deviation_mm = 1.6}, {.intended = &intended}).empty());
  EXPECT_THAT(failures_of(path, {.max_deviation_mm = 1.4}, {.intended = &intended}),
              ::testing::ElementsAre("deviation"));
}

TEST(CheckProgram, FindsAPlaceOutOfReachAndNamesItsWaypoint) {
  ToolPath path = ring_path();
  for (auto& waypoint : path.waypoints) waypoint.position_mm.x() += 855.0;
  for (auto& point : path.tumor_edge.points) point.x() += 855.0;
  const auto beyond = check_program(make_program(path), path);
  EXPECT_THAT(failures(beyond), ::testing::ElementsAre("reach"));
  EXPECT_TRUE(named(beyond, "reach").waypoint.has_value());
  EXPECT_THAT(named(beyond, "reach").message(), ::testing::HasSubstr("reach: not satisfied at waypoint 0 (pose 0)"));
  EXPECT_THAT(::testing::PrintToString(beyond.not_made), ::testing::HasSubstr("no motion of the arm was found"));
}

TEST(CheckProgram, FindsAWristOverTheShoulder) {
  // Straight above the base the arm cannot go: its shoulder is in the way.
  ToolPath path = ring_path();
  for (auto& waypoint : path.waypoints) waypoint.position_mm += Vec3(-600.0, 0.0, 500.0);
  path.tumor_edge = {};
  const auto failed = failures_of(path);
  EXPECT_THAT(failed, ::testing::Contains("reach"));
}

TEST(CheckProgram, FindsAStretchedArmNextToASingularityBeforeItIsOutOfReach) {
  ToolPath path = line_path();  // the needle points away from the base, at the height of the shoulder
  for (auto& waypoint : path.waypoints) {
    waypoint.position_mm = Vec3(1440.0, waypoint.position_mm.x() - 700.0, 250.0);
    waypoint.axis = Vec3::UnitX();
  }
  std::vector<std::string> failed;
  for (int step = 0; step < 30 && failed.empty(); ++step) {
    failed = failures_of(path, {.must_be_ring = false, .max_tilt_deg = 100.0});
    for (auto& waypoint : path.waypoints) waypoint.position_mm.x() += 4.0;
  }
  EXPECT_THAT(failed, ::testing::Contains("singularity"));
}

TEST(CheckProgram, FindsAnArmThatWouldReachBelowTheTable) {
  ToolPath path = ring_path();
  const auto settings = CheckSettings{};
  ArmSetup setup{.table_z_mm = 400.0};
  EXPECT_THAT(failures(check_program(make_program(path, {}, setup), path, settings)), ::testing::Contains("table"));
}

TEST(CheckProgram, FindsJointLimitsSpeedsAndAccelerations) {
  const ToolPath path = ring_path();
  EXPECT_THAT(failures_of(path, {.joint_margin_deg = 300.0}), ::testing::ElementsAre("joint_limits"));
  EXPECT_THAT(failures_of(path, {.joint_speed_share = 1e-3}), ::testing::ElementsAre("joint_speed"));
  EXPECT_THAT(failures_of(path, {.max_joint_acceleration_rad_s2 = 1e-3}), ::testing::ElementsAre("joint_acceleration"));
}

constexpr double kHalfStepMm = 0.2;  // at 50 mm/s in half a period of 8 ms: checks of distance allow for it

/// A flat sheet at a height, as triangles or as points 1 mm apart.
TriMesh sheet(double z_mm, bool as_points) {
  TriMesh mesh;
  for (int i = 0; i <= 80; ++i) {
    for (int j = 0; j <= 80; ++j) mesh.vertices.emplace_back(560.0 + i, -40.0 + j, z_mm);
  }
  if (as_points) return mesh;
  const auto id = [](int i, int j) { return VertexId(static_cast<std::uint32_t>(81 * i + j)); };
  for (int i = 0; i < 80; ++i) {
    for (int j = 0; j < 80; ++j) {
      mesh.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      mesh.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  }
  return mesh;
}

TEST(CheckProgram, MeasuresDepthBelowASurfaceOfTrianglesOrPoints) {
  const ToolPath path = ring_path();
  for (const bool as_points : {false, true}) {
    const TriMesh right = sheet(100.2, as_points), wrong = sheet(100.8, as_points);
    const auto checks = check_program(make_program(path), path, {}, {.surface = &right});
    EXPECT_THAT(failures(checks), ::testing::IsEmpty());
    EXPECT_NEAR(named(checks, "depth").value, 0.2, 1e-6);
    // The shaft begins 20 mm above the surface and is 5 mm thick to either side.
    EXPECT_NEAR(named(checks, "shaft").value, 20.0 - 0.2 - 5.0, kHalfStepMm);
    EXPECT_THAT(failures_of(path, {}, {.surface = &wrong}), ::testing::ElementsAre("depth"));
  }
}

TEST(CheckProgram, FindsAShaftThatTouchesTheTissue) {
  const ToolPath path = ring_path();
  TriMesh surface = sheet(100.0, false);
  for (auto& vertex : surface.vertices) {
    const double away = (vertex - Vec3(600.0, 0.0, 100.0)).norm();
    if (away > 17.0) vertex.z() += 30.0;  // a wall 2 mm beside the ring, higher than the needle is long
  }
  EXPECT_THAT(failures_of(path, {}, {.surface = &surface}), ::testing::Contains("shaft"));
}

TEST(CheckProgram, FindsANeedleLedAlongTheBasesAxis) {
  for (const double beside_mm : {0.0, 2.0, 40.0}) {
    ToolPath path = line_path();
    for (auto& waypoint : path.waypoints) {
      waypoint.position_mm = Vec3(beside_mm, waypoint.position_mm.x() - 510.0, 150.0);
      waypoint.axis = Vec3(-std::sin(1.2), 0.0, -std::cos(1.2));  // from the side: the wrist cannot go over the base
    }
    const auto checks = check_program(make_program(path), path, {.must_be_ring = false});
    ASSERT_TRUE(named(checks, "reach").passed) << named(checks, "reach").message();
    EXPECT_THAT(failures(checks), ::testing::Contains("base")) << beside_mm;
    EXPECT_NEAR(named(checks, "base").value, beside_mm - 95.0 - 5.0, 8.0);
  }
}

TEST(CheckProgram, FindsAFlangeAboveTheTissue) {
  const ToolPath path = ring_path();
  const TriMesh surface = sheet(100.0, false);
  ArmSetup setup;  // 20 mm above the tip, which is 5 mm deep in the tissue … as a shaft of no length
  setup.T_flange_tool(2, 3) = 30.1;
  const CheckSettings short_needle{.needle_length_mm = 30.0};
  const auto near = check_program(make_program(path, {}, setup), path, short_needle, {.surface = &surface});
  EXPECT_THAT(failures(near), ::testing::Contains("surface_collision"));
  // The flange is 25.1 mm above the tissue, and wrist 3's round end stands out by 25 mm.
  EXPECT_NEAR(named(near, "surface_collision").value, 0.1, kHalfStepMm);
  EXPECT_THAT(named(near, "surface_collision").message(), ::testing::HasSubstr("wrist 3"));
}

TEST(CheckProgram, FindsAWallBesideTheRingThatTheArmWouldMeet) {
  const ToolPath path = ring_path();
  for (const bool as_points : {false, true}) {
    TriMesh surface = sheet(100.0, as_points);
    TriMesh wall = sheet(0.0, as_points);
    const auto first = static_cast<std::uint32_t>(surface.vertices.size());
    for (const Vec3& vertex : wall.vertices)
      surface.vertices.emplace_back(656.0, vertex.x() - 600.0, 250.0 + vertex.y() * 3.0);
    for (auto triangle : wall.triangles) {
      for (auto& corner : triangle) corner = VertexId(static_cast<std::uint32_t>(corner.index()) + first);
      surface.triangles.push_back(triangle);
    }
    const auto checks = check_program(make_program(path), path, {}, {.surface = &surface});
    EXPECT_THAT(failures(checks), ::testing::ElementsAre("surface_collision")) << as_points;
  }
}

TEST(CheckProgram, FindsTissueThatTheNeedleMeetsOnItsWayThroughTheAir) {
  const ToolPath path = ring_path();
  TriMesh surface = sheet(100.0, true);  // points: a shelf 20 mm above the first entry, smaller than the shaft's way
  surface.vertices.emplace_back(615.0, 0.0, 118.0);
  const auto checks = check_program(make_program(path), path, {.shaft_clearance_mm = -10.0}, {.surface = &surface});
  EXPECT_THAT(failures(checks), ::testing::Contains("needle"));
  EXPECT_LE(named(checks, "needle").value, 0.0);
}

TEST(CheckProgram, ATurnedOrBentToolHasItsShaftBesideTheNeedle) {
  const ToolPath path = ring_path();
  TriMesh surface = sheet(100.0, false);
  for (auto& vertex : surface.vertices)
    vertex.head<2>() = Vec2(600.0, 0.0) + 6.0 * (vertex.head<2>() - Vec2(600.0, 0.0));
  ArmSetup turned;  // the needle lies across the flange, whose middle is 5 mm below the tissue
  turned.T_flange_tool.topLeftCorner<3, 3>() = Eigen::AngleAxisd(0.5 * units::kPi, Vec3::UnitY()).toRotationMatrix();
  ArmSetup beside;  // the needle points along the flange's axis, 150 mm beside it
  beside.T_flange_tool.topRightCorner<3, 1>() = Vec3(150.0, 0.0, 0.0);
  for (const ArmSetup& setup : {turned, beside}) {
    const auto checks = check_program(make_program(path, {}, setup), path, {}, {.surface = &surface});
    EXPECT_THAT(failures(checks), ::testing::Contains("shaft"));
    EXPECT_NEAR(named(checks, "shaft").value, -5.0, 0.1);  // it goes through the surface, 5 mm thick to either side
  }
  ArmSetup bent;  // by 60 degrees at the needle's upper end, 100 mm on to the flange
  bent.T_flange_tool.topLeftCorner<3, 3>() =
      Eigen::AngleAxisd(units::rad_from_deg(60.0), Vec3::UnitY()).toRotationMatrix();
  bent.T_flange_tool.topRightCorner<3, 1>() =
      Vec3(0.0, 0.0, 100.0) + 25.0 * bent.T_flange_tool.topLeftCorner<3, 3>().col(2);
  const auto clear = check_program(make_program(path, {}, bent), path, {}, {.surface = &surface});
  EXPECT_NEAR(named(clear, "shaft").value, 20.0 - 5.0, kHalfStepMm);  // its nearest place is the needle's upper end
  ArmSetup needle_alone;
  needle_alone.T_flange_tool.topRightCorner<3, 1>() = Vec3(0.0, 0.0, 25.0);
  const auto none = check_program(make_program(path, {}, needle_alone), path, {}, {.surface = &surface});
  EXPECT_THAT(::testing::PrintToString(none.not_made), ::testing::HasSubstr("none behind its needle"));
}

TEST(CheckProgram, FindsAHoleInTheSurfaceBelowTheTool) {
  const ToolPath path = ring_path();
  TriMesh cloud = sheet(100.0, true);
  std::erase_if(cloud.vertices, [](const Vec3& p) { return p.x() > 605.0; });
  const auto checks = check_program(make_program(path), path, {}, {.surface = &cloud});
  EXPECT_THAT(failures(checks), ::testing::Contains("depth"));
  EXPECT_THAT(named(checks, "depth").message(), ::testing::HasSubstr("gap below the tool"));
}

TEST(CheckProgram, SmallHolesInACloudAreBridged) {
  const ToolPath path = ring_path();
  for (const double radius_mm : {1.8, 3.0}) {
    TriMesh cloud = sheet(100.0, true);
    std::erase_if(cloud.vertices,
                  [radius_mm](const Vec3& p) { return (p.head<2>() - Vec2(615.0, 0.0)).norm() < radius_mm; });
    const auto checks = check_program(make_program(path), path, {}, {.surface = &cloud});
    EXPECT_EQ(named(checks, "depth").passed, radius_mm < 2.0) << radius_mm;
  }
}

TEST(CheckProgram, DepthAtTheBorderOfAHoleInACurvedNoisyCloudIsStillTold) {
  const ToolPath path = ring_path();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    TriMesh cloud = sheet(0.0, true);
    for (Vec3& p : cloud.vertices) {
      const double r2 = (p.head<2>() - Vec2(600.0, 0.0)).squaredNorm();
      p.z() = 100.0 - (r2 - 15.0 * 15.0) / (2.0 * 25.0) + 0.2 * random.normal();  // a dome through the ring
    }
    // A hole on the outer side: where the ring passes, all points near it lie on the inner one.
    std::erase_if(cloud.vertices, [](const Vec3& p) { return (p.head<2>() - Vec2(616.5, 0.0)).norm() < 2.9; });
    const auto checks = check_program(make_program(path), path, {}, {.surface = &cloud});
    EXPECT_TRUE(named(checks, "depth").passed) << seed << ": " << named(checks, "depth").message();
  }
}

TEST(CheckProgram, LooksAtPowerAndRegistration) {
  const ToolPath path = ring_path();
  EXPECT_THAT(failures_of(path, {}, {.power_w = 80.0}), ::testing::ElementsAre("power"));
  EXPECT_THAT(failures_of(path, {}, {.power_w = 5.0}), ::testing::ElementsAre("power"));
  EXPECT_TRUE(
      failures_of(path, {}, {.power_w = 35.0, .registration = RegistrationSummary{1.01, 0.4, 0.9, true}}).empty());
  for (const double scale : {0.95, 1.05}) {  // where a range that was given to the search may have stopped it
    EXPECT_THAT(failures_of(path, {}, {.registration = RegistrationSummary{scale, 0.4, 0.9, true}}),
                ::testing::ElementsAre("registration_scale"));
  }
  EXPECT_THAT(failures_of(path, {}, {.registration = RegistrationSummary{0.9, 2.0, 0.2, false}}),
              ::testing::ElementsAre("registration_scale", "registration_rmse", "registration_inliers",
                                     "registration_converged"));
}

ToolPath mark_path() {
  ToolPath path = ring_path();
  path.kind = PathKind::Mark;
  for (std::size_t i = 0; i < path.waypoints.size(); ++i) {
    path.waypoints[i].position_mm = path.tumor_edge.points[i];
    path.waypoints[i].depth_mm = 1.0;
    path.waypoints[i].speed_mm_s = 2.0;
  }
  return path;
}

TEST(CheckProgram, HoldsAMarkToItsOwnList) {
  const ToolPath good = mark_path();
  const auto checks = check_program(make_program(good), good);
  EXPECT_THAT(failures(checks), ::testing::IsEmpty());
  EXPECT_LT(named(checks, "edge_distance").value, 0.05);
  EXPECT_THROW(static_cast<void>(named(checks, "margin")), std::runtime_error);
  ToolPath path = good;
  for (auto& waypoint : path.waypoints) waypoint.position_mm.y() += 0.4;
  EXPECT_THAT(failures_of(path), ::testing::ElementsAre("edge_distance"));
  path = good;
  path.waypoints[5].depth_mm = 1.4;
  EXPECT_THAT(failures_of(path), ::testing::ElementsAre("depth"));
  path = good;
  for (auto& waypoint : path.waypoints) waypoint.speed_mm_s = 2.1;
  EXPECT_THAT(failures_of(path), ::testing::ElementsAre("speed_max"));
}

TEST(CheckProgram, AMarkLeavesNoPartOfTheTumourEdgeOut) {
  ToolPath path = mark_path();
  path.tumor_edge.points[12].y() += 10.0;  // a spike between two waypoints that lie on the circle
  path.waypoints.erase(path.waypoints.begin() + 12);
  const auto spike = check_program(make_program(path), path);
  EXPECT_THAT(failures(spike), ::testing::Contains("edge_distance"));
  EXPECT_NEAR(named(spike, "edge_distance").value, 10.0, 0.1);
  path = mark_path();  // there and back along a quarter of the edge, 0.2 mm apart
  path.waypoints.resize(12);
  for (std::size_t i = 12; i-- > 0;) {
    Waypoint back = path.waypoints[i];
    back.position_mm = Vec3(600, 0, 100) + 1.02 * (back.position_mm - Vec3(600, 0, 100));
    path.waypoints.push_back(back);
  }
  EXPECT_THAT(failures_of(path), ::testing::Contains("edge_distance"));
  path = mark_path();
  path.waypoints.resize(12);
  path.is_closed = false;
  EXPECT_THAT(failures_of(path, {.must_be_ring = false}), ::testing::ElementsAre("edge_distance"));
  path.tumor_edge.points.resize(12);
  path.tumor_edge.is_closed = false;
  EXPECT_THAT(failures_of(path, {.must_be_ring = false}), ::testing::IsEmpty());
}

TEST(OverrideChecks, LetsAFailedCheckPassAndKeepsItInTheRecord) {
  ToolPath path = ring_path();
  path.waypoints[12].depth_mm = 5.8;
  auto checks = check_program(make_program(path), path);
  EXPECT_THAT(failures(checks), ::testing::ElementsAre("depth"));
  EXPECT_THAT(named(checks, "depth").message(), ::testing::HasSubstr("mm at waypoint 12 (pose "));
  override_checks(checks, {"depth", "speed_max"});
  EXPECT_FALSE(named(checks, "depth").passed);
  EXPECT_TRUE(named(checks, "depth").is_overridden);
  EXPECT_FALSE(named(checks, "speed_max").is_overridden);  // it has not failed
}

TEST(OverrideChecks, RefusesWhatCannotBeOverridden) {
  const ToolPath path = ring_path();
  auto checks = check_program(make_program(path), path);
  for (const char* name : {"finite", "frame", "reach", "margin", "margins"})
    EXPECT_THROW(override_checks(checks, {name}), InvalidArgument) << name;
  EXPECT_EQ(check_names().size(), 33u);
}

}  // namespace
}  // namespace incise
