#include "imaging/png_slice.hpp"
#include "support/data_dir.hpp"

#include <incise/imaging/segmentation.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace incise {
namespace {

// Slices first..last of the Visible Human Female's head: x = column, y = row, z = number of the slice, mm.
CtVolume read_head(int first, int last) {
  const auto folder = *testing::data_dir() / "ct" / "vhf_head_png";
  CtVolume ct;
  for (int number = first; number <= last; ++number) {
    const testing::PngSlice slice = testing::read_png_slice(folder / ("texture-" + std::to_string(number) + ".png"));
    ct.grid.size = {slice.width, slice.height, last - first + 1};
    for (const unsigned char grey : slice.grey) ct.voxels.push_back(static_cast<std::int16_t>(16 * grey - 1024));
  }
  ct.grid.origin_mm = Vec3(0.0, 0.0, first);
  return ct;
}

// The tongue fills the closed mouth: a slit of air lies on part of its back, the rest touches palate and cheeks. The
// box leaves out what lies beside and below it; the opening takes off the thin wedge of palate between the slit and the
// top of the box.
SegmentationSettings head_settings() {
  SegmentationSettings settings;
  settings.roi_box_mm = Box3(Vec3(223, 150, 42), Vec3(273, 208, 77));
  settings.seeds_mm = {Vec3(247, 190, 60)};
  settings.opening_radius_mm = 4.0;
  settings.smoothing_mm = 1.2;
  return settings;
}

// z of the highest tissue at a column of the world, or NaN.
double top_mm(const Segmentation& result, double x_mm, double y_mm) {
  const VolumeGrid& grid = result.labels.grid;
  const Eigen::Array3i at = grid.index_from_world(Vec3(x_mm, y_mm, grid.origin_mm.z())).array().round().cast<int>();
  for (int k = grid.size[2] - 1; k >= 0; --k)
    if (result.labels.at(at[0], at[1], k) != 0) return grid.origin_mm.z() + k;
  return std::numeric_limits<double>::quiet_NaN();
}

class HeadCt : public ::testing::Test {
 protected:
  void SetUp() override {
    INCISE_NEEDS_DATA_DIR();
    Monitor monitor;
    Workers workers(2);
    ct_ = read_head(30, 90);
    result_ = segment(ct_, head_settings(), workers, monitor);
  }
  CtVolume ct_;
  Segmentation result_;
};

TEST_F(HeadCt, YieldsOneConnectedBodyOfATonguesSize) {
  const std::array<int, 3>& size = result_.labels.grid.size;
  const int margin = 2 * head_settings().margin_voxels;
  EXPECT_NEAR(size[0] - margin, 51, 1);  // mm, as the voxels are 1 mm
  EXPECT_NEAR(size[1] - margin, 59, 2);
  EXPECT_NEAR(size[2] - margin, 36, 1);
  EXPECT_NEAR(result_.volume_mm3, 71500.0, 1500.0);
  EXPECT_NEAR(result_.occupancy_volume_mm3 / result_.volume_mm3, 1.0, 0.01);
  EXPECT_NEAR(result_.tissue_hu.value(), 48.0, 16.0);

  Monitor monitor;
  Workers workers(2);
  CtVolume of_label{result_.labels.grid, {}};
  for (const std::uint8_t label : result_.labels.voxels) of_label.voxels.push_back(label != 0 ? 50 : -1000);
  EXPECT_EQ(segment(of_label, {}, workers, monitor).components, 1U);
}

TEST_F(HeadCt, FreesTheBackWhereAirLiesOnIt) {
  // The slit of air over the middle of the back begins at z = 72..76, here read from the slices.
  EXPECT_NEAR(top_mm(result_, 250.0, 164.0), 72.0, 1.0);
  EXPECT_NEAR(top_mm(result_, 250.0, 168.0), 74.0, 1.0);
  EXPECT_NEAR(top_mm(result_, 250.0, 174.0), 75.0, 1.0);
  EXPECT_NEAR(top_mm(result_, 246.0, 180.0), 75.0, 1.0);
}

TEST_F(HeadCt, HoldsHardlyAnyBone) {
  std::size_t bone = 0;
  const VolumeGrid& grid = result_.labels.grid;
  for (int k = 0; k < grid.size[2]; ++k)
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i < grid.size[0]; ++i) {
        const Eigen::Array3i at =
            ct_.grid.index_from_world(grid.world_from_index(Vec3(i, j, k))).array().round().cast<int>();
        if (result_.labels.at(i, j, k) != 0 && ct_.at(at[0], at[1], at[2]) > 400) ++bone;
      }
  EXPECT_LT(static_cast<double>(bone) / static_cast<double>(result_.voxels), 0.005);
}

TEST_F(HeadCt, LeavesRoomForARingOf30MmWith4MmToSpareOnTheBack) {
  constexpr double kCenterX = 248.0;
  constexpr double kCenterY = 175.0;
  const double center = top_mm(result_, kCenterX, kCenterY);
  for (double angle = 0.0; angle < 6.28; angle += 0.1) {
    const double edge = top_mm(result_, kCenterX + 19.0 * std::cos(angle), kCenterY + 19.0 * std::sin(angle));
    EXPECT_LT(std::abs(center - edge), 10.0) << "at " << angle;
  }
}

}  // namespace
}  // namespace incise
