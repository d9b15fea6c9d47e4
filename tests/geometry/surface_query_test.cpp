#include "support/directions.hpp"

#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/geometry/surface_query.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace incise {
namespace {

constexpr double kQueryTolerance = 1e-9;

TriMesh block_surface() {
  return boundary_surface(make_block({4, 3, 2}, {4, 3, 2}));
}

Vec3 random_point(Random& random, double reach) {
  return {random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach)};
}

/// Distance to the surface of the box [0, size] from its definition.
double distance_to_box_surface(const Vec3& p, const Vec3& size) {
  const Vec3 outside = (-p).cwiseMax(p - size).cwiseMax(0.0);
  if (outside.norm() > 0.0) return outside.norm();
  return p.cwiseMin(size - p).minCoeff();
}

/// One surface of two, their triangles one after the other.
TriMesh together(TriMesh one, const TriMesh& other, const Vec3& shift) {
  const std::size_t first = one.vertices.size();
  for (const Vec3& p : other.vertices) one.vertices.push_back(p + shift);
  for (const Triangle& t : other.triangles) {
    one.triangles.push_back({VertexId(first + t[0].index()), VertexId(first + t[1].index()), VertexId(first + t[2].index())});
  }
  return one;
}

TEST(SelfCrossing, IsFoundWhereverTwoBodiesPassThroughEachOther) {
  EXPECT_FALSE(find_self_crossing(TriMesh{}));
  const TriMesh block = block_surface();
  EXPECT_FALSE(find_self_crossing(block));
  // In general position, and with edges that meet edges (half a cell along every axis).
  for (const Vec3& shift : {Vec3(0.37, 0.21, 0.43), Vec3(0.5, 0.5, 0.5), Vec3(3.9, 2.9, 1.9), Vec3(-0.5, 1.5, -1.5)}) {
    const TriMesh both = together(block, block, shift);
    const auto crossing = find_self_crossing(both);
    ASSERT_TRUE(crossing) << shift.transpose();
    EXPECT_LT((*crossing)[0].index(), block.triangles.size());
    EXPECT_GE((*crossing)[1].index(), block.triangles.size());
  }
  EXPECT_FALSE(find_self_crossing(together(block, block, Vec3(4.1, 0.3, 0.2)))) << "side by side";
  EXPECT_FALSE(find_self_crossing(together(block, boundary_surface(make_block({1, 1, 1}, {1, 1, 1})), Vec3(1.3, 1.2, 0.4))))
      << "one inside the other";
}

TEST(SelfCrossing, AgreesWithTheCutOfTwoTrianglesByTheirPlanes) {
  // Triangle in z = 0 with corners (0,0), (1,0), (0,1); a needle of a triangle crosses it at (x, y).
  for (const auto& [x, y, is_crossing] : {std::tuple{0.3, 0.3, true}, {0.6, 0.3, true}, {0.6, 0.6, false}, {-0.1, 0.5, false}}) {
    TriMesh surface;
    surface.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {x, y, -1}, {x + 0.01, y, -1}, {x, y, 1}};
    surface.triangles = {{VertexId(0), VertexId(1), VertexId(2)}, {VertexId(3), VertexId(4), VertexId(5)}};
    EXPECT_EQ(find_self_crossing(surface).has_value(), is_crossing) << x << ", " << y;
    for (Vec3& p : surface.vertices) p[2] = p[2] == 1.0 ? 0.0 : p[2];  // the needle's tip only touches
    EXPECT_FALSE(find_self_crossing(surface));
  }
}

TEST(SurfaceQuery, FindsTheNearestPointOfABlock) {
  const SurfaceQuery query(block_surface());
  const SurfacePoint point = query.nearest({1.3, 1.1, 5.0});
  EXPECT_LT((point.position_mm - Vec3(1.3, 1.1, 2.0)).norm(), kQueryTolerance);
  EXPECT_NEAR(point.distance_mm, 3.0, kQueryTolerance);
  EXPECT_LT((point.normal - Vec3::UnitZ()).norm(), kQueryTolerance);
  EXPECT_NEAR(point.barycentric.sum(), 1.0, kQueryTolerance);
}

TEST(SurfaceQuery, AgreesWithTheDistanceToABoxEverywhere) {
  const SurfaceQuery query(block_surface());
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random_point(random, 6.0);
    const SurfacePoint point = query.nearest(p);
    ASSERT_NEAR(point.distance_mm, distance_to_box_surface(p, {4, 3, 2}), kQueryTolerance);
    ASSERT_NEAR((point.position_mm - p).norm(), point.distance_mm, kQueryTolerance);
  }
}

TEST(SurfaceQuery, FirstHitStopsAtTheNearWallAndAtTheLimit) {
  const SurfaceQuery query(block_surface());
  const auto hit = query.first_hit({1.2, 1.3, 10.0}, kDown);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance_mm, 8.0, kQueryTolerance);
  EXPECT_FALSE(query.first_hit({1.2, 1.3, 10.0}, kDown, 7.9));
  EXPECT_FALSE(query.first_hit({1.2, 1.3, 10.0}, -kDown));
  EXPECT_NEAR(query.first_hit({1.2, 1.3, 1.0}, kDown)->distance_mm, 1.0, kQueryTolerance) << "from within";
}

TEST(SurfaceQuery, RaysThroughEdgesAndVerticesHit) {
  const SurfaceQuery query(block_surface());
  // Every vertex, every cell edge and every diagonal of the top lies on this quarter-millimetre raster.
  for (int i = 1; i < 16; ++i) {
    for (int j = 1; j < 12; ++j) {
      const auto hit = query.first_hit({0.25 * i, 0.25 * j, 9.0}, kDown);
      ASSERT_TRUE(hit) << i << " " << j;
      EXPECT_NEAR(hit->distance_mm, 7.0, kQueryTolerance);
    }
  }
  EXPECT_TRUE(query.first_hit({0, 0, 9}, kDown)) << "along the vertical edge of the block";
}

TEST(SurfaceQuery, SlantedRaysNeverSlipThroughSharedEdges) {
  Random random(8);
  TriMesh surface = block_surface();
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, -2, 0.5).normalized()).matrix();
  for (Vec3& p : surface.vertices) p = turn * p + Vec3(100, -200, 300);
  const SurfaceQuery query(surface);
  for (const Triangle& triangle : surface.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& a = vertex(surface.vertices, triangle[i]);
      const Vec3& b = vertex(surface.vertices, triangle[(i + 1) % 3]);
      const Vec3 target = a + random.uniform() * (b - a);
      const Vec3 origin =
          turn * Vec3(2, 1.5, 1) + Vec3(100, -200, 300);  // the block's centre: every ray leaves through the skin
      const auto hit = query.first_hit(origin, (target - origin).normalized());
      ASSERT_TRUE(hit);
      EXPECT_NEAR(hit->distance_mm, (target - origin).norm(), 1e-6);
    }
  }
}

TEST(SeenAt, TakesTheOutermostSurfaceAndTheHeightAboveIt) {
  TriMesh surface = block_surface();
  const TriMesh lid = surface;  // the same block again, 10 mm higher
  const std::size_t n = surface.vertices.size();
  for (const Vec3& p : lid.vertices) surface.vertices.push_back(p + Vec3(0, 0, 10));
  for (const Triangle& t : lid.triangles) {
    surface.triangles.push_back({VertexId{t[0].index() + n}, VertexId{t[1].index() + n}, VertexId{t[2].index() + n}});
  }
  const SurfaceQuery query(surface);
  const auto below = query.seen_at({1.1, 1.2, 0.5}, kDown);
  ASSERT_TRUE(below);
  EXPECT_NEAR(below->position_mm.z(), 12.0, kQueryTolerance);
  EXPECT_NEAR(below->distance_mm, -11.5, kQueryTolerance);
  EXPECT_NEAR(query.seen_at({1.1, 1.2, 40.0}, 3.0 * kDown)->distance_mm, 28.0, kQueryTolerance)
      << "approach of any length";
  EXPECT_NEAR(query.seen_at({1.1, 1.2, 40.0}, -kDown)->position_mm.z(), 0.0, kQueryTolerance) << "seen from below";
  EXPECT_FALSE(query.seen_at({-1.0, 1.2, 0.5}, kDown));
}

TEST(SurfaceQuery, RefusesWhatItCannotSearch) {
  EXPECT_THROW(SurfaceQuery(TriMesh{}), InvalidArgument);
  TriMesh surface = block_surface();
  surface.triangles[3][1] = VertexId{std::size_t{999}};
  EXPECT_THROW(SurfaceQuery{surface}, InvalidArgument);
  const SurfaceQuery query(block_surface());
  EXPECT_THROW((void)query.nearest({0, 0, NAN}), InvalidArgument);
  EXPECT_THROW((void)query.first_hit({0, 0, 9}, {0, 0, -2}), InvalidArgument);
}

TEST(SurfaceQuery, TakesATriangleWithoutAreaAsItsEdges) {
  TriMesh surface;
  surface.vertices = {{0, 0, 0}, {4, 0, 0}, {2, 0, 0}};
  surface.triangles = {{VertexId{std::size_t{0}}, VertexId{std::size_t{1}}, VertexId{std::size_t{2}}}};
  const SurfacePoint point = SurfaceQuery(surface).nearest({3, 4, 0});
  EXPECT_NEAR(point.distance_mm, 4.0, kQueryTolerance);
  EXPECT_TRUE(point.normal.allFinite());
}

TEST(TetLocator, FindsATetThatContainsThePoint) {
  const TetMesh mesh = make_block({4, 3, 2}, {4, 3, 2});
  const TetLocator locator(mesh, mesh.vertices);
  Random random(9);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p(random.uniform(0, 4), random.uniform(0, 3), random.uniform(0, 2));
    const auto found = locator.locate(p);
    ASSERT_TRUE(found);
    EXPECT_LT((position_of(*found, mesh, mesh.vertices) - p).norm(), kQueryTolerance);
    EXPECT_GE(*std::min_element(found->barycentric.begin(), found->barycentric.end()), -1e-9);
  }
  for (const Vec3& p : mesh.vertices) EXPECT_TRUE(locator.locate(p, 0.0)) << "vertices are inside";
}

TEST(TetLocator, ExtrapolatesJustOutsideAndRefusesBeyondTheTolerance) {
  const TetMesh mesh = make_block({4, 3, 2}, {4, 3, 2});
  const TetLocator locator(mesh, mesh.vertices);
  const Vec3 above(1.3, 1.4, 2.3);
  const auto found = locator.locate(above, 0.31);
  ASSERT_TRUE(found);
  EXPECT_LT((position_of(*found, mesh, mesh.vertices) - above).norm(), kQueryTolerance);
  EXPECT_FALSE(locator.locate(above, 0.29));
}

TEST(TetLocator, PointsFollowAnAffineMotionOfTheMeshExactly) {
  const TetMesh mesh = make_block({4, 3, 2}, {4, 3, 2});
  const TetLocator locator(mesh, mesh.vertices);
  Mat3 stretch;
  stretch << 1.2, 0.1, 0.0, 0.05, 0.9, 0.2, 0.0, -0.1, 1.1;
  Points moved = mesh.vertices;
  for (Vec3& p : moved) p = stretch * p + Vec3(1, 2, 3);
  Random random(10);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p(random.uniform(-0.2, 4.2), random.uniform(-0.2, 3.2), random.uniform(-0.2, 2.2));
    const auto found = locator.locate(p);
    ASSERT_TRUE(found);
    EXPECT_LT((position_of(*found, mesh, moved) - stretch * p - Vec3(1, 2, 3)).norm(), kQueryTolerance);
  }
}

TEST(TetLocator, SearchesTheGivenPositionsRatherThanTheMeshVertices) {
  const TetMesh mesh = make_block({4, 3, 2}, {4, 3, 2});
  Points moved = mesh.vertices;
  for (Vec3& p : moved) p.x() += 100.0;
  const TetLocator locator(mesh, moved);
  EXPECT_TRUE(locator.locate({101, 1, 1}));
  EXPECT_FALSE(locator.locate({1, 1, 1}));
  EXPECT_THROW(TetLocator(mesh, std::span<const Vec3>(moved).first(3)), InvalidArgument);
}

}  // namespace
}  // namespace incise
