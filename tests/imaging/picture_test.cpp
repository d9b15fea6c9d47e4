#include "support/photo_painter.hpp"

#include <incise/core/error.hpp>
#include <incise/imaging/photo_scale.hpp>

namespace incise {
namespace {

using ::testing::HasSubstr;

ColorPicture small_picture() {
  ColorPicture picture{5, 4, {}};
  for (int i = 0; i < 5 * 4; ++i) {
    picture.rgb.insert(picture.rgb.end(),
                       {static_cast<std::uint8_t>(10 * i), static_cast<std::uint8_t>(255 - 10 * i), 77});
  }
  return picture;
}

std::string refusal(const std::string& bytes) {
  try {
    static_cast<void>(decode_picture(bytes, "p.png"));
  } catch (const DataError& error) {
    return error.what();
  }
  return "";
}

TEST(DecodePicture, GivesBackWhatWasEncoded) {
  const ColorPicture picture = small_picture();
  const ColorPicture again = decode_picture(encode_png(picture), "p.png");
  EXPECT_EQ(again.width, 5);
  EXPECT_EQ(again.height, 4);
  EXPECT_EQ(again.rgb, picture.rgb);
}

TEST(DecodePicture, RefusesFilesThatAreCutShortAtAnyByte) {
  for (const std::string& whole : {encode_png(small_picture()), encode_jpeg(small_picture(), 90)}) {
    EXPECT_EQ(refusal(whole), "");
    for (std::size_t length = 0; length + 2 < whole.size(); length += 3)
      EXPECT_NE(refusal(whole.substr(0, length)), "") << length;
  }
  EXPECT_THAT(refusal(encode_jpeg(small_picture(), 90).substr(0, 400)), HasSubstr("the end of the file"));
}

TEST(DecodePicture, RefusesDamageThatDecodersPaintOver) {
  testing::PaintedPhoto photo;
  photo.width = photo.height = 128;
  const ColorPicture picture = testing::paint_photo(photo);
  std::string jpeg = encode_jpeg(picture, 70);
  EXPECT_EQ(refusal(jpeg), "");
  for (std::size_t i = jpeg.size() / 2; i < jpeg.size() / 2 + 60; ++i) jpeg[i] = 0;
  EXPECT_THAT(refusal(jpeg), HasSubstr("a damaged picture"));
  std::string png = encode_png(picture);
  png[png.size() / 2] = static_cast<char>(png[png.size() / 2] ^ 0x10);
  EXPECT_THAT(refusal(png), HasSubstr("a block whose checksum does not match"));
}

TEST(DecodePicture, RefusesOtherFiles) {
  EXPECT_THAT(refusal("This is a letter."), HasSubstr("another kind of file"));
  EXPECT_THAT(refusal(""), HasSubstr("an empty file"));
}

/// Big endian.
void put(std::string& bytes, std::size_t place, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) bytes[place + static_cast<std::size_t>(i)] = static_cast<char>(value >> (24 - 8 * i));
}

TEST(DecodePicture, RefusesAJpegThatClaimsMoreThanItHolds) {
  std::string jpeg = encode_jpeg(small_picture(), 90);
  const std::size_t frame = jpeg.find("\xFF\xC0");
  ASSERT_NE(frame, std::string::npos);
  for (const std::size_t place : {5, 7}) {
    jpeg[frame + place] = '\x2E';  // 11 776 rows and columns
    jpeg[frame + place + 1] = 0;
  }
  EXPECT_THAT(refusal(jpeg), HasSubstr("11776 x 11776 pixels in "));
}

TEST(DecodePicture, RefusesATiffThatClaimsMoreThanItHolds) {
  std::string tiff("MM\0*\0\0\0\x08\0\x02", 10);
  for (const std::uint32_t tag : {256U, 257U}) {
    std::string entry(12, '\0');
    put(entry, 0, tag << 16 | 4U);
    put(entry, 4, 1);
    put(entry, 8, 14000);
    tiff += entry;
  }
  EXPECT_THAT(refusal(tiff), HasSubstr("14000 x 14000 pixels in 34 bytes"));
  put(tiff, 18, 0);
  EXPECT_THAT(refusal(tiff), HasSubstr("0 x 14000 pixels"));
}

TEST(DecodePicture, RefusesPixelsThatAreNotSquare) {
  std::string jpeg = encode_jpeg(small_picture(), 90);
  const std::size_t jfif = jpeg.find("JFIF");
  ASSERT_NE(jfif, std::string::npos);
  put(jpeg, jfif + 8, 72U << 16 | 72U);
  EXPECT_NO_THROW(static_cast<void>(decode_picture(jpeg, "p.jpg")));
  put(jpeg, jfif + 8, 72U << 16 | 96U);
  EXPECT_THAT(refusal(jpeg), HasSubstr("not square (72 in a width, 96 in a height)"));

  std::string png = encode_png(small_picture());
  std::string block(21, '\0');
  put(block, 0, 9);
  block.replace(4, 4, "pHYs");
  put(block, 8, 2000);
  put(block, 12, 1000);
  block[16] = 1;
  put(block, 17, 0xA91DF3B8);  // checksum, computed apart
  png.insert(8 + 25, block);
  EXPECT_THAT(refusal(png), HasSubstr("not square (2000 in a width, 1000 in a height)"));

  std::string tiff("MM\0*\0\0\0\x08\0\x04", 10);
  const auto add = [&](std::uint32_t tag, std::uint32_t kind, std::uint32_t value) {
    std::string entry(12, '\0');
    put(entry, 0, tag << 16 | kind);
    put(entry, 4, 1);
    put(entry, 8, value);
    tiff += entry;
  };
  add(256, 4, 10);
  add(257, 4, 10);
  add(282, 5, 58);
  add(283, 5, 66);
  tiff += std::string(16, '\0');
  for (const auto& [place, value] :
       std::vector<std::pair<std::size_t, std::uint32_t>>{{58, 300}, {62, 1}, {66, 300}, {70, 2}})
    put(tiff, place, value);
  EXPECT_THAT(refusal(tiff), HasSubstr("not square (300 in a width, 150 in a height)"));
}

TEST(DecodePicture, RefusesPicturesWithoutColor) {
  ColorPicture grey = small_picture();
  for (std::size_t i = 0; i < grey.rgb.size(); ++i) grey.rgb[i] = grey.rgb[i - i % 3];
  EXPECT_THAT(refusal(encode_png(grey)), HasSubstr("without colour"));
  const DepthPicture one_channel{2, 2, {1, 2, 3, 4}};
  EXPECT_THAT(refusal(encode_png(one_channel)), HasSubstr("greyscale"));
}

TEST(DecodePicture, RefusesCmyk) {
  // A JPEG whose frame header says four components.
  std::string jpeg = encode_jpeg(small_picture(), 90);
  const std::size_t frame = jpeg.find("\xFF\xC0");
  ASSERT_NE(frame, std::string::npos);
  jpeg[frame + 9] = 4;
  EXPECT_THAT(refusal(jpeg), HasSubstr("CMYK"));
}

TEST(DecodeDepth, GivesBackCountsAndRefusesColor) {
  const DepthPicture depth{3, 2, {0, 1, 500, 65535, 7, 8}};
  EXPECT_EQ(decode_depth(encode_png(depth), "d.png").counts, depth.counts);
  EXPECT_THROW(static_cast<void>(decode_depth(encode_png(small_picture()), "d.png")), DataError);
  EXPECT_THROW(static_cast<void>(decode_depth(encode_png(DepthPicture{2, 1, {0, 0}}), "d.png")), DataError);
}

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
  return decode_picture(encode_jpeg(testing::paint_photo(photo), 80), "ruler.jpg");
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
      try {
        static_cast<void>(found());
        ADD_FAILURE() << "one of two bars was taken";
      } catch (const DataError& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("2 bars, one of "));
        EXPECT_THAT(error.what(), ::testing::ContainsRegex("at pixel 18[0-9], 56[0-9]"));
      }
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
