#include "photo_scene.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <limits>
#include <numbers>

namespace incise {
namespace {

using namespace photo_scene;

struct Kind {
  double width_px;
  bool is_kerf;
};
class EveryLine : public ::testing::TestWithParam<Kind> {};

TEST_P(EveryLine, IsMeasuredToAFractionOfAPixel) {
  const auto [width_px, is_kerf] = GetParam();
  for (const std::uint64_t seed : {1U, 2U}) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    const Scene truth = scene(width_px, is_kerf, seed);
    expect_measured(truth);
  }
}

TEST_P(EveryLine, GapsUpToAMillimetreAreClosedAndWiderOnesAreOpen) {
  const auto [width_px, is_kerf] = GetParam();
  for (const double gap_mm : {1.0, 1.6}) {
    SCOPED_TRACE(fmt::format("gap {} mm", gap_mm));
    Scene truth = scene(width_px, is_kerf);
    truth.photo.glare_spots = 0;
    truth.photo.lines[1].gaps_mm = {{20.0, gap_mm}};
    const PhotoContours found = found_in(truth);
    EXPECT_EQ(found.incision.is_closed, gap_mm <= 1.0);
    EXPECT_NEAR(found.red.max_gap_mm(), gap_mm, 0.25);
    EXPECT_LT(mean_error(found.incision, truth.incision), kContourMm);
    if (gap_mm <= 1.0) expect_same_measures(found, truth);
  }
}

INSTANTIATE_TEST_SUITE_P(FindPhotoContours, EveryLine,
                         ::testing::Values(Kind{2, false}, Kind{4, false}, Kind{12, false}, Kind{30, true},
                                           Kind{100, true}),
                         [](const auto& kind) {
                           return fmt::format("{}Of{}Pixels", kind.param.is_kerf ? "Kerf" : "Line",
                                              kind.param.width_px);
                         });

TEST(FindPhotoContours, RunCounterClockwiseFromTheTop) {
  const PhotoContours found = found_in(photographed(scene(6, false)));
  for (const Contour* contour : {&found.tumor_edge, &found.incision}) {
    EXPECT_GT(signed_area_mm2(*contour, -Vec3::UnitZ()), 0.0);
    for (const Vec3& p : contour->points) EXPECT_LE(p.y(), contour->points.front().y());
  }
}

TEST(FindPhotoContours, AnOpenTumorEdgeIsRefusedWithItsGap) {
  Scene truth = scene(6, false);
  truth.photo.glare_spots = 0;
  truth.photo.lines[0].gaps_mm = {{5.0, 2.5}};
  const std::string message = testing::refusal_of<DataError>([&] { return found_in(photographed(truth)); });
  EXPECT_THAT(message, ::testing::HasSubstr("open tumour edge"));
  EXPECT_THAT(message, ::testing::ContainsRegex("2[.][456]"));
}

TEST(FindPhotoContours, HalfARingIsOpen) {
  Scene truth = scene(6, false);
  truth.photo.lines[1].gaps_mm = {{0.0, 0.5 * length_mm(truth.incision)}};
  const PhotoContours found = found_in(photographed(truth));
  EXPECT_FALSE(found.incision.is_closed);
  EXPECT_GT(found.red.max_gap_mm(), 10.0);
  EXPECT_LT(mean_error(found.incision, truth.incision), kContourMm);
  EXPECT_NEAR(length_mm(found.incision), 0.5 * length_mm(truth.incision), 1.0);
}

TEST(FindPhotoContours, AnIncisionThatCutsIntoTheTumorIsAResult) {
  Scene truth = scene(8, false);
  truth.incision = testing::moved(truth.incision, 0.0, 1.0, Vec3(7.0, 0.0, 0.0));
  truth.photo.width = 1200;
  truth.photo.lines[1].course = truth.incision;
  const ColorPicture picture = photographed(truth);
  const PhotoContours found = found_in(picture);
  EXPECT_TRUE(found.incision.is_closed);
  expect_contour(found.incision, truth.incision);
  expect_contour(found.tumor_edge, truth.tumor);
  EvaluationSettings settings{.contour = ContourKind::InnerEdge};
  EXPECT_EQ(evaluate(found.incision, found.tumor_edge, settings).outcome, Outcome::PositiveMargin);
}

TEST(FindPhotoContours, RefusesAGapThatIsNegativeOrNotFinite) {
  const ColorPicture grey{8, 8, std::vector<std::uint8_t>(3 * 8 * 8, 128)};
  for (const double gap_mm : {-0.5, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(static_cast<void>(find_photo_contours(grey, scale_from_mm_per_pixel(kScale, grey.height),
                                                       {.max_gap_mm = gap_mm}, kName)),
                 InvalidArgument)
        << gap_mm;
}

TEST(FindPhotoContours, RefusesWhatItCannotMeasure) {
  Scene no_red = scene(6, false);
  no_red.photo.lines.pop_back();
  EXPECT_THAT(refusal(no_red), ::testing::HasSubstr("no red line"));
  Scene no_green = scene(6, false);
  no_green.photo.lines.erase(no_green.photo.lines.begin());
  EXPECT_THAT(refusal(no_green), ::testing::HasSubstr("no green line"));
  Scene bare = scene(6, false);
  bare.photo.lines.clear();
  EXPECT_THAT(refusal(bare), ::testing::HasSubstr("no green line"));

  Scene two = scene(6, false);
  two.photo.lines.clear();
  for (const double x : {8.0, 21.0}) {
    two.photo.lines.push_back({.course = testing::circle(4.0, 200, Vec3(x, 15.0, 0.0)), .width_mm = 0.2});
  }
  EXPECT_THAT(refusal(two), ::testing::HasSubstr("2 green rings"));

  Scene eight = scene(6, false);
  Contour crossing{.points = {}, .is_closed = true};
  for (int i = 0; i < 400; ++i) {
    const double t = 2.0 * std::numbers::pi * i / 400.0;
    crossing.points.emplace_back(15.0 + 11.0 * std::sin(t), 15.0 + 6.0 * std::sin(2.0 * t), 0.0);
  }
  eight.photo.lines[1].course = crossing;
  EXPECT_THAT(refusal(eight), ::testing::HasSubstr("crosses itself"));

  Scene cut_twice = scene(6, false);
  cut_twice.photo.lines.push_back(cut_twice.photo.lines[1]);
  cut_twice.photo.lines.back().course = {.points = {Vec3(12.0, 15.0, 0.0), Vec3(18.0, 15.0, 0.0)}, .is_closed = false};
  EXPECT_THAT(refusal(cut_twice), ::testing::HasSubstr("inside the tumour's edge"));
  Scene second_tumor = scene(6, false);
  second_tumor.photo.lines.push_back({.course = testing::circle(1.7, 100, Vec3(4.0, 4.0, 0.0)), .width_mm = 0.2});
  EXPECT_THAT(refusal(second_tumor), ::testing::HasSubstr("beside the green ring"));

  // The second loop is not enclosed, because the red ring lies over it.
  Scene half_hidden = scene(6, false);
  half_hidden.photo.lines[0].course = crossing;
  EXPECT_THAT(refusal(half_hidden),
              ::testing::AnyOf(::testing::HasSubstr("beside the green ring"), ::testing::HasSubstr("crosses itself")));

  Scene cut_off = scene(6, false);
  for (PaintedLine& line : cut_off.photo.lines) {
    for (Vec3& p : line.course.points) p -= Vec3(8.0, 0.0, 0.0);
  }
  EXPECT_THAT(refusal(cut_off), ::testing::HasSubstr("a red line that runs out of the picture"));

  Scene charred = scene(6, false);
  charred.photo.lines[1].color = {60, 38, 30};
  EXPECT_THAT(refusal(charred), ::testing::HasSubstr("no red line"));

  EXPECT_THAT(refusal(scene(6, false), 0.5), ::testing::HasSubstr("Is the scale right?"));
}

TEST(FindPhotoContours, UndoesPerspective) {
  // The painted plane seen at a slant: the corners of its 30 x 30 mm land where a camera would put them.
  const Scene truth = scene(8, false);
  const ColorPicture flat = testing::paint_photo(truth.photo);
  const std::array<Vec2, 4> corners{Vec2(60, 930), Vec2(950, 960), Vec2(850, 80), Vec2(130, 50)};
  const double side = 999.0 * kScale;
  const PhotoScale scale = scale_from_rectangle(corners, side, side);
  ColorPicture slanted{1000, 1000, std::vector<std::uint8_t>(flat.rgb.size(), 120)};
  for (int v = 0; v < 1000; ++v) {
    for (int u = 0; u < 1000; ++u) {
      const Vec2 q = scale.plane_mm(Vec2(u, v)) / kScale;
      const double x = q.x(), y = 999.0 - q.y();
      if (x < 0.0 || y < 0.0 || x >= 998.0 || y >= 998.0) continue;
      const int iu = static_cast<int>(x), iv = static_cast<int>(y);
      const double a = x - iu, b = y - iv;
      for (std::size_t c = 0; c < 3; ++c) {
        const auto at = [&](int du, int dv) {
          return flat.rgb[3 * static_cast<std::size_t>((iv + dv) * 1000 + iu + du) + c];
        };
        slanted.rgb[3 * static_cast<std::size_t>(v * 1000 + u) + c] = static_cast<std::uint8_t>(
            (1 - b) * ((1 - a) * at(0, 0) + a * at(1, 0)) + b * ((1 - a) * at(0, 1) + a * at(1, 1)));
      }
    }
  }
  const PhotoContours found = find_photo_contours(slanted, scale, {}, kName);
  expect_contour(found.tumor_edge, truth.tumor);
  expect_contour(found.incision, truth.incision);
  expect_same_measures(found, truth);
}

TEST(FindPhotoContours, GivesTheSameAnswerTwice) {
  const ColorPicture picture = photographed(scene(6, false));
  const PhotoContours a = found_in(picture), b = found_in(picture);
  ASSERT_EQ(a.incision.points.size(), b.incision.points.size());
  for (std::size_t i = 0; i < a.incision.points.size(); ++i) EXPECT_EQ(a.incision.points[i], b.incision.points[i]);
}

TEST(DrawFound, KeepsThePictureAndShowsTheLines) {
  const ColorPicture picture = photographed(scene(6, false));
  const PhotoContours found = found_in(picture);
  const ColorPicture drawn = draw_found(picture, {&found.green, &found.red});
  ASSERT_EQ(drawn.rgb.size(), picture.rgb.size());
  const Vec2 p = found.red.points_px[10];
  const auto k =
      3 * (static_cast<std::size_t>(std::lround(p.y())) * 1000 + static_cast<std::size_t>(std::lround(p.x())));
  EXPECT_GT(int{drawn.rgb[k + 1]} + drawn.rgb[k + 2], 250) << "white was drawn where there was red";
  EXPECT_EQ(drawn.rgb[0], picture.rgb[0] * 3 / 4);
}

}  // namespace
}  // namespace incise
