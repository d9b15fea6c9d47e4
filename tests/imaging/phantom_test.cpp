#include "support/monitors.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/imaging/phantom.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

namespace incise {
namespace {

// Coarse voxels keep the many-seed tests quick; nothing but the CT depends on them.
PhantomSettings coarse(std::uint64_t seed) {
  PhantomSettings settings{.seed = seed, .spacing_mm = Vec3::Constant(3.0)};
  return settings;
}

Phantom phantom_of(const PhantomSettings& settings) {
  Monitor monitor;
  return make_phantom(settings, monitor);
}

TEST(Phantom, IsTheSameBitForBitForTheSameSeed) {
  const Phantom a = phantom_of(coarse(11));
  const Phantom b = phantom_of(coarse(11));
  EXPECT_EQ(a.ct.voxels, b.ct.voxels);
  EXPECT_EQ(a.ct.grid.origin_mm, b.ct.grid.origin_mm);
  EXPECT_EQ(a.tumor_edge.points, b.tumor_edge.points);
  EXPECT_NE(a.ct.voxels, phantom_of(coarse(12)).ct.voxels);
}

TEST(Phantom, KeepsShapeAndTumorWhenTheScannerChanges) {
  PhantomSettings other = coarse(11);
  other.spacing_mm = Vec3(1.5, 1.5, 3.0);
  other.noise_hu = 40.0;
  const Phantom a = phantom_of(coarse(11));
  const Phantom b = phantom_of(other);
  EXPECT_EQ(a.true_volume_mm3, b.true_volume_mm3);
  EXPECT_EQ(a.tumor_edge.points, b.tumor_edge.points);
}

TEST(Phantom, ShowsMuscleBoardAndAirWithTheHuAndNoiseThatWereAskedFor) {
  PhantomSettings settings = coarse(2);
  settings.texture_hu = 0.0;
  settings.spacing_mm = Vec3::Constant(1.2);
  const Phantom phantom = phantom_of(settings);
  struct Sum {
    double n = 0, mean = 0, square = 0;
    void add(double v) { n += 1, mean += v, square += v * v; }
    [[nodiscard]] double average() const { return mean / n; }
    [[nodiscard]] double sd() const { return std::sqrt(square / n - average() * average()); }
  } muscle, board;
  const VolumeGrid& grid = phantom.ct.grid;
  for (int k = 0; k < grid.size[2]; ++k)
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i < grid.size[0]; ++i) {
        const Vec3 p = grid.world_from_index(Vec3(i, j, k));
        const auto span = span_at(phantom.shape, p.x(), p.y());
        if (span && p.z() > span->low_mm + 5.0 && p.z() < span->high_mm - 5.0 && std::abs(p.x()) < 15.0)
          muscle.add(phantom.ct.at(i, j, k));
        if (std::abs(p.z() + 4.0) < 1.0 && std::abs(p.x()) < 20.0 && std::abs(p.y()) < 40.0)
          board.add(phantom.ct.at(i, j, k));
      }
  ASSERT_GT(muscle.n, 1000.0);
  ASSERT_GT(board.n, 300.0);
  EXPECT_NEAR(muscle.average(), 55.0, 2.0);
  EXPECT_NEAR(muscle.sd(), 15.0, 1.5);
  EXPECT_NEAR(board.average(), -100.0, 3.0);
  EXPECT_LT(phantom.ct.at(0, 0, grid.size[2] - 1), -920);
}

TEST(Phantom, MarksWhatLiesOutsideARoundFieldOfViewAsPadding) {
  PhantomSettings settings = coarse(2);
  settings.field_of_view_mm = 180.0;
  const Phantom phantom = phantom_of(settings);
  EXPECT_EQ(phantom.ct.grid.size[0], phantom.ct.grid.size[1]);
  EXPECT_EQ(phantom.ct.at(0, 0, 5), kAirHu);
  EXPECT_EQ(phantom.ct.at(1, 1, 10), kAirHu);
}

TEST(Phantom, GivesEverySpecimenRoomForARingOf30MmWith4MmToSpareAndTissueBelow) {
  for (std::uint64_t seed = 0; seed <= 30; ++seed) {
    const Phantom phantom = phantom_of(coarse(seed));
    EXPECT_GE(phantom.tissue_below_tumor_mm, 25.0) << "seed " << seed;
    const Vec3& c = phantom.tumor_center_mm;
    for (double angle = 0.0; angle < 6.28; angle += 0.1) {
      const double r = 15.0 + 4.0;
      const auto span = span_at(phantom.shape, c.x() + r * std::cos(angle), c.y() + r * std::sin(angle));
      ASSERT_TRUE(span.has_value()) << "seed " << seed;
      EXPECT_LT(c.z() - span->high_mm, 10.0) << "seed " << seed << " angle " << angle;
    }
  }
}

TEST(Phantom, DrawsAnIrregularEdgeNear20MmAcrossOnTheRestSurface) {
  for (std::uint64_t seed = 0; seed <= 30; ++seed) {
    const Phantom phantom = phantom_of(coarse(seed));
    const Contour& edge = phantom.tumor_edge;
    EXPECT_EQ(edge.points.size(), 120U);
    EXPECT_TRUE(edge.is_closed);
    double least = 1e9;
    double greatest = 0.0;
    for (const Vec3& p : edge.points) {
      EXPECT_NEAR(p.z(), span_at(phantom.shape, p.x(), p.y())->high_mm, 1e-12);
      const double r = (p - phantom.tumor_center_mm).head<2>().norm();
      least = std::min(least, r);
      greatest = std::max(greatest, r);
    }
    EXPECT_GT(least, 9.0 - 1e-9);  // 10 mm less 10 %
    EXPECT_LT(greatest, 11.0 + 1e-9);
    EXPECT_GT(greatest - least, 0.5) << "seed " << seed;
    EXPECT_NEAR(2.0 * std::sqrt(signed_area_mm2(edge, -Vec3::UnitZ()) / 3.14159265), 20.0, 0.2);
    EXPECT_FALSE(crosses_itself_in_view(edge, -Vec3::UnitZ()));
  }
}

TEST(Phantom, ClosesTheTumorBeneathItsEdge) {
  const Phantom phantom = phantom_of(coarse(6));
  // Every edge of a closed, consistently oriented surface is used once in each direction.
  std::map<std::pair<int, int>, int> uses;
  for (const Triangle& t : phantom.tumor.triangles)
    for (std::size_t e = 0; e < 3; ++e) ++uses[{t[e].value, t[(e + 1) % 3].value}];
  for (const auto& [edge, count] : uses) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(uses.contains({edge.second, edge.first}));
  }
  // Half an ellipsoid of radii 10, 10 and depth 4: 2/3 π 10² 4.
  EXPECT_NEAR(enclosed_volume_mm3(phantom.tumor), 838.0, 40.0);
}

TEST(Phantom, SaysWhereTheSpecimenEndsAndWhatItRestsOn) {
  const Phantom phantom = phantom_of(coarse(6));
  EXPECT_EQ(phantom.platform_z_mm, 0.0);
  EXPECT_NEAR(phantom.posterior_end_mm - phantom.tip_end_mm, 110.0, 6.0);
  EXPECT_LT(phantom.tip_end_mm, phantom.tumor_center_mm.y());
}

TEST(Phantom, ListsEverySettingOutOfItsRange) {
  PhantomSettings settings;
  settings.spacing_mm.y() = 0.0;
  settings.noise_hu = std::numeric_limits<double>::quiet_NaN();
  settings.tumor_points = 3;
  settings.shape.height_mm = 5.0;
  settings.field_of_view_mm = 50.0;
  EXPECT_EQ(validate(settings).size(), 5U);
  EXPECT_THAT(testing::refusal_of<CaseError>([&] { return phantom_of(settings); }),
              ::testing::AllOf(::testing::HasSubstr("5 violation(s)"), ::testing::HasSubstr("spacing_mm[1]"),
                               ::testing::HasSubstr("tumor_points: found 3, expected a number in [24, 1000]")));
}

TEST(Phantom, StopsWhenAsked) {
  testing::StopAfter monitor;
  EXPECT_THROW(static_cast<void>(make_phantom(coarse(1), monitor)), Cancelled);
}

}  // namespace
}  // namespace incise
