// What must not pass for one simple red and one simple green ring without a word.
#include "photo_scene.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <numbers>

namespace incise {
namespace {

using namespace photo_scene;
using ::testing::HasSubstr;

const Vec3 kMiddle(15.0, 15.0, 0.0);

/// r = size (1 + a cos t): for a > 1 the curve crosses itself and has an inner loop.
Contour limacon(double size, double a, const Vec3& crossing) {
  return testing::polar_ring([&](double t) { return size * (1.0 + a * std::cos(t)); }, 1200, crossing);
}

/// The ring with a turn of a smaller circle in it, outside of it or inside.
Contour curled(const Contour& ring, double radius, bool is_inside) {
  Contour curve{.points = {}, .is_closed = true};
  const Vec3 start = ring.points.front();
  const Vec3 outwards = (start - kMiddle).normalized();
  const Vec3 along = Vec3::UnitZ().cross(outwards);
  const double side = is_inside ? -1.0 : 1.0;
  for (int i = 0; i < 200; ++i) {
    const double t = 2.0 * std::numbers::pi * i / 200.0;
    curve.points.emplace_back(start + radius * (side * (1.0 - std::cos(t)) * outwards + std::sin(t) * along));
  }
  curve.points.insert(curve.points.end(), ring.points.begin(), ring.points.end());
  return curve;
}

struct Spot {
  double across_mm;
  Rgb color{205, 20, 35};
};

/// Without highlights: one over a spot hides it.
Scene with_spots(Scene s, const std::vector<Spot>& spots) {
  s.photo.glare_spots = 0;
  double x = -1.5;
  for (const Spot& spot : spots) {
    const Vec3 at = kMiddle + Vec3(x += 1.5, 0.5, 0.0);
    // A line hardly longer than nothing, with its round ends.
    s.photo.lines.push_back({.course = {.points = {at - Vec3(0.005, 0, 0), at + Vec3(0.005, 0, 0)}, .is_closed = false},
                             .width_mm = spot.across_mm,
                             .color = spot.color});
  }
  return s;
}

TEST(RedInTheTumor, IsToldDownToTheInksNoise) {
  for (const double across_mm : {0.18, 0.6, 2.0}) {
    for (const std::uint64_t seed : {1U, 2U}) {
      SCOPED_TRACE(fmt::format("a spot of {} mm, seed {}", across_mm, seed));
      const PhotoContours found = found_in(with_spots(scene(6, false, seed), {{across_mm}}));
      ASSERT_EQ(found.red_in_tumor.size(), 1U);
      const PhotoMark& mark = found.red_in_tumor.front();
      EXPECT_NEAR(mark.longest_mm, across_mm, 0.15);
      const Vec2 truth((kMiddle.x()) / kScale, 999.0 - (kMiddle.y() + 0.5) / kScale);
      EXPECT_LT((mark.at_px - truth).norm(), 3.0);
    }
  }
}

TEST(RedInTheTumor, OfAFainterInkIsToldToo) {
  const PhotoContours found = found_in(with_spots(scene(6, false), {{0.6, {200, 70, 65}}}));
  EXPECT_EQ(found.red_in_tumor.size(), 1U);
}

TEST(RedInTheTumor, ListsTheLargestFirst) {
  const PhotoContours found = found_in(with_spots(scene(6, false), {{0.4}, {1.0}, {0.7}}));
  ASSERT_EQ(found.red_in_tumor.size(), 3U);
  EXPECT_NEAR(found.red_in_tumor[0].longest_mm, 1.0, 0.15);
  EXPECT_NEAR(found.red_in_tumor[2].longest_mm, 0.4, 0.15);
}

TEST(RedInTheTumor, IsNotSeenInTissueAndHighlights) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    Scene s = scene(6, false, seed);
    s.photo.glare_spots = 24;
    s.photo.mottle = 0.2;
    s.photo.noise = 6.0;
    try {
      EXPECT_TRUE(found_in(s).red_in_tumor.empty());
    } catch (const DataError& error) {
      EXPECT_THAT(error.what(), HasSubstr("A highlight hides it"));
    }
  }
}

Contour ellipse(double half_width, double half_height, double from = 0.0, double to = 2.0 * std::numbers::pi) {
  Contour curve{.points = {}, .is_closed = to - from > 6.28};
  for (int i = 0; i < 720; ++i) {
    const double t = from + (to - from) * i / 720.0;
    curve.points.emplace_back(kMiddle + Vec3(half_width * std::cos(t), half_height * std::sin(t), 0.0));
  }
  return curve;
}

/// A tumour of 9 x 7.2 mm in a kerf.
Scene kerf_scene(double distance_mm, double width_px) {
  Scene s = scene(width_px, true);
  s.photo.glare_spots = 0;
  s.tumor = ellipse(4.5, 3.6);
  s.incision = outer_offset(s.tumor, distance_mm, -Vec3::UnitZ());
  s.photo.lines[0].course = s.tumor;
  s.photo.lines[1].course = s.incision;
  return s;
}

TEST(FindPhotoContours, MeasuresBroadKerfsCloseToTheTumor) {
  for (const double distance_mm : {1.2, 2.0}) {
    for (const double width_px : {60.0, 100.0, 130.0}) {
      SCOPED_TRACE(fmt::format("{} mm beside the edge, {} px", distance_mm, width_px));
      expect_measured(kerf_scene(distance_mm, width_px));
    }
  }
}

TEST(RedInTheTumor, BesideAKerfIsNeverSilent) {
  for (const double width_px : {5.0, 12.0}) {
    SCOPED_TRACE(fmt::format("a line of {} px", width_px));
    Scene s = kerf_scene(1.2, 60.0);
    s.photo.lines.push_back(
        {.course = ellipse(4.05, 3.15, -0.7, 0.7), .width_mm = width_px * kScale, .color = {205, 20, 35}});
    EXPECT_THAT(refusal(s), ::testing::AllOf(HasSubstr("a red mark of 4."), HasSubstr("inside the")));
  }
  for (const double x : {0.0, 3.0, 4.2}) {
    SCOPED_TRACE(fmt::format("a spot {} mm from the middle", x));
    Scene s = kerf_scene(1.2, 60.0);
    const Vec3 at = kMiddle + Vec3(x, 0, 0);
    s.photo.lines.push_back({.course = {.points = {at - Vec3(0.005, 0, 0), at + Vec3(0.005, 0, 0)}, .is_closed = false},
                             .width_mm = 0.4,
                             .color = {205, 20, 35}});
    const PhotoContours found = found_in(s);
    ASSERT_EQ(found.red_in_tumor.size(), 1U);
    EXPECT_NEAR(found.red_in_tumor.front().longest_mm, 0.4, 0.15);
  }
}

TEST(RedInTheTumor, IsNotTheKerfItself) {
  for (const double shift_mm : {0.0, 0.3, 0.5}) {
    for (const double blur_px : {0.4, 0.9, 2.0}) {
      SCOPED_TRACE(fmt::format("moved by {} mm, blur {} px", shift_mm, blur_px));
      Scene s = kerf_scene(1.0, 60.0);
      s.photo.blur_px = blur_px;
      s.tumor = testing::circle(4.0, 400, kMiddle);
      s.incision = testing::circle(4.6, 400, kMiddle + Vec3(shift_mm, 0, 0));  // at 0.5 it touches the edge
      s.photo.lines[0].course = s.tumor;
      s.photo.lines[1].course = s.incision;
      const PhotoContours found = found_in(s);
      EXPECT_TRUE(found.red_in_tumor.empty());
      EXPECT_LT(mean_error(found.incision, s.incision), kContourMm);
    }
  }
}

TEST(GreenBesideTheTumor, IsToldAndRefusedFromTheSmallestTumorOn) {
  for (const double across_mm : {0.4, 0.8, 1.5, 2.4, 3.2}) {
    SCOPED_TRACE(fmt::format("a ring of {} mm", across_mm));
    Scene s = scene(4, false);
    s.photo.glare_spots = 0;
    s.photo.lines.push_back({.course = testing::circle(0.5 * across_mm, 200, Vec3(27.0, 27.0, 0.0)), .width_mm = 0.12});
    if (across_mm >= 2.0) {
      EXPECT_THAT(refusal(s), ::testing::AnyOf(HasSubstr("a green mark of"), HasSubstr("2 green rings")));
      continue;
    }
    const PhotoContours found = found_in(s);
    ASSERT_EQ(found.green_beside.size(), 1U);
    EXPECT_NEAR(found.green_beside.front().longest_mm, across_mm + 0.12, 0.15);
  }
}

TEST(CrossingCurves, AreRefusedWithTheirPlace) {
  for (const double width_px : {3.0, 12.0}) {
    for (const double a : {1.3, 2.0}) {
      SCOPED_TRACE(fmt::format("limacon {} of {} pixels", a, width_px));
      Scene s = scene(width_px, false);
      s.photo.glare_spots = 0;
      s.photo.lines[1].course = limacon(24.0 / (2.0 + 2.0 * a), a, kMiddle - Vec3(10.5, 0, 0));
      s.photo.lines[0].course = testing::circle(1.5, 200, kMiddle + Vec3(7.0, 0, 0));
      EXPECT_THAT(refusal(s), ::testing::AllOf(HasSubstr("a red line that crosses itself"), HasSubstr("mm across")));
      // The same curve as a tumour's edge.
      std::swap(s.photo.lines[0].course, s.photo.lines[1].course);
      s.photo.lines[1].course = testing::circle(13.5, 400, kMiddle);
      EXPECT_THAT(refusal(s), HasSubstr("a green line that crosses itself"));
    }
  }
}

TEST(CrossingCurves, LoopsAreNotDropped) {
  for (const bool is_inside : {false, true}) {
    for (const double radius : {0.3, 0.6, 1.5}) {
      for (const double width_px : {3.0, 8.0}) {
        SCOPED_TRACE(
            fmt::format("a loop of {} mm {}, line of {} px", radius, is_inside ? "inside" : "outside", width_px));
        Scene s = scene(width_px, false);
        s.photo.glare_spots = 0;
        s.photo.lines[1].course = curled(s.incision, radius, is_inside);
        EXPECT_THAT(refusal(s), HasSubstr("a red line that crosses itself"));
      }
    }
  }
}

TEST(CrossingCurves, AnOpenLineWithALoopIsRefused) {
  Scene s = scene(6, false);
  s.photo.glare_spots = 0;
  s.photo.lines[1].course = curled(s.incision, 1.0, false);
  s.photo.lines[1].gaps_mm = {{30.0, 8.0}};
  EXPECT_THAT(refusal(s), HasSubstr("a red line that crosses itself"));
}

TEST(CrossingCurves, EndsThatOverlapAreARing) {
  // A cut that runs on beyond its start, beside itself: no loop, and the ring is closed.
  Scene s = scene(6, false);
  s.photo.lines.push_back(s.photo.lines[1]);
  const Vec3 a = s.incision.points.front();
  s.photo.lines.back().course = {.points = {a, a + 2.0 * (a - kMiddle).normalized()}, .is_closed = false};
  const PhotoContours found = found_in(s);
  EXPECT_TRUE(found.incision.is_closed);
}

TEST(FindPhotoContours, MeasuresLinesOnWhitePaper) {
  for (const double level : {225.0, 236.0, 238.0, 255.0}) {
    SCOPED_TRACE(fmt::format("grey {}", level));
    Scene s = scene(6, false);
    s.photo.glare_spots = 0;
    s.photo.mottle = 0.0;
    s.photo.shading = 0.0;
    s.photo.tissue = {level, level, level};
    expect_measured(s);
  }
}

TEST(FindPhotoContours, ReadsTumorsFromTwoMillimetres) {
  for (const double across_mm : {1.6, 2.1, 2.6}) {
    for (const double width_px : {3.0, 12.0}) {
      SCOPED_TRACE(fmt::format("{} mm across, line of {} px", across_mm, width_px));
      Scene s = scene(width_px, false);
      s.photo.glare_spots = 0;
      s.tumor = testing::circle(0.5 * across_mm, 200, kMiddle);
      s.incision = testing::circle(0.5 * across_mm + 4.5, 400, kMiddle);
      s.photo.lines[0].course = s.tumor;
      s.photo.lines[1].course = s.incision;
      if (across_mm < 2.0) {
        EXPECT_THAT(refusal(s), HasSubstr("Is the scale right?"));
      } else {
        expect_measured(s);
      }
    }
  }
}

}  // namespace
}  // namespace incise
