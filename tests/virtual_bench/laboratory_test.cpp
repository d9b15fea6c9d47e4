#include "virtual_bench/small_bench.hpp"

#include <incise/bench_kit/pictures.hpp>
#include <incise/core/error.hpp>
#include <incise/virtual_bench/readings.hpp>

#include <gtest/gtest.h>

#include <limits>

namespace incise {
namespace {

/// Placed and seen otherwise: the body is the same.
Specimen seen_specimen() {
  Specimen specimen = test::middle_specimen();
  specimen.placement_x_mm = 6.0;
  specimen.placement_turn_deg = -4.0;
  specimen.camera_tilt_deg = 3.0;
  specimen.depth_scale = 1.01;
  specimen.depth_noise_mm = 0.2;
  specimen.hole_percent = 4.0;
  return specimen;
}

const BenchBody& seen_body() {
  static const BenchBody made = [] {
    BenchBody copy = test::middle_body();
    copy.specimen = seen_specimen();
    return copy;
  }();
  return made;
}
const Readings& readings() {
  static const Readings made = [] {
    Monitor monitor;
    return take_readings(seen_body(), true, monitor);
  }();
  return made;
}

// Every test makes the body anew where each runs in a process of its own: few tests, more in each.
void expect_cloud_on_the_stretched_skin() {
  const SurfaceQuery skin(skin_at(seen_body(), seen_body().stretched.positions));
  const Mat4 T_specimen_camera = T_robot_specimen(placement_of(seen_specimen())).inverse() * readings().T_robot_camera;
  ASSERT_GT(readings().cloud_mm.size(), 2000U);
  double squares = 0.0;
  double wrong = 0.0;
  for (const Vec3& p : readings().cloud_mm) {
    const auto at = [&](const Vec3& q) -> Vec3 { return (T_specimen_camera * q.homogeneous()).head<3>(); };
    const double off = skin.nearest(at(p / 1.01)).distance_mm;
    squares += off * off;
    wrong += skin.nearest(at(p)).distance_mm;
  }
  const auto count = static_cast<double>(readings().cloud_mm.size());
  EXPECT_LT(std::sqrt(squares / count), 0.25);
  EXPECT_GT(wrong / count, 1.0) << "the scale's error of 1 % at 200 mm is seen";
}

void expect_force_within_the_load_cells_noise() {
  EXPECT_NE(readings().stretch_force_n, seen_body().stretch_force_n);
  EXPECT_NEAR(readings().stretch_force_n, seen_body().stretch_force_n, 0.2 * seen_body().stretch_force_n);
}

void expect_holes_of_their_share() {
  const FrameShot& frame = readings().frame;
  std::size_t seen = 0;
  std::size_t empty = 0;
  for (std::size_t n = 0; n < frame.depth.counts.size(); ++n) {
    if (frame.is_specimen[n] == 0) continue;
    ++seen;
    if (frame.depth.counts[n] == 0) ++empty;
  }
  const double share = static_cast<double>(empty) / static_cast<double>(seen);
  EXPECT_GT(share, 0.04);
  EXPECT_LT(share, 0.15) << "beside the holes only skin seen at grazing angles";
}

void expect_green_mark_on_the_tumours_edge() {
  FrameShot frame = readings().frame;
  const Mat4 T_camera_specimen = readings().T_robot_camera.inverse() * T_robot_specimen(placement_of(seen_specimen()));
  int green = 0;
  const Contour edge = tumor_edge_at(seen_body(), seen_body().stretched.positions);
  for (const Vec3& p : edge.points) {
    const Vec3 q = (T_camera_specimen * p.homogeneous()).head<3>();
    const int u = static_cast<int>(std::lround(frame.camera.cx + frame.camera.focal_px * q.x() / q.z()));
    const int v = static_cast<int>(std::lround(frame.camera.cy + frame.camera.focal_px * q.y() / q.z()));
    const std::uint8_t* pixel = frame.color.rgb.data() + 3 * (v * frame.color.width + u);
    if (pixel[1] > pixel[0] + 30) ++green;
  }
  EXPECT_GT(green, static_cast<int>(0.95 * static_cast<double>(edge.points.size())));
}

TEST(Readings, FrameAndCloudShowTheStretchedSkinItsMarkAndTheHoles) {
  expect_cloud_on_the_stretched_skin();
  expect_green_mark_on_the_tumours_edge();
  expect_holes_of_their_share();
}

TEST(ShootFrame, RefusesAShareOfHolesOutOfRangeAndATumourWithoutAnEdge) {
  const Mat4 T_camera_specimen = Mat4::Identity();
  SeenTissue nothing;  // in sight
  EXPECT_THROW(static_cast<void>(shoot_frame(nothing, FrameNoise{}, T_camera_specimen)), InvalidArgument);
  nothing.tumor_edge.points = {Vec3(0.0, 0.0, 200.0)};
  for (const double percent : {-1.0, 100.5, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(static_cast<void>(shoot_frame(nothing, FrameNoise{.hole_percent = percent}, T_camera_specimen)),
                 InvalidArgument)
        << percent;
  }
}

TEST(Readings, ForceAndElasticityShowStiffnessWithTheirNoise) {
  expect_force_within_the_load_cells_noise();
  ASSERT_TRUE(readings().elasticity_kpa);
  double sum = 0.0;
  std::size_t count = 0;
  for (const float e : readings().elasticity_kpa->voxels) {
    if (e <= 0.0F) continue;
    sum += e;
    ++count;
  }
  ASSERT_GT(count, 1000U);
  EXPECT_NEAR(sum / static_cast<double>(count), seen_specimen().youngs_modulus_kpa,
              0.15 * seen_specimen().youngs_modulus_kpa);
}

}  // namespace
}  // namespace incise
