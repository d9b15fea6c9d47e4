// Photographs and depth pictures: what comes back, and what is refused.

#include "support/encode_jpeg.hpp"
#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/io/picture_io.hpp>

#include <algorithm>
#include <array>
#include <cstdint>

namespace incise {
namespace {

using ::testing::HasSubstr;
using testing::encode_jpeg;

ColorPicture small_picture() {
  ColorPicture picture{5, 4, {}};
  for (int i = 0; i < 5 * 4; ++i) {
    picture.rgb.insert(picture.rgb.end(),
                       {static_cast<std::uint8_t>(10 * i), static_cast<std::uint8_t>(255 - 10 * i), 77});
  }
  return picture;
}

std::string refusal(const std::string& bytes) {
  return testing::refusal_of<DataError>([&] { return decode_picture(bytes, "p.png"); });
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
    EXPECT_EQ(refusal(whole), "accepted");
    for (std::size_t length = 0; length + 2 < whole.size(); length += 3)
      EXPECT_NE(refusal(whole.substr(0, length)), "accepted") << length;
  }
  EXPECT_THAT(refusal(encode_jpeg(small_picture(), 90).substr(0, 400)),
              HasSubstr("a picture that cannot be read (Premature end of JPEG file)"));
}

TEST(DecodePicture, RefusesDamageThatDecodersPaintOver) {
  ColorPicture picture{128, 128, std::vector<std::uint8_t>(std::size_t{3} * 128 * 128)};
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) picture.rgb[i] = static_cast<std::uint8_t>(i * i % 251);
  std::string jpeg = encode_jpeg(picture, 70);
  EXPECT_EQ(refusal(jpeg), "accepted");
  for (std::size_t i = jpeg.size() / 2; i < jpeg.size() / 2 + 60; ++i) jpeg[i] = 0;
  EXPECT_THAT(refusal(jpeg), HasSubstr("a picture that cannot be read"));
  std::string png = encode_png(picture);
  png[png.size() / 2] = static_cast<char>(png[png.size() / 2] ^ 0x10);
  EXPECT_THAT(refusal(png), HasSubstr("a picture that cannot be read ("));
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

/// A TIFF file of one strip, or of one tile where `fields` begin with 322, big endian. @param fields  more of them:
/// tag, kind (3 short, 4 long, 5 ratio), value.
std::string tiff_of(int width, int height, int channels, int bits, const std::string& pixels,
                    std::vector<std::array<std::uint32_t, 3>> fields = {}) {
  const auto number = [](int value) { return static_cast<std::uint32_t>(value); };
  const std::uint32_t colours = channels == 1 ? 1 : 2, count = static_cast<std::uint32_t>(pixels.size());
  const bool is_tiled = !fields.empty() && fields.front()[0] == 322;
  for (const std::array<std::uint32_t, 3>& field : std::vector<std::array<std::uint32_t, 3>>{{256, 4, number(width)},
                                                                                             {257, 4, number(height)},
                                                                                             {259, 3, 1},
                                                                                             {262, 3, colours},
                                                                                             {277, 3, number(channels)},
                                                                                             {278, 4, number(height)},
                                                                                             {279, 4, count}}) {
    const bool is_of_strips = field[0] == 278 || field[0] == 279;
    if (!(is_tiled && is_of_strips) &&
        std::none_of(fields.begin(), fields.end(), [&](const auto& given) { return given[0] == field[0]; }))
      fields.push_back(field);
  }
  const std::size_t ratios = 8 + 2 + 12 * (fields.size() + 2) + 4, bits_at = ratios + 16, strip = bits_at + 8;
  fields.push_back({258, 3, channels == 1 ? number(bits) : 0});
  fields.push_back({is_tiled ? 324U : 273U, 4, static_cast<std::uint32_t>(strip)});
  std::sort(fields.begin(), fields.end());
  std::string tiff("MM\0*\0\0\0\x08", 8);
  tiff += {'\0', static_cast<char>(fields.size())};
  std::string ratio_bytes;
  for (const auto& [tag, kind, value] : fields) {
    std::string entry(12, '\0');
    put(entry, 0, tag << 16 | kind);
    put(entry, 4, tag == 258 ? number(channels) : 1);
    put(entry, 8, kind == 3 ? value << 16 : value);
    if (tag == 258 && channels > 1) put(entry, 8, static_cast<std::uint32_t>(bits_at));
    if (kind == 5) {
      put(entry, 8, static_cast<std::uint32_t>(ratios + ratio_bytes.size()));
      std::string ratio(8, '\0');
      put(ratio, 0, value);
      put(ratio, 4, 1);
      ratio_bytes += ratio;
    }
    tiff += entry;
  }
  tiff += std::string(4, '\0');
  ratio_bytes.resize(16);
  tiff += ratio_bytes;
  for (int c = 0; c < 4; ++c) tiff += {'\0', static_cast<char>(bits)};
  return tiff + pixels;
}

std::string of_small_picture() {
  const ColorPicture picture = small_picture();
  return {picture.rgb.begin(), picture.rgb.end()};
}

TEST(DecodePicture, ReadsTiffOfEightAndSixteenBitsAndLaysItOnWhite) {
  EXPECT_EQ(decode_picture(tiff_of(5, 4, 3, 8, of_small_picture()), "p.tif").rgb, small_picture().rgb);
  std::string wide, with_alpha;
  const std::string narrow = of_small_picture();
  for (std::size_t i = 0; i < narrow.size(); ++i) {
    wide += {narrow[i], narrow[i]};
    with_alpha += narrow[i];
    if (i % 3 == 2) with_alpha += '\0';
  }
  EXPECT_EQ(decode_picture(tiff_of(5, 4, 3, 16, wide), "p.tif").rgb, small_picture().rgb);
  EXPECT_THAT(refusal(tiff_of(5, 4, 4, 8, with_alpha, {{338, 3, 2}})), HasSubstr("without colour"));  // all of it white
  for (std::size_t i = 3; i < with_alpha.size(); i += 4) with_alpha[i] = '\x80';
  const ColorPicture half = decode_picture(tiff_of(5, 4, 4, 8, with_alpha, {{338, 3, 2}}), "p.tif");
  for (std::size_t i = 0; i < half.rgb.size(); ++i)
    EXPECT_NEAR(half.rgb[i], 255 - (255 - small_picture().rgb[i]) * 128 / 255, 1) << i;
}

TEST(DecodePicture, RefusesATiffThatIsCutShortAtAnyByte) {
  const std::string whole = tiff_of(5, 4, 3, 8, of_small_picture());
  EXPECT_EQ(refusal(whole), "accepted");
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_NE(refusal(whole.substr(0, length)), "accepted") << length;
}

TEST(DecodePicture, RefusesATiffThatClaimsMoreThanItHolds) {
  EXPECT_THAT(refusal(tiff_of(14000, 14000, 3, 8, of_small_picture())), HasSubstr("14000 x 14000 pixels in "));
  EXPECT_THAT(refusal(tiff_of(0, 14000, 3, 8, of_small_picture())), HasSubstr("size is zero"));
  const std::string tiles = tiff_of(5, 4, 3, 8, of_small_picture(), {{322, 4, 4096}, {323, 4, 4096}, {325, 4, 60}});
  EXPECT_THAT(refusal(tiles), HasSubstr("1 tiles of 50331648 bytes in "));
  EXPECT_THAT(refusal(tiff_of(5, 4, 4, 255, of_small_picture())), HasSubstr("channels of another type"));
}

/// A picture whose four corners have four colours.
ColorPicture four_corners() {
  ColorPicture picture{48, 32, {}};
  for (int v = 0; v < 32; ++v) {
    for (int u = 0; u < 48; ++u) {
      picture.rgb.push_back(u < 24 ? 220 : 30);
      picture.rgb.push_back(v < 16 ? 220 : 30);
      picture.rgb.push_back(90);
    }
  }
  return picture;
}

/// Where the corners of the file lie in the picture, read along its rows: N, S, W, E.
std::string corners_of(const ColorPicture& of) {
  std::string found;
  for (const int v : {3, of.height - 4}) {
    for (const int u : {3, of.width - 4}) {
      const std::size_t at = 3 * static_cast<std::size_t>(v * of.width + u);
      found += {of.rgb[at] > 128 ? 'W' : 'E', of.rgb[at + 1] > 128 ? 'N' : 'S'};
    }
  }
  return found;
}

/// Of orientation 1, 2 ... 8 (EXIF 2.32, 4.6.4).
constexpr std::array<const char*, 8> kTurned{"WNENWSES", "ENWNESWS", "ESWSENWN", "WSESWNEN",
                                             "WNWSENES", "WSWNESEN", "ESENWSWN", "ENESWNWS"};

TEST(DecodePicture, TurnsAJpegAsItsCameraSaysEightWays) {
  const std::string jpeg = testing::encode_jpeg(four_corners(), 95);
  for (int orientation = 1; orientation <= 8; ++orientation) {
    for (const bool is_big : {false, true}) {
      std::string exif = is_big ? std::string("MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\0\0\0\0\0\0\0", 26)
                                : std::string("II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\0\0\0\0\0\0\0\0", 26);
      exif[is_big ? 19 : 18] = static_cast<char>(orientation);
      const std::string other("\xFF\xE1\0\x06http", 8);  // of another kind, before it
      const std::string block = other +
                                std::string(
                                    "\xFF\xE1\0\x22"
                                    "Exif\0\0",
                                    10) +
                                exif;
      const ColorPicture seen = decode_picture(jpeg.substr(0, 2) + block + jpeg.substr(2), "p.jpg");
      EXPECT_EQ(seen.width, orientation < 5 ? 48 : 32);
      EXPECT_EQ(corners_of(seen), kTurned[static_cast<std::size_t>(orientation - 1)]) << orientation;
    }
  }
}

TEST(DecodePicture, TurnsATiffAsItsCameraSaysEightWays) {
  const ColorPicture whole = four_corners();
  const std::string pixels(whole.rgb.begin(), whole.rgb.end());
  for (std::uint32_t orientation = 1; orientation <= 8; ++orientation) {
    const ColorPicture seen = decode_picture(tiff_of(48, 32, 3, 8, pixels, {{274, 3, orientation}}), "p.tif");
    EXPECT_EQ(seen.width, orientation < 5 ? 48 : 32);
    EXPECT_EQ(corners_of(seen), kTurned[orientation - 1]) << orientation;
  }
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

  EXPECT_THAT(refusal(tiff_of(5, 4, 3, 8, of_small_picture(), {{282, 5, 300}, {283, 5, 150}})),
              HasSubstr("not square (300 in a width, 150 in a height)"));
}

TEST(DecodePicture, RefusesPicturesWithoutColor) {
  ColorPicture grey = small_picture();
  for (std::size_t i = 0; i < grey.rgb.size(); ++i) grey.rgb[i] = grey.rgb[i - i % 3];
  EXPECT_THAT(refusal(encode_png(grey)), HasSubstr("without colour"));
  grey.rgb[0] = static_cast<std::uint8_t>(grey.rgb[1] < 128 ? grey.rgb[1] + 8 : grey.rgb[1] - 8);
  EXPECT_THAT(refusal(encode_png(grey)), HasSubstr("differ by at most 8 at every pixel"));
  const DepthPicture one_channel{2, 2, {1, 2, 3, 4}};
  EXPECT_THAT(refusal(encode_png(one_channel)), HasSubstr("greyscale"));
}

TEST(DecodePicture, RefusesCmyk) {
  std::string jpeg = encode_jpeg(small_picture(), 90);
  const std::size_t frame = jpeg.find("\xFF\xC0");
  ASSERT_NE(frame, std::string::npos);
  jpeg[frame + 3] = static_cast<char>(jpeg[frame + 3] + 3);  // a fourth component
  jpeg[frame + 9] = 4;
  jpeg.insert(frame + 19, std::string("\x04\x11\0", 3));
  EXPECT_THAT(refusal(jpeg), HasSubstr("CMYK"));
  EXPECT_THAT(refusal(tiff_of(5, 4, 4, 8, std::string(80, '\x20'), {{262, 3, 5}})), HasSubstr("CMYK"));
}

TEST(DecodePicture, RefusesAJpegOfThousandsOfEmptyScans) {
  ColorPicture picture{16, 16, std::vector<std::uint8_t>(768, 90)};
  for (std::size_t i = 0; i < 30; ++i) picture.rgb[i] = 220;
  std::string jpeg = encode_jpeg(picture, 60);
  jpeg[jpeg.find("\xFF\xC0") + 1] = '\xC2';  // progressive: its one scan becomes these
  const std::size_t scan = jpeg.find("\xFF\xDA");
  ASSERT_NE(scan, std::string::npos);
  jpeg.resize(scan);
  for (int i = 0; i < 2000; ++i) jpeg += std::string("\xFF\xDA\0\x08\x01\x01\0\0\0\0\0", 11);
  jpeg += "\xFF\xD9";
  EXPECT_THAT(refusal(jpeg), HasSubstr("more than 200 scans"));
}

TEST(DecodeDepth, GivesBackCountsAndRefusesColor) {
  const DepthPicture depth{3, 2, {0, 1, 500, 65535, 7, 8}};
  EXPECT_EQ(decode_depth(encode_png(depth), "d.png").counts, depth.counts);
  EXPECT_THROW(static_cast<void>(decode_depth(encode_png(small_picture()), "d.png")), DataError);
  const std::string big_endian("\0\0\0\1\x01\xF4\xFF\xFF\0\x07\0\x08", 12);
  EXPECT_EQ(decode_depth(tiff_of(3, 2, 1, 16, big_endian), "d.tif").counts, depth.counts);
  const DepthPicture turned = decode_depth(tiff_of(3, 2, 1, 16, big_endian, {{274, 3, 6}}), "d.tif");
  EXPECT_EQ(turned.width, 2);
  EXPECT_EQ(turned.counts, (std::vector<std::uint16_t>{65535, 0, 7, 1, 8, 500}));
  std::string tile(16 * 16 * 2, '\0');
  for (std::size_t i = 0; i < 6; ++i) tile.replace(32 * (i / 3) + 2 * (i % 3), 2, big_endian.substr(2 * i, 2));
  const std::string tiled = tiff_of(3, 2, 1, 16, tile, {{322, 3, 16}, {323, 3, 16}, {325, 4, 512}});
  EXPECT_EQ(decode_depth(tiled, "d.tif").counts, depth.counts);
  EXPECT_THROW(static_cast<void>(decode_depth(encode_png(DepthPicture{2, 1, {0, 0}}), "d.png")), DataError);
}

}  // namespace
}  // namespace incise
