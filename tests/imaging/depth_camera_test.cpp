#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/imaging/depth_camera.hpp>

#include <cmath>
#include <limits>
#include <numbers>

namespace incise {
namespace {

CameraIntrinsics d405() {
  return {.width = 424, .height = 240, .fx = 425.0, .fy = 425.0, .cx = 210.4, .cy = 121.3, .distortion = {}};
}

/// Depth of a slanted plane z = 150 + 0.2 x - 0.1 y mm, with noise.
DepthPicture slanted(const CameraIntrinsics& camera, double noise_mm = 0.0) {
  Random random(3);
  DepthPicture depth{camera.width, camera.height, {}};
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Vec3 ray = ray_through(camera, {u, v});
      const double z = 150.0 / (1.0 - 0.2 * ray.x() + 0.1 * ray.y());
      depth.counts.push_back(static_cast<std::uint16_t>(std::lround(10.0 * (z + noise_mm * random.normal()))));
    }
  }
  return depth;
}

double off_plane_mm(const Vec3& p) {
  return p.z() - (150.0 + 0.2 * p.x() - 0.1 * p.y());
}

TEST(CameraIntrinsics, RayAndPixelUndoEachOtherThroughTheLens) {
  CameraIntrinsics camera = d405();
  camera.distortion = {-0.055, 0.066, 0.0006, -0.0004, -0.021};
  for (const Vec2& pixel : {Vec2(0, 0), Vec2(423, 239), Vec2(210, 121), Vec2(30.5, 200.25)}) {
    EXPECT_LT((pixel_of(camera, 137.0 * ray_through(camera, pixel)) - pixel).norm(), 1e-6);
  }
}

TEST(CloudSeenInColor, OfAlignedPicturesHoldsEveryPixelOnItsRay) {
  DepthCamera camera{d405(), d405(), 0.1, Mat4::Identity()};
  const OrganizedCloud cloud = cloud_seen_in_color(slanted(camera.depth), camera);
  EXPECT_EQ(cloud.measured(), cloud.points.size());
  for (const auto& [u, v] : {std::pair{0, 0}, std::pair{300, 200}}) {
    const Vec3& p = cloud.points[cloud.index(u, v)];
    EXPECT_LT((pixel_of(camera.color, p) - Vec2(u, v)).norm(), 1e-9);
    EXPECT_NEAR(off_plane_mm(p), 0.0, 0.06);
  }
}

TEST(CloudSeenInColor, MovesTheDepthToAColorCameraElsewhere) {
  DepthCamera camera{d405(), d405(), 0.1, Mat4::Identity()};
  camera.T_color_depth.topRightCorner<3, 1>() = Vec3(-9.0, 0.5, 1.0);
  camera.T_color_depth.topLeftCorner<3, 3>() = Eigen::AngleAxisd(0.02, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  camera.color.fx = camera.color.fy = 400.0;
  const OrganizedCloud cloud = cloud_seen_in_color(slanted(camera.depth), camera);
  const Mat4 back = camera.T_color_depth.inverse();
  std::size_t seen = 0;
  for (int v = 0; v < cloud.height; v += 7) {
    for (int u = 0; u < cloud.width; u += 7) {
      if (cloud.is_measured[cloud.index(u, v)] == 0) continue;
      const Vec3& p = cloud.points[cloud.index(u, v)];
      EXPECT_LT((pixel_of(camera.color, p) - Vec2(u, v)).cwiseAbs().maxCoeff(), 0.501);
      EXPECT_NEAR(off_plane_mm((back * p.homogeneous()).head<3>()), 0.0, 0.06);
      ++seen;
    }
  }
  EXPECT_GT(seen, 1000U);
}

TEST(CloudSeenInColor, RefusesSizesThatDoNotFit) {
  const DepthCamera camera{d405(), d405(), 0.1, Mat4::Identity()};
  EXPECT_THROW(static_cast<void>(cloud_seen_in_color(DepthPicture{10, 10, std::vector<std::uint16_t>(100, 5)}, camera)),
               InvalidArgument);
}

std::string frame_problem_of(const OrganizedCloud& cloud) {
  return testing::refusal_of<DataError>([&] { require_camera_frame(cloud, "scan.ply"); });
}

TEST(RequireCameraFrame, TakesWhatACameraSeesAndRefusesAMirrorAndPointsBehind) {
  const DepthCamera camera{d405(), d405(), 0.1, Mat4::Identity()};
  const OrganizedCloud seen = cloud_seen_in_color(slanted(camera.depth), camera);
  EXPECT_EQ(frame_problem_of(seen), "accepted");
  const auto scaled = [&](const Vec3& by) {
    OrganizedCloud cloud = seen;
    for (Vec3& p : cloud.points) p = p.cwiseProduct(by);
    return frame_problem_of(cloud);
  };
  EXPECT_THAT(scaled({-1, 1, 1}), ::testing::HasSubstr("scan.ply: vertices: found mirrored columns and rows"));
  EXPECT_THAT(scaled({1, -1, 1}), ::testing::HasSubstr("mirrored columns and rows"));
  EXPECT_EQ(scaled({-1, -1, 1}), "accepted") << "a camera that was turned upside down";
  EXPECT_THAT(scaled({1, 1, -1}), ::testing::HasSubstr("found a point behind the camera, z -"));
  EXPECT_THAT(scaled({1, -1, -1}), ::testing::HasSubstr("behind the camera")) << "z towards the viewer, as in OpenGL";
}

/// A ring of pixels about the picture's middle.
std::vector<Vec2> ring_px(double radius) {
  std::vector<Vec2> points;
  for (int i = 0; i < 120; ++i) {
    const double a = 2.0 * std::numbers::pi * i / 120.0;
    points.emplace_back(212.0 + radius * std::cos(a), 120.0 + radius * std::sin(a));
  }
  return points;
}

TEST(LiftToSpace, AveragesTheCamerasNoise) {
  const DepthCamera camera{d405(), d405(), 0.1, Mat4::Identity()};
  const OrganizedCloud cloud = cloud_seen_in_color(slanted(camera.depth, 0.3), camera);
  const LiftedLine line = lift_to_space(ring_px(60.0), true, cloud, {}, "depth.png");
  double square = 0.0;
  for (const Vec3& p : line.contour.points) square += std::pow(off_plane_mm(p), 2);
  EXPECT_LT(std::sqrt(square / 120.0), 0.3 / 5.0)
      << "81 points are worth nine times the accuracy of one; a third is lost to rejection";
  EXPECT_EQ(line.bridged_points, 0U);
}

TEST(LiftToSpace, BridgesSmallHolesAndRefusesLargeOnesWithTheirSize) {
  const DepthCamera camera{d405(), d405(), 0.1, Mat4::Identity()};
  const auto with_hole = [&](int half_px) {
    OrganizedCloud cloud = cloud_seen_in_color(slanted(camera.depth), camera);
    for (int v = 120 - half_px; v <= 120 + half_px; ++v) {
      for (int u = 272 - half_px; u <= 272 + half_px; ++u) cloud.is_measured[cloud.index(u, v)] = 0;
    }
    return cloud;
  };
  const LiftSettings settings{.window_px = 4, .max_hole_mm = 6.0};
  const LiftedLine line = lift_to_space(ring_px(60.0), true, with_hole(4), settings, "depth.png");
  EXPECT_GT(line.bridged_points, 0U);
  EXPECT_GT(line.max_hole_mm, 0.5);
  for (const Vec3& p : line.contour.points) EXPECT_NEAR(off_plane_mm(p), 0.0, 0.1);
  EXPECT_THAT(
      testing::refusal_of<DataError>(
          [&] { return lift_to_space(ring_px(60.0), true, with_hole(16), settings, "depth.png"); }),
      ::testing::AllOf(::testing::HasSubstr("a hole in the depth under the mark"), ::testing::HasSubstr("mm wide")));
  for (const double hole_mm : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(
        static_cast<void>(lift_to_space(ring_px(60.0), true, with_hole(4), {.max_hole_mm = hole_mm}, "depth.png")),
        InvalidArgument)
        << hole_mm;
  }
  OrganizedCloud nothing = with_hole(1);
  std::fill(nothing.is_measured.begin(), nothing.is_measured.end(), 0);
  EXPECT_THROW(static_cast<void>(lift_to_space(ring_px(60.0), true, nothing, settings, "depth.png")), DataError);
}

}  // namespace
}  // namespace incise
