#include "support/encode_jpeg.hpp"
#include "support/photo_painter.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/imaging/photo_scale.hpp>
#include <incise/io/picture_io.hpp>

namespace incise {
namespace {

TEST(PhotoScale, OfOneScaleTurnsYUp) {
  const PhotoScale scale = scale_from_mm_per_pixel(0.5, 11);
  EXPECT_TRUE(scale.plane_mm({4, 10}).isApprox(Vec2(2.0, 0.0)));
  EXPECT_TRUE(scale.plane_mm({4, 0}).isApprox(Vec2(2.0, 5.0)));
  EXPECT_NEAR(scale.mm_per_pixel({3, 3}), 0.5, 1e-12);
}

TEST(PhotoScale, OfTwoPointsIsTheirDistance) {
  EXPECT_NEAR(scale_from_two_points({0, 0}, {30, 40}, 10.0, 100).mm_per_pixel({0, 0}), 0.2, 1e-12);
  EXPECT_THROW(static_cast<void>(scale_from_two_points({0, 0}, {3, 4}, 10.0, 100)), InvalidArgument);
}

TEST(PhotoScale, OfARectangleTakesItsCornersThere) {
  const std::array<Vec2, 4> corners{Vec2(100, 900), Vec2(880, 850), Vec2(800, 120), Vec2(180, 90)};
  const PhotoScale scale = scale_from_rectangle(corners, 40.0, 30.0);
  const std::array<Vec2, 4> plane{Vec2(0, 0), Vec2(40, 0), Vec2(40, 30), Vec2(0, 30)};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((scale.plane_mm(corners[i]) - plane[i]).norm(), 1e-9);
  EXPECT_THROW(static_cast<void>(scale_from_rectangle({corners[0], corners[2], corners[1], corners[3]}, 40, 30)),
               InvalidArgument);
  EXPECT_THROW(static_cast<void>(scale_from_rectangle({corners[3], corners[2], corners[1], corners[0]}, 40, 30)),
               InvalidArgument);
}

/// A white ruler at a slant, with a tick each millimetre, every fifth longer.
ColorPicture photo_with_ruler(double mm_per_pixel, double angle) {
  testing::PaintedPhoto photo;
  photo.width = photo.height = 900;
  photo.mm_per_pixel = mm_per_pixel;
  photo.glare_spots = 4;
  const Vec3 along(std::cos(angle), std::sin(angle), 0.0), across(-std::sin(angle), std::cos(angle), 0.0);
  const Vec3 corner(4.0, 5.0, 0.0);
  const double length = 20.0;
  photo.lines.push_back(
      {.course = {{corner, corner + length * along}, false}, .width_mm = 5.0, .color = {235, 235, 230}});
  for (int i = 0; i <= 18; ++i) {
    const Vec3 foot = corner + (1.0 + i) * along - 2.3 * across;
    photo.lines.push_back(
        {.course = {{foot, foot + (i % 5 == 0 ? 3.0 : 1.8) * across}, false}, .width_mm = 0.15, .color = {25, 25, 28}});
  }
  return decode_picture(testing::encode_jpeg(testing::paint_photo(photo), 80), "ruler.jpg");
}

TEST(FindRuler, MeasuresTicksAtAnyAngle) {
  for (const double angle : {0.0, 0.3, 1.1}) {
    const Ruler ruler = find_ruler(photo_with_ruler(0.03, angle), RulerKind::Ticks, 1.0, "ruler.jpg");
    EXPECT_NEAR(ruler.mm_per_pixel / 0.03, 1.0, 0.002) << angle;
    EXPECT_GE(ruler.marks_px.size(), 12U);
    EXPECT_LT(ruler.error_percent, 0.5);
  }
}

TEST(FindRuler, MeasuresASolidBar) {
  for (const testing::Rgb& color : {testing::Rgb{15, 15, 15}, testing::Rgb{252, 252, 252}}) {
    testing::PaintedPhoto photo;
    photo.width = photo.height = 700;
    photo.glare_spots = 0;  // one on an end would change the bar
    photo.shading = 0.0;
    photo.lines.push_back({.course = {{Vec3(3, 4, 0), Vec3(8, 4.6, 0)}, false},
                           .width_mm = 0.5,
                           .color = color,
                           .gaps_mm = {{0.0, 1e-9}}});
    // The start is cut square, the end is round: half the width longer than the course.
    const double length = Vec2(5, 0.6).norm() + 0.25;
    const Ruler ruler = find_ruler(testing::paint_photo(photo), RulerKind::Bar, length, "bar.png");
    EXPECT_NEAR(ruler.mm_per_pixel / 0.03, 1.0, 0.02);
  }
}

TEST(FindRuler, RefusesTwoBarsWithLengthsAndPlaces) {
  const auto bar = [](double from, double to, double y, const testing::Rgb& color) {
    return testing::PaintedLine{.course = {{Vec3(from, y, 0), Vec3(to, y, 0)}, false}, .width_mm = 0.4, .color = color};
  };
  testing::PaintedPhoto photo;
  photo.width = photo.height = 700;
  photo.glare_spots = 0;
  photo.shading = 0.0;
  photo.lines = {bar(3, 8, 4, {15, 15, 15})};
  const auto found = [&] { return find_ruler(testing::paint_photo(photo), RulerKind::Bar, 5.4, "bar.png"); };
  const double alone = found().mm_per_pixel;
  EXPECT_NEAR(alone / 0.03, 1.0, 0.02);
  // A shaft twice as long, and one of half the length; black or white.
  for (const double end : {13.0, 5.5}) {
    for (const testing::Rgb& color : {testing::Rgb{20, 20, 22}, testing::Rgb{252, 252, 252}}) {
      photo.lines = {bar(3, 8, 4, {15, 15, 15}), bar(3, end, 12, color)};
      EXPECT_THAT(testing::refusal_of<DataError>(found),
                  ::testing::AllOf(::testing::HasSubstr("2 bars, one of "),
                                   ::testing::ContainsRegex("at pixel 18[0-9], 56[0-9]")));
    }
  }
  // A stroke of a label's letter is no second bar.
  photo.lines = {bar(3, 15, 4, {15, 15, 15}), bar(3, 5, 12, {15, 15, 15})};
  EXPECT_NEAR(found().mm_per_pixel, 0.03 * 5.4 / 12.4, 0.0005);
}

TEST(FindRuler, SaysThatThereIsNone) {
  testing::PaintedPhoto photo;
  photo.width = photo.height = 500;
  const ColorPicture picture = testing::paint_photo(photo);
  EXPECT_THROW(static_cast<void>(find_ruler(picture, RulerKind::Ticks, 1.0, "p.png")), DataError);
  EXPECT_THROW(static_cast<void>(find_ruler(picture, RulerKind::Bar, 5.0, "p.png")), DataError);
}

}  // namespace
}  // namespace incise
