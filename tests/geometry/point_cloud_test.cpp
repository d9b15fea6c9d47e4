#include <incise/core/error.hpp>
#include <incise/geometry/neighbours.hpp>
#include <incise/geometry/point_cloud.hpp>
#include <incise/geometry/visible_surface.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

Points random_points(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  Points points;
  for (std::size_t i = 0; i < count; ++i)
    points.emplace_back(random.uniform(0, 10), random.uniform(0, 10), random.uniform(0, 10));
  return points;
}

TEST(NeighbourSearch, AgreesWithLookingAtEveryPoint) {
  const Points points = random_points(300, 1);
  const NeighbourSearch search(points);
  for (const Vec3& p : random_points(20, 2)) {
    std::vector<std::pair<double, std::size_t>> all;
    for (std::size_t i = 0; i < points.size(); ++i) all.emplace_back((points[i] - p).squaredNorm(), i);
    std::sort(all.begin(), all.end());
    const std::vector<Neighbour> near = search.nearest(p, 5);
    ASSERT_EQ(near.size(), 5u);
    for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(near[k].index, all[k].second);
    EXPECT_EQ(search.nearest(p).index, all[0].second);
    const auto within = static_cast<std::size_t>(
        std::count_if(all.begin(), all.end(), [](const auto& item) { return item.first < 4.0; }));
    EXPECT_EQ(search.within(p, 2.0).size(), within);
  }
}

TEST(NeighbourSearch, RefusesNoPointsAndNumbersThatAreNone) {
  EXPECT_THROW(NeighbourSearch(Points{}), InvalidArgument);
  EXPECT_THROW(NeighbourSearch(Points{Vec3(0.0, std::nan(""), 0.0)}), InvalidArgument);
}

TEST(Downsample, KeepsTheMeanOfEachCube) {
  const PointCloud thinned = downsample({{Vec3(0, 0, 0), Vec3(0.4, 0.2, 0), Vec3(5, 0, 0)}, {}}, 1.0);
  ASSERT_EQ(thinned.points.size(), 2u);
  EXPECT_LT((thinned.points[0] - Vec3(0.2, 0.1, 0.0)).norm(), 1e-12);
  EXPECT_EQ(thinned.points[1], Vec3(5, 0, 0));
}

PointCloud grid(double height, int n = 21) {
  PointCloud cloud;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) cloud.points.emplace_back(i, j, height);
  }
  return cloud;
}

TEST(WithNormals, OfAFlatSheetLookAgainstTheSight) {
  Workers workers(2);
  for (const Vec3& n : with_normals(grid(3.0), Vec3(0.2, 0, -1), 9, workers).normals) EXPECT_NEAR(n.z(), 1.0, 1e-9);
}

TEST(WithoutOutliers, DropsTheLonelyPointOnly) {
  Workers workers(1);
  PointCloud cloud = grid(0.0);
  cloud.points.emplace_back(10.0, 10.0, 30.0);
  const PointCloud cleaned = without_outliers(cloud, 8, 4.0, workers);
  EXPECT_EQ(cleaned.points.size(), cloud.points.size() - 1);
  for (const Vec3& p : cleaned.points) EXPECT_EQ(p.z(), 0.0);
}

TEST(FindPlane, FindsTheLargestOne) {
  PointCloud cloud = grid(2.0);
  for (int i = 0; i < 60; ++i) cloud.points.emplace_back(1.0, i % 8, 3.0 + 0.3 * i);
  Random random(1);
  const auto plane = find_plane(cloud.points, 0.1, 200, random);
  ASSERT_TRUE(plane);
  EXPECT_NEAR(std::abs(plane->normal.z()), 1.0, 1e-9);
  EXPECT_EQ(plane->inliers.size(), 441u);
  EXPECT_FALSE(find_plane(Points{Vec3::Zero(), Vec3::UnitX()}, 0.1, 10, random));
}

TEST(CleanCloud, TakesAwayTheTableAndWhatLiesBeneath) {
  PointCloud cloud = grid(0.0, 41);
  for (int j = 12; j < 28; ++j) {
    for (int i = 12; i < 28; ++i) cloud.points.emplace_back(i, j, 5.0 + 0.3 * (i % 3));
  }
  cloud.points.emplace_back(20.0, 20.0, -6.0);
  CleaningSettings settings{.planes = 1, .plane_tolerance_mm = 0.5, .outlier_neighbours = 0};
  Random random(1);
  Workers workers(1);
  const CleanedCloud cleaned = clean_cloud(cloud, settings, random, workers);
  EXPECT_EQ(cleaned.cloud.points.size(), 256u);
  EXPECT_EQ(cleaned.beneath_planes, 1u);
  ASSERT_EQ(cleaned.planes.size(), 1u);
  EXPECT_GT(cleaned.planes[0].normal.z(), 0.99);
  settings.voxel_mm = -1.0;
  EXPECT_THROW(static_cast<void>(clean_cloud(cloud, settings, random, workers)), InvalidArgument);
}

TEST(VisibleSurface, OfABlockIsItsTop) {
  Workers workers(2);
  const VisibleSurface seen =
      visible_surface(boundary_surface(make_block({40, 30, 10}, {4, 3, 1})), {.spacing_mm = 1.0}, workers);
  EXPECT_NEAR(seen.area_mm2, 1200.0, 25.0);
  ASSERT_GT(seen.cloud.points.size(), 600u);
  for (std::size_t i = 0; i < seen.cloud.points.size(); ++i) {
    EXPECT_DOUBLE_EQ(seen.cloud.points[i].z(), 10.0);
    EXPECT_GT(seen.cloud.normals[i].z(), 0.5);
  }
  EXPECT_GE(spacing_mm(seen.cloud.points), 1.0);
}

/// A grid of triangles over [0, 40] x [0, 40] mm with the heights of a function.
template <typename HeightAt>
TriMesh triangles_over(double pitch_mm, const HeightAt& height_at) {
  const auto side = static_cast<std::size_t>(40.0 / pitch_mm) + 1;
  TriMesh mesh;
  for (std::size_t j = 0; j < side; ++j) {
    for (std::size_t i = 0; i < side; ++i) {
      const double x = pitch_mm * static_cast<double>(i), y = pitch_mm * static_cast<double>(j);
      mesh.vertices.emplace_back(x, y, height_at(x, y));
    }
  }
  for (std::size_t j = 0; j + 1 < side; ++j) {
    for (std::size_t i = 0; i + 1 < side; ++i) {
      const VertexId a(i + side * j), b(i + 1 + side * j), c(i + 1 + side * (j + 1)), d(i + side * (j + 1));
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

TEST(VisibleSurface, LiesOnTheCurvedSurfaceThatTrianglesStandFor) {
  Workers workers(1);
  constexpr double kRadius = 30.0, kPitch = 4.0;
  const Vec3 middle(20.0, 20.0, 0.0);
  const TriMesh dome = triangles_over(kPitch, [&](double x, double y) {
    return std::sqrt(kRadius * kRadius - std::pow(x - middle.x(), 2) - std::pow(y - middle.y(), 2));
  });
  const VisibleSurface seen = visible_surface(dome, {.spacing_mm = 1.0}, workers);
  double worst = 0.0, worst_normal = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < seen.cloud.points.size(); ++i) {
    const Vec3 arm = seen.cloud.points[i] - middle;
    if (arm.head<2>().cwiseAbs().maxCoeff() > 12.0) continue;  // the border's normals are one-sided
    ++count;
    worst = std::max(worst, std::abs(arm.norm() - kRadius));
    worst_normal = std::max(worst_normal, (seen.cloud.normals[i] - arm / kRadius).norm());
  }
  ASSERT_GT(count, 300u);
  // A chord of 4 sqrt(2) mm is 0.13 mm below the sphere.
  EXPECT_LT(worst, 0.02);
  EXPECT_LT(worst_normal, 0.03);
}

TEST(VisibleSurface, OfHollowsIsSeenToo) {
  // The curved surface lies beneath the triangles of a hollow: they do not hide it.
  Workers workers(1);
  const TriMesh hollow =
      triangles_over(4.0, [](double x, double y) { return 0.01 * (std::pow(x - 20.0, 2) + std::pow(y - 20.0, 2)); });
  const VisibleSurface seen = visible_surface(hollow, {.spacing_mm = 1.0}, workers);
  double least = 0.0;
  for (const Vec3& p : seen.cloud.points) {
    if ((p.head<2>().array() - 20.0).abs().maxCoeff() > 12.0) continue;
    least = std::min(least, p.z() - 0.01 * (p.head<2>().array() - 20.0).square().sum());
  }
  EXPECT_GT(seen.area_mm2, 1600.0);
  EXPECT_GT(least, -0.005);
}

TEST(VisibleSurface, KeepsCreases) {
  // A roof of two planes, 45 degrees steep: nothing is rounded.
  Workers workers(1);
  const TriMesh roof = triangles_over(4.0, [](double x, double) { return 20.0 - std::abs(x - 20.0); });
  for (const Vec3& p : visible_surface(roof, {.spacing_mm = 1.0}, workers).cloud.points)
    EXPECT_NEAR(p.z(), 20.0 - std::abs(p.x() - 20.0), 1e-9);
}

TEST(VisibleSurface, LeavesOutWhatIsHidden) {
  // A small roof above a large floor, both facing up: the floor is not seen beneath the roof.
  TriMesh mesh;
  const auto add_square = [&mesh](double low, double high, double z) {
    const auto first = mesh.vertices.size();
    for (const auto& [x, y] :
         {std::pair(low, low), std::pair(high, low), std::pair(high, high), std::pair(low, high)}) {
      mesh.vertices.emplace_back(x, y, z);
    }
    mesh.triangles.push_back({VertexId(first), VertexId(first + 1), VertexId(first + 2)});
    mesh.triangles.push_back({VertexId(first), VertexId(first + 2), VertexId(first + 3)});
  };
  add_square(0.0, 30.0, 0.0);
  add_square(10.0, 20.0, 5.0);
  Workers workers(1);
  const VisibleSurface seen = visible_surface(mesh, {.spacing_mm = 1.0}, workers);
  EXPECT_NEAR(seen.area_mm2, 900.0, 20.0);
  for (const Vec3& p : seen.cloud.points) {
    const bool is_beneath = p.z() < 1.0 && p.x() > 10.01 && p.x() < 19.99 && p.y() > 10.01 && p.y() < 19.99;
    EXPECT_FALSE(is_beneath) << p.transpose();
  }
  // From below nothing of it faces the observer.
  EXPECT_TRUE(visible_surface(mesh, {.approach = Vec3::UnitZ()}, workers).cloud.points.empty());
}

TEST(SampledArea, OfAGridIsAboutItsArea) {
  const double area = sampled_area_mm2(grid(0.0, 41).points);
  EXPECT_GT(area, 1681.0);
  EXPECT_LT(area, 1.2 * 1681.0);  // a border of 164 points is much for so small a sheet
}

}  // namespace
}  // namespace incise
