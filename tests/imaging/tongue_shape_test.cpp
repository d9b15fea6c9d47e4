#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/imaging/tongue_shape.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace incise {
namespace {

constexpr std::uint64_t kSeeds = 31;

TongueShape shape_of(std::uint64_t seed) {
  Random random(seed);
  return draw_tongue_shape(TongueShapeSettings{}, random);
}

TEST(TongueShape, HasTheVolumeThatCountingPointsOfAFineGridFinds) {
  const TongueShape shape = shape_of(3);
  const Box3 box = bounds_mm(shape);
  constexpr double kStep = 0.15;
  double volume = 0.0;
  for (double y = box.min().y() + 0.5 * kStep; y < box.max().y(); y += kStep)
    for (double x = box.min().x() + 0.5 * kStep; x < box.max().x(); x += kStep)
      if (const auto span = span_at(shape, x, y)) volume += (span->high_mm - span->low_mm) * kStep * kStep;
  EXPECT_NEAR(volume_mm3(shape) / volume, 1.0, 3e-4);  // the columns miss a little at the vertical outline
}

TEST(TongueShape, HasAVolumeThatNoLongerChangesWithTheNumberOfSteps) {
  const TongueShape shape = shape_of(4);
  EXPECT_NEAR(volume_mm3(shape) / volume_mm3(shape, 800), 1.0, 1e-5);
}

TEST(TongueShape, RestsOnThePlatformAndNowhereReachesBelowIt) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const TongueShape shape = shape_of(seed);
    double lowest = std::numeric_limits<double>::infinity();
    double resting_mm2 = 0.0;
    for (double y = -0.5 * shape.length_mm; y < 0.5 * shape.length_mm; y += 1.0)
      for (double x = -35.0; x < 35.0; x += 1.0)
        if (const auto span = span_at(shape, x, y)) {
          EXPECT_LE(span->low_mm, span->high_mm) << "seed " << seed << " at " << x << ", " << y;
          lowest = std::min(lowest, span->low_mm);
          if (span->low_mm == 0.0) resting_mm2 += 1.0;
        }
    EXPECT_EQ(lowest, 0.0) << "seed " << seed;
    EXPECT_GT(resting_mm2, 2000.0) << "seed " << seed;
  }
}

TEST(TongueShape, ClosesAtItsOutlineWithoutAStep) {
  const TongueShape shape = shape_of(5);
  // Walk outwards at mid-length until the tissue ends: the last span is thin.
  double x = midline_x_mm(shape, 0.0);
  std::optional<TissueSpan> last;
  while (const auto span = span_at(shape, x, 0.0)) {
    last = span;
    x += 1e-4;
  }
  EXPECT_LT(last->high_mm - last->low_mm, 0.5);
}

TEST(TongueShape, StaysInsideItsBox) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const TongueShape shape = shape_of(seed);
    const Box3 box = bounds_mm(shape);
    for (double y = -90.0; y < 90.0; y += 1.0)
      for (double x = -60.0; x < 60.0; x += 1.0)
        if (const auto span = span_at(shape, x, y)) {
          EXPECT_TRUE(box.contains(Vec3(x, y, span->low_mm)));
          EXPECT_TRUE(box.contains(Vec3(x, y, span->high_mm)));
        }
  }
}

TEST(TongueShape, IsTheSameForTheSameSeedAndVisiblyAnotherForAnother) {
  EXPECT_EQ(volume_mm3(shape_of(7), 64), volume_mm3(shape_of(7), 64));
  const TongueShape a = shape_of(7);
  const TongueShape b = shape_of(8);
  double greatest_mm = 0.0;
  for (double y = -40.0; y <= 40.0; y += 5.0)
    greatest_mm = std::max(greatest_mm, std::abs(span_at(a, 0.0, y)->high_mm - span_at(b, 0.0, y)->high_mm));
  EXPECT_GT(greatest_mm, 0.5);
  EXPECT_LT(greatest_mm, 8.0);
}

TEST(TongueShape, ListsEverySettingOutOfItsRange) {
  TongueShapeSettings settings;
  settings.length_mm = -1.0;
  settings.width_mm = std::numeric_limits<double>::quiet_NaN();
  settings.bump_mm = 9.0;
  const std::vector<std::string> problems = sentences(problems_of(settings));
  ASSERT_EQ(problems.size(), 3U);
  EXPECT_EQ(problems[0], "length_mm: found -1, expected a number in [80, 160]");
  Random random(1);
  EXPECT_THROW(static_cast<void>(draw_tongue_shape(settings, random)), InvalidArgument);
}

}  // namespace
}  // namespace incise
