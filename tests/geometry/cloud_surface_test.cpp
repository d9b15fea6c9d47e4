#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/geometry/cloud_surface.hpp>
#include <incise/geometry/surface_query.hpp>

#include <cmath>

namespace incise {
namespace {

double dome(double x, double y) { return 10.0 - (x * x + y * y) / 80.0 + 0.1 * x; }

/// A dome over 40 x 40 mm, points about 0.5 mm apart, seen from above; with a hole where asked.
Points measured_dome(double noise_mm, double hole_radius_mm = 0.0) {
  Random random(5);
  Points points;
  for (int i = 0; i < 80 * 80; ++i) {
    const double x = -20.0 + 0.5 * (i % 80) + 0.4 * random.uniform(), y = -20.0 + 0.5 * (i / 80) + 0.4 * random.uniform();
    if (std::hypot(x - 5.0, y) < hole_radius_mm) continue;
    points.emplace_back(x, y, dome(x, y) + noise_mm * random.normal());
  }
  return points;
}

TEST(CloudSurface, FollowsACurvedSurfaceAndItsNormal) {
  const Points points = measured_dome(0.0);
  const CloudSurface surface(points, -Vec3::UnitZ());
  for (const Vec2& place : {Vec2(0, 0), Vec2(7.3, -4.1), Vec2(-12, 9)}) {
    const auto found = surface.at(place);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->position_mm.z(), dome(place.x(), place.y()), 1e-4);
    const Vec3 normal = Vec3(place.x() / 40.0 - 0.1, place.y() / 40.0, 1.0).normalized();
    EXPECT_LT((found->normal - normal).norm(), 1e-3);
    EXPECT_LT(found->gap_mm, 0.6);
    EXPECT_FALSE(found->is_extrapolated);
  }
}

TEST(CloudSurface, AveragesNoise) {
  const Points points = measured_dome(0.3);
  const CloudSurface surface(points, -Vec3::UnitZ());
  double square = 0.0;
  int count = 0;
  for (double x = -14.0; x <= 14.0; x += 2.0) {
    for (double y = -14.0; y <= 14.0; y += 2.0, ++count) square += std::pow(surface.at({x, y})->position_mm.z() - dome(x, y), 2);
  }
  EXPECT_LT(std::sqrt(square / count), 0.15);
}

TEST(CloudSurface, TurnsWithItsView) {
  const Mat3 R = Eigen::AngleAxisd(0.7, Vec3(1, 2, -0.5).normalized()).toRotationMatrix();
  Points points = measured_dome(0.0);
  for (Vec3& p : points) p = R * p;
  const CloudSurface surface(points, R * -Vec3::UnitZ());
  const Vec3 truth = R * Vec3(3.0, -2.0, dome(3.0, -2.0));
  const auto found = surface.at(surface.frame().to_view(truth).head<2>());
  ASSERT_TRUE(found);
  EXPECT_LT((found->position_mm - truth).norm(), 1e-3);
}

TEST(CloudSurface, TellsGapsAndTheRim) {
  const Points points = measured_dome(0.0, 3.0);
  const CloudSurface surface(points, -Vec3::UnitZ());
  const auto in_hole = surface.at({5.0, 0.0});
  ASSERT_TRUE(in_hole);
  EXPECT_NEAR(in_hole->gap_mm, 3.0, 0.3);
  EXPECT_FALSE(in_hole->is_extrapolated) << "points lie all round";
  EXPECT_NEAR(in_hole->position_mm.z(), dome(5.0, 0.0), 0.05);
  EXPECT_TRUE(surface.at({21.5, 0.0})->is_extrapolated);
  EXPECT_FALSE(surface.at({40.0, 0.0}));
}

TEST(CloudSurface, BodyIsClosedAndHasTheCloudOnTop) {
  const Points points = measured_dome(0.0);
  const CloudSurface surface(points, -Vec3::UnitZ());
  const TriMesh body = surface.body({-10, -8}, {10, 8}, 0.5, 2.0, 30.0);
  EXPECT_NEAR(enclosed_volume_mm3(body), 20.0 * 16.0 * 30.0, 1.0);
  const SurfaceQuery query(body);
  const auto seen = query.seen_at(Vec3(1.0, 2.0, 50.0), -Vec3::UnitZ());
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->position_mm.z(), dome(1.0, 2.0), 0.01);
  EXPECT_GT(seen->normal.z(), 0.9);
  EXPECT_TRUE(surface.body({60, 60}, {70, 70}, 0.5, 2.0, 30.0).triangles.empty());
}

TEST(CloudSurface, RefusesCloudsThatAreNone) {
  EXPECT_THROW(CloudSurface(Points(5, Vec3::Zero()), -Vec3::UnitZ()), InvalidArgument);
  Points bad = measured_dome(0.0);
  bad[7].x() = std::nan("");
  EXPECT_THROW(CloudSurface(bad, -Vec3::UnitZ()), InvalidArgument);
  Points metres = measured_dome(0.0);
  metres.emplace_back(1e7, 1e7, 0.0);
  EXPECT_THROW(CloudSurface(metres, -Vec3::UnitZ()), InvalidArgument);
  // All in one place, or on one line: nothing to be seen of a surface, but no failure either.
  const Points same(20, Vec3(1, 2, 3));
  EXPECT_TRUE(CloudSurface(same, -Vec3::UnitZ()).at({1, 2})->is_extrapolated);
}

}  // namespace
}  // namespace incise
