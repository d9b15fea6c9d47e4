#include "report/slices.hpp"

#include "report/markup.hpp"

#include <gmock/gmock.h>
#include <png.h>

#include <vector>

namespace incise {
namespace {

const std::array<std::string, 6> kNames{"R", "L", "A", "P", "I", "S"};

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> grey;
  [[nodiscard]] int at(int column, int row) const { return grey[static_cast<std::size_t>(row * width + column)]; }
};

Picture decoded(const std::string& uri) {
  const std::string file = testing::decoded_base64(uri.substr(uri.find(',') + 1));
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, file.data(), file.size()), 0);
  image.format = PNG_FORMAT_GRAY;
  Picture picture{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  picture.grey.resize(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, picture.grey.data(), 0, nullptr), 0);
  return picture;
}

/// 8 x 6 x 4 voxels of 1 mm, air but for one bright voxel at index (1, 1, 0).
CtPicture one_bright_voxel(const Mat3& direction) {
  CtPicture picture;
  picture.ct.grid = {.size = {8, 6, 4}, .direction = direction};
  picture.ct.voxels.assign(picture.ct.grid.voxel_count(), kAirHu);
  picture.ct.at(1, 1, 0) = 3000;
  return picture;
}

TEST(SlicePlanes, PutThePatientsRightAtTheLeftAndTheFrontUp) {
  const auto planes = slice_planes(one_bright_voxel(Mat3::Identity()), kNames, 4);
  const Picture axial = decoded(planes[0].slices[0].image_uri);
  EXPECT_EQ(axial.width, 8);
  EXPECT_EQ(axial.height, 6);
  EXPECT_EQ(axial.at(1, 1), 255);  // x = 1: towards R, at the left; y = 1: towards A, at the top
  EXPECT_EQ(axial.at(6, 4), 0);
  EXPECT_THAT(planes[0].ends, ::testing::ElementsAre("R", "L", "A", "P"));
  EXPECT_THAT(planes[1].ends, ::testing::ElementsAre("R", "L", "S", "I"));
  EXPECT_THAT(planes[2].ends, ::testing::ElementsAre("A", "P", "S", "I"));
}

TEST(SlicePlanes, FollowAVolumeWhoseAxesRunBackwards) {
  const Mat3 flipped = Vec3(-1, -1, 1).asDiagonal();  // i towards R, j towards A
  const auto planes = slice_planes(one_bright_voxel(flipped), kNames, 4);
  EXPECT_EQ(decoded(planes[0].slices[0].image_uri).at(6, 4), 255);
}

TEST(SlicePlanes, FollowAVolumeWhoseAxesAreSwapped) {
  Mat3 swapped;  // i runs along z, j along x, k along y
  swapped << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  const auto planes = slice_planes(one_bright_voxel(swapped), kNames, 8);
  EXPECT_DOUBLE_EQ(planes[0].width_mm, 6.0);
  EXPECT_DOUBLE_EQ(planes[0].height_mm, 4.0);
  ASSERT_EQ(planes[0].slices.size(), 8U);
  EXPECT_DOUBLE_EQ(planes[0].slices[1].position_mm, 1.0);
  EXPECT_EQ(decoded(planes[0].slices[1].image_uri).at(1, 0), 255);
}

TEST(SlicePlanes, TakeEvenlySpacedSlicesInAscendingOrder) {
  const auto planes = slice_planes(one_bright_voxel(Mat3::Identity()), kNames, 2);
  ASSERT_EQ(planes[0].slices.size(), 2U);
  EXPECT_DOUBLE_EQ(planes[0].slices[0].position_mm, 1.0);
  EXPECT_DOUBLE_EQ(planes[0].slices[1].position_mm, 3.0);
}

TEST(SlicePlanes, OutlineTissueGivenOnAnotherGrid) {
  CtPicture picture = one_bright_voxel(Mat3::Identity());
  picture.occupancy.grid = {.size = {4, 3, 2}, .spacing_mm = {2, 2, 2}, .origin_mm = {0.5, 0.5, 0.5}};
  picture.occupancy.voxels.assign(24, 0.0F);
  picture.occupancy.at(1, 1, 0) = picture.occupancy.at(1, 1, 1) = 1.0F;  // centre at (2.5, 2.5)
  const auto planes = slice_planes(picture, kNames, 4);
  EXPECT_THAT(planes[0].slices[0].outline, ::testing::StartsWith("M"));
  EXPECT_THAT(planes[0].slices[0].outline, ::testing::EndsWith("Z"));
}

TEST(SliceSvg, IsWholeAndHasAScale) {
  const auto planes = slice_planes(one_bright_voxel(Mat3::Identity()), kNames, 1);
  const std::string svg = slice_svg(planes[0], planes[0].slices[0]);
  EXPECT_EQ(testing::nesting_problem(svg), "");
  EXPECT_THAT(svg, ::testing::HasSubstr("1 mm</text>"));
  EXPECT_THAT(svg, ::testing::HasSubstr("aria-label=\"axial CT slice\""));
}

}  // namespace
}  // namespace incise
