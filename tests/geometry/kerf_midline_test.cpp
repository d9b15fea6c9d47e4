#include "geometry/carved_block.hpp"
#include "support/directions.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/kerf_contours.hpp>
#include <incise/geometry/surface_query.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace incise {
namespace {

using testing::Corners;
constexpr double kReach = 0.75;  // electrode radius and contact range

const TetMesh& block() {
  static const TetMesh mesh = testing::jittered_block({36, 36, 5}, 0.62, 1);
  return mesh;
}

template <class Goes>
KerfInput carved(const TetMesh& mesh, const Goes& goes) {
  KerfInput input{.surface = boundary_surface(mesh)};
  for (const Tet& tet : mesh.tets) {
    const Corners corners = corners_of(mesh.vertices, tet);
    if (goes(corners)) input.removed_tets.push_back(corners);
  }
  return input;
}

double from_circle(const Vec3& p, double radius) {
  return p.head<2>().norm() - radius;
}

bool in_ring(const Corners& corners, double radius) {
  return testing::comes_within(corners, kReach, [&](const Vec3& p) { return from_circle(p, radius); });
}

struct Deviation {
  double mean_abs = 0.0;
  double mean = 0.0;
  double max = 0.0;
};

Deviation deviation_from_circle(const Contour& contour, double radius) {
  Deviation result;
  const double share = 1.0 / static_cast<double>(contour.points.size());
  for (const Vec3& p : contour.points) {
    const double d = from_circle(p, radius);
    result.mean_abs += share * std::abs(d);
    result.mean += share * d;
    result.max = std::max(result.max, std::abs(d));
  }
  return result;
}

TEST(Midline, OfAJitteredRingFollowsTheCircleWithoutBias) {
  const KerfMidline result = midline_contour(carved(block(), [](const Corners& c) { return in_ring(c, 15.0); }));
  ASSERT_TRUE(result.contour);
  EXPECT_TRUE(result.is_closed);
  const Deviation deviation = deviation_from_circle(*result.contour, 15.0);
  EXPECT_LT(deviation.mean_abs, 0.06);
  EXPECT_LT(std::abs(deviation.mean), 0.02);
  EXPECT_LT(deviation.max, 0.25);
  EXPECT_EQ(result.gap_deg, 0.0);
  EXPECT_EQ(result.gap_mm, 0.0);
}

TEST(Midline, OfCentroidsWithinTheBandHasTheBandsWidth) {
  const KerfMidline result = midline_contour(carved(block(), [](const Corners& c) {
    return std::abs(from_circle((c[0] + c[1] + c[2] + c[3]) / 4.0, 15.0)) <= kReach;
  }));
  ASSERT_TRUE(result.contour);
  EXPECT_NEAR(result.mean_width_mm, 2.0 * kReach, 0.1);
  EXPECT_LT(deviation_from_circle(*result.contour, 15.0).mean_abs, 0.03);
}

TEST(Midline, LiesOnTheSurfaceEvenlySpacedAndCounterClockwise) {
  const KerfInput input = carved(block(), [](const Corners& c) { return in_ring(c, 10.0); });
  const KerfMidline result = midline_contour(input);
  ASSERT_TRUE(result.contour);
  EXPECT_GT(signed_area_mm2(*result.contour, kDown), 0.0);
  const Points& points = result.contour->points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(points[i].z(), 0.0, 1e-9);
    EXPECT_NEAR((points[(i + 1) % points.size()] - points[i]).norm(), 0.25, 0.01);
  }
}

TEST(Midline, MovesWithTheBodyAndTheView) {
  KerfInput input = carved(block(), [](const Corners& c) { return in_ring(c, 8.0); });
  const Contour before = *midline_contour(input).contour;
  const Mat3 turn = Eigen::AngleAxisd(2.1, Vec3(1, 2, -0.5).normalized()).matrix();
  const Vec3 shift(30, -70, 110);
  for (Corners& corners : input.removed_tets) {
    for (Vec3& p : corners) p = turn * p + shift;
  }
  for (Vec3& p : input.surface.vertices) p = turn * p + shift;
  input.approach = turn * input.approach;
  input.inside_mm = shift;
  const KerfMidline result = midline_contour(input);
  ASSERT_TRUE(result.contour);
  // The pixels lie otherwise on the kerf: their grain remains.
  for (const Vec3& p : result.contour->points)
    EXPECT_LT(nearest_on(before, turn.transpose() * (p - shift)).distance_mm, 0.06);
}

TEST(Midline, FollowsACurvedSurface) {
  TetMesh mesh = block();
  for (Vec3& p : mesh.vertices) p.z() += 2.0 - 0.01 * p.head<2>().squaredNorm() + 0.1 * p.x();
  const KerfMidline result = midline_contour(carved(mesh, [](const Corners& c) { return in_ring(c, 10.0); }));
  ASSERT_TRUE(result.contour);
  for (const Vec3& p : result.contour->points)
    EXPECT_NEAR(p.z(), 2.0 - 0.01 * p.head<2>().squaredNorm() + 0.1 * p.x(), 0.02);
  EXPECT_LT(deviation_from_circle(*result.contour, 10.0).mean_abs, 0.06);
}

TEST(Midline, OfAnOpenRingIsAbsentAndTheGapIsMeasured) {
  // 20 degrees at 12 mm are 4.2 mm, less the corners of single tets that stand out of both ends (a cell is 0.62 mm).
  const double half = std::numbers::pi / 18.0;
  const KerfMidline result = midline_contour(carved(block(),
                                                    [&](const Corners& c) {
                                                      const Vec3 centre = (c[0] + c[1] + c[2] + c[3]) / 4.0;
                                                      return std::abs(from_circle(centre, 12.0)) <= kReach &&
                                                             std::abs(std::atan2(centre.y(), centre.x())) > half;
                                                    }),
                                             {.min_coverage = 0.5});
  EXPECT_FALSE(result.contour);
  EXPECT_FALSE(result.is_closed);
  EXPECT_NEAR(result.gap_deg, 20.0, 3.0);
  EXPECT_LT(result.gap_mm, 4.2);
  EXPECT_GT(result.gap_mm, 4.2 - 0.62);
  ASSERT_TRUE(result.gap_place_mm);
  EXPECT_LT((*result.gap_place_mm - Vec3(12, 0, result.gap_place_mm->z())).norm(), 1.5);
  EXPECT_GT(result.area_mm2, 80.0);
}

TEST(Midline, SeesTheBridgeBetweenEndsThatOverlapSideBySide) {
  // A spiral that has drifted 3 mm inwards after one turn and goes on for 30 degrees: kerf in every direction, but no
  // ring. Of the 3 mm the kerf's width takes 1.5, and single tets up to a cell.
  const auto goes = [&](const Corners& c) {
    const Vec3 p = (c[0] + c[1] + c[2] + c[3]) / 4.0;
    const double angle = std::atan2(p.y(), p.x()) + (p.y() < 0.0 ? 2.0 * std::numbers::pi : 0.0);
    const auto near_lap = [&](double turn) { return std::abs(p.head<2>().norm() - (14.0 - 3.0 * turn)) <= kReach; };
    const double turn = angle / (2.0 * std::numbers::pi);
    return near_lap(turn) || (turn < 30.0 / 360.0 && near_lap(1.0 + turn));
  };
  const KerfMidline result = midline_contour(carved(block(), goes), {.min_coverage = 0.5});
  EXPECT_FALSE(result.contour);
  EXPECT_EQ(result.gap_deg, 0.0);
  EXPECT_LT(result.gap_mm, 1.5);
  EXPECT_GT(result.gap_mm, 1.5 - 0.62);
  ASSERT_TRUE(result.gap_place_mm);
  const double angle_deg = std::atan2(result.gap_place_mm->y(), result.gap_place_mm->x()) * 180.0 / std::numbers::pi;
  EXPECT_GT(angle_deg, -5.0);
  EXPECT_LT(angle_deg, 35.0) << "between the laps";
}

TEST(Midline, OverlooksAnIslandWithinTheKerf) {
  const KerfMidline result = midline_contour(carved(block(), [](const Corners& c) {
    const Vec3 centre = (c[0] + c[1] + c[2] + c[3]) / 4.0;
    return std::abs(from_circle(centre, 12.0)) <= 1.2 && (centre - Vec3(0, 12, centre.z())).norm() > 0.5;
  }));
  ASSERT_TRUE(result.contour);
  EXPECT_LT(deviation_from_circle(*result.contour, 12.0).max, 0.15);
}

TEST(Midline, CountsOnlyWhatIsGoneWithinTheLayer) {
  KerfInput input = carved(block(), [](const Corners& c) {
    return in_ring(c, 12.0) && (c[0].z() + c[1].z() + c[2].z() + c[3].z()) / 4.0 < -3.2;
  });
  EXPECT_FALSE(midline_contour(input).contour) << "a tunnel under the skin is no incision";
  EXPECT_TRUE(midline_contour(input, {.layer_top_mm = 3.2, .layer_bottom_mm = 5.0}).contour);
}

TEST(Midline, RequiresTheRingToEncloseThePoint) {
  KerfInput input = carved(block(), [](const Corners& c) { return in_ring(c, 6.0); });
  input.inside_mm = {15, 0, 0};
  EXPECT_FALSE(midline_contour(input).contour);
  input.inside_mm = {500, 0, 0};
  EXPECT_FALSE(midline_contour(input).contour);
}

TEST(Midline, OfAnOpenCutRunsFromEndToEnd) {
  // A straight cut 20 mm long at 30 degrees, with the round ends that a needle leaves.
  const Vec2 along(std::cos(std::numbers::pi / 6.0), std::sin(std::numbers::pi / 6.0));
  KerfInput input = carved(block(), [&](const Corners& c) {
    const Vec2 centre = ((c[0] + c[1] + c[2] + c[3]) / 4.0).head<2>();
    const double s = std::clamp(centre.dot(along), -10.0, 10.0);
    return (centre - s * along).norm() <= kReach;
  });
  input.is_closed = false;
  const KerfMidline result = midline_contour(input);
  ASSERT_TRUE(result.contour);
  EXPECT_FALSE(result.is_closed);
  EXPECT_FALSE(result.contour->is_closed);
  EXPECT_NEAR(length_mm(*result.contour), 20.0 + 2.0 * kReach, 0.7);
  double sum = 0.0;
  for (const Vec3& p : result.contour->points) {
    const double off = std::abs(along.x() * p.y() - along.y() * p.x());
    sum += off;
    EXPECT_LT(off, 0.4);
  }
  EXPECT_LT(sum / static_cast<double>(result.contour->points.size()), 0.08);
}

TEST(Midline, OfNoKerfIsAbsent) {
  KerfInput input{.surface = boundary_surface(block())};
  const KerfMidline result = midline_contour(input);
  EXPECT_FALSE(result.contour);
  EXPECT_EQ(result.gap_deg, 360.0);
}

TEST(Midline, RefusesSettingsAndPointsThatMakeNoSense) {
  KerfInput input{.surface = boundary_surface(block())};
  EXPECT_THROW((void)midline_contour(input, {.layer_top_mm = 3.0}), InvalidArgument);
  EXPECT_THROW((void)midline_contour(input, {.min_coverage = 0.0}), InvalidArgument);
  EXPECT_THROW((void)midline_contour(input, {.spacing_mm = -1.0}), InvalidArgument);
  input.removed_tets.push_back({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, NAN)});
  EXPECT_THROW((void)midline_contour(input), InvalidArgument);
}

}  // namespace
}  // namespace incise
