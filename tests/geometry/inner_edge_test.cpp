#include "geometry/carved_block.hpp"
#include "support/directions.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/kerf_contours.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace incise {
namespace {

using testing::Corners;
constexpr std::size_t kSectors = 180;

/// A round plug, a trough around it and skin outside: a surface of rings of triangles, with heights added by `height`.
template <class Height>
CutSurface rings(const std::vector<double>& radii, const std::vector<double>& depths, const Height& height) {
  CutSurface surface;
  const auto add_point = [&](double radius, double depth, std::size_t k) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / kSectors;
    const double x = radius * std::cos(angle);
    const double y = radius * std::sin(angle);
    surface.vertices.emplace_back(x, y, height(x, y) - depth);
  };
  surface.vertices.emplace_back(0, 0, height(0, 0));
  for (std::size_t r = 0; r < radii.size(); ++r) {
    for (std::size_t k = 0; k < kSectors; ++k) add_point(radii[r], depths[r], k);
  }
  const auto id = [](std::size_t r, std::size_t k) { return VertexId{1 + r * kSectors + k % kSectors}; };
  const auto add = [&](const Triangle& triangle, bool is_skin) {
    surface.triangles.push_back(triangle);
    surface.is_skin.push_back(is_skin ? 1 : 0);
  };
  for (std::size_t k = 0; k < kSectors; ++k) add({VertexId{std::size_t{0}}, id(0, k), id(0, k + 1)}, true);
  for (std::size_t r = 0; r + 1 < radii.size(); ++r) {
    const bool is_skin = depths[r] == 0.0 && depths[r + 1] == 0.0;
    for (std::size_t k = 0; k < kSectors; ++k) {
      add({id(r, k), id(r + 1, k), id(r + 1, k + 1)}, is_skin);
      add({id(r, k), id(r + 1, k + 1), id(r, k + 1)}, is_skin);
    }
  }
  return surface;
}

double level(double, double) {
  return 0.0;
}

CutSurface trough() {
  return rings({10.0, 10.0, 12.0, 12.0, 18.0}, {0.0, 3.0, 3.0, 0.0, 0.0}, level);
}

/// Lays a strip of skin, `width` wide, across the trough at angle 0.
void add_bridge(CutSurface& surface, double width) {
  const std::size_t n = surface.vertices.size();
  for (const auto& [x, y] : {std::pair{9.5, -0.5}, std::pair{12.5, -0.5}, std::pair{12.5, 0.5}, std::pair{9.5, 0.5}}) {
    surface.vertices.emplace_back(x, y * width, 0.0);
  }
  surface.triangles.push_back({VertexId{n}, VertexId{n + 1}, VertexId{n + 2}});
  surface.triangles.push_back({VertexId{n}, VertexId{n + 2}, VertexId{n + 3}});
  surface.is_skin.insert(surface.is_skin.end(), {1, 1});
}

TEST(InnerEdge, OfARoundPlugIsItsCircle) {
  const std::optional<Contour> edge = inner_edge_contour(trough());
  ASSERT_TRUE(edge);
  EXPECT_TRUE(edge->is_closed);
  EXPECT_GT(signed_area_mm2(*edge, kDown), 0.0);
  for (const Vec3& p : edge->points) {
    EXPECT_NEAR(p.head<2>().norm(), 10.0, 0.05);
    EXPECT_NEAR(p.z(), 0.0, 1e-9);
  }
  EXPECT_NEAR(length_mm(*edge), 2.0 * std::numbers::pi * 10.0, 0.1);
  EXPECT_NEAR((edge->points[1] - edge->points[0]).norm(), 0.25, 0.01);
}

TEST(InnerEdge, LiesOnASlopingCurvedPlug) {
  const auto slope = [](double x, double y) { return 0.5 * x - 0.01 * (x * x + y * y); };
  const std::optional<Contour> edge =
      inner_edge_contour(rings({10.0, 10.0, 12.0, 12.0, 18.0}, {0.0, 3.0, 3.0, 0.0, 0.0}, slope));
  ASSERT_TRUE(edge);
  for (const Vec3& p : edge->points)
    EXPECT_NEAR(p.z(), slope(10.0 * p.x() / p.head<2>().norm(), 10.0 * p.y() / p.head<2>().norm()), 0.08);
}

TEST(InnerEdge, MovesWithTheBodyAndTheView) {
  CutSurface surface = trough();
  const Mat3 turn = Eigen::AngleAxisd(1.3, Vec3(-1, 2, 0.4).normalized()).matrix();
  const Vec3 shift(20, 30, -90);
  for (Vec3& p : surface.vertices) p = turn * p + shift;
  surface.approach = turn * surface.approach;
  surface.inside_mm = shift;
  const std::optional<Contour> edge = inner_edge_contour(surface);
  ASSERT_TRUE(edge);
  for (const Vec3& p : edge->points) EXPECT_NEAR((p - shift).norm(), 10.0, 0.05);
}

TEST(InnerEdge, IsAbsentWhileABridgeHoldsThePlug) {
  CutSurface surface = trough();
  add_bridge(surface, 1.0);
  EXPECT_FALSE(inner_edge_contour(surface));
}

TEST(InnerEdge, OverlooksASliverAndASpeck) {
  CutSurface surface = trough();
  add_bridge(surface, 0.12);
  const std::size_t n = surface.vertices.size();
  for (const Vec3& p : {Vec3(0, 0, 0.1), Vec3(0.2, 0, 0.1), Vec3(0, 0.2, 0.1)})
    surface.vertices.push_back(p + Vec3(2, 2, 0));
  surface.triangles.push_back({VertexId{n}, VertexId{n + 1}, VertexId{n + 2}});
  surface.is_skin.push_back(0);
  const std::optional<Contour> edge = inner_edge_contour(surface);
  ASSERT_TRUE(edge);
  for (const Vec3& p : edge->points) EXPECT_NEAR(p.head<2>().norm(), 10.0, 0.1);
}

TEST(InnerEdge, IsAbsentWhereTheCutRunsOffTheBody) {
  // The skin outside ends at 12 mm on one side and the trough is open there: the plug borders on nothing.
  CutSurface surface = rings({10.0, 10.0, 12.0, 12.0, 18.0}, {0.0, 3.0, 3.0, 0.0, 0.0}, level);
  CutSurface half = surface;
  half.triangles.clear();
  half.is_skin.clear();
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle& triangle = surface.triangles[t];
    const auto is_off = [&](VertexId id) { return vertex(surface.vertices, id).x() > 6.0; };
    if (std::any_of(triangle.begin(), triangle.end(), is_off)) continue;
    half.triangles.push_back(triangle);
    half.is_skin.push_back(surface.is_skin[t]);
  }
  EXPECT_FALSE(inner_edge_contour(half));
}

TEST(InnerEdge, IsAbsentWithoutAKerfOrWithoutSkinInside) {
  EXPECT_FALSE(inner_edge_contour(rings({10.0, 18.0}, {0.0, 0.0}, level)));
  EXPECT_FALSE(inner_edge_contour(CutSurface{}));
  CutSurface surface = trough();
  surface.inside_mm = {11, 0, 0};
  EXPECT_FALSE(inner_edge_contour(surface)) << "in the kerf";
  surface.inside_mm = {15, 0, 0};
  EXPECT_FALSE(inner_edge_contour(surface)) << "outside";
  surface.inside_mm = {1e6, 0, 0};
  EXPECT_FALSE(inner_edge_contour(surface)) << "off the picture";
}

TEST(InnerEdge, OfACarvedBlockIsTheInnerBorderOfItsKerf) {
  const TetMesh mesh = testing::jittered_block({36, 36, 5}, 0.62, 2);
  std::vector<std::uint8_t> is_live;
  for (const Tet& tet : mesh.tets) {
    const Corners c = corners_of(mesh.vertices, tet);
    const double off = ((c[0] + c[1] + c[2] + c[3]) / 4.0).head<2>().norm() - 14.0;
    is_live.push_back(std::abs(off) <= 0.75 && c[0].z() + c[1].z() + c[2].z() + c[3].z() > -16.0 ? 0 : 1);
  }
  std::set<Triangle> original;
  for (const BoundaryFace& face : boundary_faces(mesh)) original.insert(face.corners);
  CutSurface surface{.vertices = mesh.vertices};
  for (const BoundaryFace& face : boundary_faces(mesh, is_live)) {
    surface.triangles.push_back(face.corners);
    surface.is_skin.push_back(original.contains(face.corners) ? 1 : 0);
  }
  const std::optional<Contour> edge = inner_edge_contour(surface);
  ASSERT_TRUE(edge);
  double sum = 0.0;
  for (const Vec3& p : edge->points) sum += p.head<2>().norm();
  EXPECT_NEAR(sum / static_cast<double>(edge->points.size()), 13.25, 0.1);
}

TEST(InnerEdge, OfAKerfIsTheBorderOfWhatItLeavesInside) {
  const TetMesh mesh = testing::jittered_block({36, 36, 5}, 0.62, 2);
  KerfInput kerf{.surface = boundary_surface(mesh)};
  for (const Tet& tet : mesh.tets) {
    const Corners c = corners_of(mesh.vertices, tet);
    if (std::abs(((c[0] + c[1] + c[2] + c[3]) / 4.0).head<2>().norm() - 14.0) <= 0.75) kerf.removed_tets.push_back(c);
  }
  const std::optional<Contour> edge = inner_edge_contour(kerf, {.layer_bottom_mm = 1.0, .min_coverage = 0.5});
  ASSERT_TRUE(edge);
  double radius = 0.0;
  for (const Vec3& p : edge->points) radius += p.head<2>().norm() / static_cast<double>(edge->points.size());
  EXPECT_NEAR(radius, 13.25, 0.1);
  double top = -1e9;
  for (const Vec3& p : kerf.surface.vertices) top = std::max(top, p.z());
  for (const Vec3& p : edge->points) EXPECT_NEAR(p.z(), top, 0.01) << "on the skin";
  EXPECT_GT(signed_area_mm2(*edge, kerf.approach), 0.0);
  kerf.inside_mm = {17, 17, 0};
  EXPECT_FALSE(inner_edge_contour(kerf, {})) << "outside the ring";
  EXPECT_THROW(static_cast<void>(inner_edge_contour(kerf, {.layer_top_mm = 3.0})), InvalidArgument);
  kerf.removed_tets.clear();
  EXPECT_FALSE(inner_edge_contour(kerf, {}));
}

TEST(InnerEdge, RefusesFlagsThatDoNotMatch) {
  CutSurface surface = trough();
  surface.is_skin.pop_back();
  EXPECT_THROW((void)inner_edge_contour(surface), InvalidArgument);
  surface = trough();
  surface.vertices[3].x() = NAN;
  EXPECT_THROW((void)inner_edge_contour(surface), InvalidArgument);
  EXPECT_THROW((void)inner_edge_contour(trough(), {.spacing_mm = 0.0}), InvalidArgument);
}

}  // namespace
}  // namespace incise
