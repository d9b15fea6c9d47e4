#include "support/contour_shapes.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/planning/plan_marked_path.hpp>
#include <incise/planning/project_path.hpp>

#include <cmath>

namespace incise {
namespace {

const char* const kName = "cloud.ply";

double height(double x, double y) { return 20.0 - (x * x + y * y) / 120.0; }

/// What a camera measures of a dome, in the robot's frame, seen from above.
TriMesh measured(double noise_mm = 0.0, double hole_radius_mm = 0.0) {
  Random random(11);
  TriMesh cloud;
  for (int i = 0; i < 120 * 120; ++i) {
    const double x = -30.0 + 0.5 * (i % 120), y = -30.0 + 0.5 * (i / 120);
    if (std::hypot(x - 15.0, y) < hole_radius_mm) continue;
    cloud.vertices.emplace_back(x, y, height(x, y) + noise_mm * random.normal());
  }
  return cloud;
}

/// The simulation knew the surface 0.8 mm too low, in coordinates of its own.
ToolPath simulated(const Mat4& T_sim_robot) {
  const auto into_sim = [&](const Vec3& p) { return Vec3((T_sim_robot * p.homogeneous()).head<3>()); };
  const Mat3 turn = T_sim_robot.topLeftCorner<3, 3>() / std::cbrt(T_sim_robot.topLeftCorner<3, 3>().determinant());
  ToolPath path;
  for (const Vec3& p : testing::circle(15.0, 48).points) {
    path.waypoints.push_back({into_sim(Vec3(p.x(), p.y(), height(p.x(), p.y()) - 0.8)), turn * -Vec3::UnitZ(), 5.0, 7.0});
  }
  for (const Vec3& p : testing::circle(10.0, 90).points) path.tumor_edge.points.push_back(into_sim(Vec3(p.x(), p.y(), height(p.x(), p.y()) - 0.8)));
  return path;
}

Mat4 registration(double scale = 1.02) {
  Mat4 T = Mat4::Identity();
  T.topLeftCorner<3, 3>() = scale * Eigen::AngleAxisd(2.0, Vec3(0.2, -0.4, 1.0).normalized()).toRotationMatrix();
  T.topRightCorner<3, 1>() = Vec3(400.0, -120.0, 33.0);
  return T;
}

TEST(AtTrueSize, TakesTheScaleOutOfSimulationAndCloudAlike) {
  const double scale = 1.02;
  const Mat4 T = registration(scale);
  const Vec3 camera(10.0, -20.0, 400.0);
  const Mat4 shrink = at_true_size(scale, camera);
  const Mat4 rigid = shrink * T;
  const Mat3 R = rigid.topLeftCorner<3, 3>();
  EXPECT_LT((R.transpose() * R - Mat3::Identity()).norm(), 1e-12);
  EXPECT_NEAR(R.determinant(), 1.0, 1e-12);
  EXPECT_LT(((shrink * camera.homogeneous()).head<3>() - camera).norm(), 1e-12) << "the centre stands still";
  const Vec3 p(3.0, 4.0, 5.0);
  const Vec3 seen = (T * p.homogeneous()).head<3>();
  EXPECT_LT(((rigid * p.homogeneous()).head<3>() - (camera + (seen - camera) / scale)).norm(), 1e-12);
  EXPECT_THROW(static_cast<void>(at_true_size(0.0, camera)), InvalidArgument);
}

/// The simulated path, laid onto what was measured.
class ProjectPath : public ::testing::Test {
 protected:
  [[nodiscard]] ProjectedPath project(const TriMesh& cloud, const ProjectSettings& settings = {},
                                      const Vec3& lift = Vec3::Zero()) const {
    Mat4 T = T_;
    T.topRightCorner<3, 1>() += lift;
    return project_path(path_, T, MeasuredSurface(cloud, approach_of(path_, T)), settings, kName);
  }
  [[nodiscard]] std::string refusal(const TriMesh& cloud, const Vec3& lift = Vec3::Zero()) const {
    return testing::refusal_of<DataError>([&] { return project(cloud, {}, lift); });
  }

  Mat4 T_ = registration();
  ToolPath path_ = simulated(T_.inverse());
};

TEST_F(ProjectPath, LaysTheIncisionOntoTheMeasuredSurface) {
  const ProjectedPath projected = project(measured(0.2));
  EXPECT_EQ(projected.path.frame, PathFrame::Robot);
  EXPECT_EQ(projected.path.kind, PathKind::Incise);
  ASSERT_EQ(projected.path.waypoints.size(), 48U);
  for (const Waypoint& w : projected.path.waypoints) {
    EXPECT_NEAR(w.position_mm.z(), height(w.position_mm.x(), w.position_mm.y()), 0.25);
    EXPECT_NEAR(w.position_mm.head<2>().norm(), 15.0, 1e-6) << "laid down along the approach";
    EXPECT_LT((w.axis + Vec3::UnitZ()).norm(), 1e-9);
    EXPECT_DOUBLE_EQ(w.depth_mm, 5.0) << "a real length, not scaled";
    EXPECT_DOUBLE_EQ(w.speed_mm_s, 7.0);
  }
  EXPECT_NEAR(projected.mean_shift_mm, 0.8, 0.05);
  EXPECT_LT(projected.max_gap_mm, 0.5);
  EXPECT_EQ(projected.path.T_robot_sim, T_);
}

TEST_F(ProjectPath, MarksTheTumorEdgeOneMillimetreDeepAtTwoMillimetresASecond) {
  const ProjectedPath projected = project(measured(), {.kind = PathKind::Mark});
  EXPECT_EQ(projected.path.kind, PathKind::Mark);
  ASSERT_EQ(projected.path.waypoints.size(), 96U);
  for (const Waypoint& w : projected.path.waypoints) {
    EXPECT_NEAR(w.position_mm.head<2>().norm(), 10.0, 0.01);
    EXPECT_NEAR(w.position_mm.z(), height(w.position_mm.x(), w.position_mm.y()), 0.01);
    EXPECT_DOUBLE_EQ(w.depth_mm, 1.0);
    EXPECT_DOUBLE_EQ(w.speed_mm_s, 2.0);
  }
  EXPECT_EQ(projected.path.tumor_edge.points.size(), 90U);
}

TEST_F(ProjectPath, HoldsTheToolAgainstTheMeasuredNormalWhereAsked) {
  const ProjectedPath projected = project(measured(), {.axis_mode = AxisMode::SurfaceNormal});
  for (const Waypoint& w : projected.path.waypoints) {
    const Vec3 normal = Vec3(w.position_mm.x() / 60.0, w.position_mm.y() / 60.0, 1.0).normalized();
    EXPECT_LT((w.axis + normal).norm(), 2e-3);
  }
}

TEST_F(ProjectPath, AveragesTheNormalsAsItDoesTheShifts) {
  const TriMesh cloud = measured(0.3);
  const auto greatest_nod_deg = [&](double smoothing_mm, double& off_deg) {
    const ProjectSettings settings{.smoothing_mm = smoothing_mm, .axis_mode = AxisMode::SurfaceNormal};
    const auto waypoints = project(cloud, settings).path.waypoints;
    const auto degrees = [](const Vec3& a, const Vec3& b) {
      return std::asin(std::min(1.0, a.cross(b).norm())) * 180.0 / 3.14159265;
    };
    double nod_deg = 0.0;
    off_deg = 0.0;
    for (std::size_t i = 0; i < waypoints.size(); ++i) {
      const Waypoint &w = waypoints[i], &next = waypoints[(i + 1) % waypoints.size()];
      nod_deg = std::max(nod_deg, degrees(w.axis, next.axis));
      off_deg = std::max(off_deg,
                         degrees(w.axis, Vec3(w.position_mm.x() / 60.0, w.position_mm.y() / 60.0, 1.0).normalized()));
    }
    return nod_deg;
  };
  double off_deg = 0.0, off_alone_deg = 0.0;
  const double nod_deg = greatest_nod_deg(10.0, off_deg), alone_deg = greatest_nod_deg(0.0, off_alone_deg);
  // From one waypoint to the next the dome's own normal turns by 1.8 degrees.
  EXPECT_LT(nod_deg, 3.0);
  EXPECT_LT(off_deg, 0.6 * off_alone_deg);
  EXPECT_LT(nod_deg - 1.8, 0.5 * (alone_deg - 1.8));
}

TEST_F(ProjectPath, ReportsGapsAndRefusesLargeOnes) {
  const ProjectedPath projected = project(measured(0.0, 1.5));
  EXPECT_NEAR(projected.max_gap_mm, 1.5, 0.3);
  EXPECT_GT(projected.bridged, 0U);
  EXPECT_THAT(refusal(measured(0.0, 3.0)), ::testing::HasSubstr("a gap: the nearest measured point is"));
  EXPECT_EQ(refusal(measured(0.0, 1.5)), "accepted");
}

TEST_F(ProjectPath, RefusesAPathBesideOrFarFromTheSurface) {
  EXPECT_THAT(refusal(measured(), Vec3(25.0, 0.0, 0.0)), ::testing::AnyOf(::testing::HasSubstr("rim"), ::testing::HasSubstr("no measured surface")));
  EXPECT_THAT(refusal(measured(), Vec3(0.0, 0.0, 9.0)), ::testing::HasSubstr("above the measured surface"));
  EXPECT_THAT(refusal(measured(), Vec3(0.0, 0.0, -9.0)), ::testing::HasSubstr("below the measured surface"));
}

TEST_F(ProjectPath, TakesAMeshAsItIs) {
  TriMesh mesh{.vertices = {Vec3(-50, -50, 15), Vec3(50, -50, 15), Vec3(50, 50, 15), Vec3(-50, 50, 15)}};
  // Turned the wrong way round on purpose: an open mesh has no outside.
  mesh.triangles = {{VertexId(0), VertexId(2), VertexId(1)}, {VertexId(0), VertexId(3), VertexId(2)}};
  const ProjectedPath projected = project(mesh, {.axis_mode = AxisMode::SurfaceNormal});
  for (const Waypoint& w : projected.path.waypoints) {
    EXPECT_NEAR(w.position_mm.z(), 15.0, 1e-9);
    EXPECT_LT((w.axis + Vec3::UnitZ()).norm(), 1e-9);
  }
}

TEST_F(ProjectPath, RefusesATransformThatIsNoSimilarity) {
  const MeasuredSurface surface(measured(), -Vec3::UnitZ());
  Mat4 sheared = T_;
  sheared.row(0) *= 1.1;
  EXPECT_THROW(static_cast<void>(project_path(path_, sheared, surface, {}, kName)), InvalidArgument);
  Mat4 mirrored = T_;
  mirrored.row(0) *= -1.0;
  EXPECT_THROW(static_cast<void>(project_path(path_, mirrored, surface, {}, kName)), InvalidArgument);
  ToolPath rest = path_;
  rest.frame = PathFrame::SimRest;
  EXPECT_THROW(static_cast<void>(project_path(rest, T_, surface, {}, kName)), InvalidArgument);
}

TEST(PlanMarkedPath, KeepsTheMarginAroundAMarkOnANoisyCloud) {
  const TriMesh cloud = measured(0.2);
  Contour mark = testing::circle(10.0, 120);
  for (Vec3& p : mark.points) p.z() = height(p.x(), p.y());
  const ToolPath path = plan_marked_path(mark, cloud.vertices, {});
  EXPECT_EQ(path.frame, PathFrame::Robot);
  EXPECT_EQ(path.waypoints.size(), 48U);
  for (const Waypoint& w : path.waypoints) {
    EXPECT_NEAR(nearest_on(mark, w.position_mm).distance_mm, 5.0, 0.15);
    EXPECT_NEAR(w.position_mm.z(), height(w.position_mm.x(), w.position_mm.y()), 0.3);
    EXPECT_DOUBLE_EQ(w.depth_mm, 5.0);
  }
}

TEST(PlanMarkedPath, FollowsAnOpenMarkWithoutMargin) {
  const TriMesh cloud = measured();
  Contour mark{.points = {}, .is_closed = false};
  for (int i = 0; i <= 40; ++i) mark.points.emplace_back(0.5 * i - 10.0, 3.0, height(0.5 * i - 10.0, 3.0));
  const ToolPath path = plan_marked_path(mark, cloud.vertices, {.settings = {.start_direction = Vec3::UnitX()}, .margin_mm = 0.0});
  EXPECT_FALSE(path.is_closed);
  EXPECT_NEAR(path.waypoints.front().position_mm.x(), 10.0, 1e-6);
  EXPECT_NEAR(path.waypoints.back().position_mm.x(), -10.0, 1e-6);
}

TEST(PlanMarkedPath, RefusesAMarkAtTheRimOfWhatWasMeasured) {
  const TriMesh cloud = measured();
  Contour mark = testing::circle(10.0, 120, Vec3(20.0, 0.0, 0.0));
  for (Vec3& p : mark.points) p.z() = height(p.x(), p.y());
  EXPECT_THROW(static_cast<void>(plan_marked_path(mark, cloud.vertices, {})), CaseError);
}

}  // namespace
}  // namespace incise
