// Real scans: facts that are known about them from elsewhere (headers as other tools print them, label files of the
// same scan).
#include "io_volume/handmade_files.hpp"
#include "support/data_dir.hpp"
#include "support/monitors.hpp"
#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/io/volume_io.hpp>

#include <gmock/gmock.h>

#include <algorithm>

namespace incise {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace incise::testing;

class SharedCt : public ::testing::Test {
 protected:
  void SetUp() override { INCISE_NEEDS_DATA_DIR(); }
  [[nodiscard]] static ReadVolume read(const std::string& name, const CtReadSettings& settings = {}) {
    RecordingMonitor monitor;
    ::testing::internal::CaptureStderr();
    ReadVolume result = read_ct(*data_dir() / "ct" / name, settings, monitor);
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    return result;
  }
  [[nodiscard]] static std::pair<int, int> range(const CtVolume& ct) {
    const auto [low, high] = std::minmax_element(ct.voxels.begin(), ct.voxels.end());
    return {*low, *high};
  }
};

TEST_F(SharedCt, PhilipsPhantomIsSortedAndRegular) {
  const ReadVolume result = read("philips_phantom_dicom");
  const CtVolume& ct = result.volume;
  EXPECT_THAT(ct.grid.size, ElementsAre(512, 512, 28));
  EXPECT_TRUE(ct.grid.spacing_mm.isApprox(Vec3(0.451171875, 0.451171875, 5)));
  EXPECT_TRUE(ct.grid.origin_mm.isApprox(Vec3(-115.5, -1.85, 696.21)));
  EXPECT_TRUE(ct.grid.direction.isApprox(Mat3::Identity()));
  EXPECT_EQ(range(ct), std::pair(-1024, 782));
  EXPECT_THAT(result.diagnostics.notices, IsEmpty());
}

TEST_F(SharedCt, GeHeadIsFoundTiltedAndUneven) {
  const ReadVolume result = read("ge_head_dicom");
  const CtReadDiagnostics& told = result.diagnostics;
  EXPECT_THAT(told.notices, ElementsAre(AllOf(HasSubstr("gantry tilt of 18.5 deg"),
                                              HasSubstr("uneven slice steps of 1.081 to 6.999 mm"))));
  EXPECT_NEAR(told.gantry_tilt_deg, 18.5, 1e-3);
  EXPECT_EQ(told.slices, 28);
  // Table steps of 1.14 and 7.38 mm, seen along the tilted normal.
  EXPECT_NEAR(told.min_step_mm, 1.14 * 0.9483237, 2e-3);
  EXPECT_NEAR(told.max_step_mm, 7.38 * 0.9483237, 2e-3);
  EXPECT_GT(told.padding_voxels, 1000000U);
  const CtVolume& ct = result.volume;
  EXPECT_GE(range(ct).first, -1024);  // padding of -1500 is gone
  EXPECT_LE(range(ct).second, 2121);
  EXPECT_GT(range(ct).second, 2000);
  EXPECT_LT((ct.grid.direction.transpose() * ct.grid.direction - Mat3::Identity()).norm(), 1e-9);
  // The first slice lies unchanged on the grid: its corner is where its header says.
  const Vec3 corner = ct.grid.index_from_world(Vec3(-125, -123.5404569, 21.1745158 - 15.3384572));
  EXPECT_NEAR(corner[0], 0, 1e-6);
}

TEST_F(SharedCt, GeHeadIsRefusedOnRequest) {
  EXPECT_THAT(message_of<DataError>([] {
                RecordingMonitor monitor;
                (void)read_ct(*data_dir() / "ct" / "ge_head_dicom", {.irregular = IrregularSlices::Refuse}, monitor);
              }),
              AllOf(HasSubstr("gantry tilt"), HasSubstr("uneven")));
}

TEST_F(SharedCt, Jpeg2000SeriesIsDecodedWhereItsLabelsLie) {
  const ReadVolume result = read("totalsegmentator/example_ct_dicom");
  const CtVolume& ct = result.volume;
  EXPECT_THAT(ct.grid.size, ElementsAre(512, 512, 20));
  EXPECT_TRUE(ct.grid.spacing_mm.isApprox(Vec3(0.9765625, 0.9765625, 2)));  // thickness is 3
  EXPECT_EQ(range(ct).first, -1024);
  // Labels of the same scan, converted by others to NIfTI with rows the other way round: both grids fill the same box.
  const LabelVolume labels = read_labels(*data_dir() / "ct/totalsegmentator/example_seg_dicom.nii.gz");
  const Vec3 last(511, 511, 19);
  EXPECT_LT((labels.grid.world_from_index(Vec3(0, 511, 0)) - ct.grid.world_from_index(Vec3::Zero())).norm(), 1e-3);
  EXPECT_LT((labels.grid.world_from_index(Vec3(511, 0, 19)) - ct.grid.world_from_index(last)).norm(), 1e-3);
  // Vertebrae (labels 26 to 50 of TotalSegmentator) are denser than the muscles (80 to 89) beside them.
  double bone = 0;
  double muscle = 0;
  int bone_count = 0;
  int muscle_count = 0;
  for (int k = 0; k < 20; ++k) {
    for (int j = 0; j < 512; ++j) {
      for (int i = 0; i < 512; ++i) {
        const int label = labels.at(i, 511 - j, k);
        if (label >= 26 && label <= 50) bone += ct.at(i, j, k), ++bone_count;
        if (label >= 80 && label <= 89) muscle += ct.at(i, j, k), ++muscle_count;
      }
    }
  }
  ASSERT_GT(bone_count, 1000);
  ASSERT_GT(muscle_count, 1000);
  EXPECT_GT(bone / bone_count, 100);
  EXPECT_GT(muscle / muscle_count, -30);
  EXPECT_LT(muscle / muscle_count, 90);
}

TEST_F(SharedCt, NiftiOfWideIntegersIsRead) {
  const CtVolume ct = read("totalsegmentator/example_ct.nii.gz").volume;
  EXPECT_THAT(ct.grid.size, ElementsAre(122, 101, 112));
  EXPECT_TRUE(ct.grid.spacing_mm.isApprox(Vec3(3, 3, 3), 1e-6));
  EXPECT_EQ(range(ct), std::pair(-1207, 3382));
  // Axes R, A, S: i runs to the right and j to the front, against LPS.
  EXPECT_TRUE(ct.grid.direction.isApprox(Vec3(-1, -1, 1).asDiagonal().toDenseMatrix(), 1e-6));
}

TEST_F(SharedCt, NiftiLabelsLieOnTheirCt) {
  const CtVolume ct = read("totalsegmentator/example_ct_sm.nii.gz").volume;
  const LabelVolume labels = read_labels(*data_dir() / "ct/totalsegmentator/example_seg.nii.gz");
  EXPECT_THAT(labels.grid.size, ElementsAre(122, 101, 30));
  EXPECT_LT(grid_distance_mm(ct.grid, labels.grid), 1e-3);
  EXPECT_EQ(*std::max_element(labels.voxels.begin(), labels.voxels.end()), 117);
}

TEST_F(SharedCt, HeadPicturesShowTheTongueInPlace) {
  const ReadVolume result = read("vhf_head_png", {.spacing_mm = Vec3(1, 1, 1), .hu = GrayToHu{16, -1024}});
  const CtVolume& ct = result.volume;
  EXPECT_THAT(ct.grid.size, ElementsAre(512, 512, 234));
  EXPECT_EQ(range(ct).first, -1024);
  // Middle of the tongue (column 244, row 185, slice 55) is muscle; slice 55 as text would sort far elsewhere.
  double sum = 0;
  for (int j = 180; j < 190; ++j) sum += ct.at(244, j, 55);
  EXPECT_GT(sum / 10, 0);
  EXPECT_LT(sum / 10, 100);
  EXPECT_EQ(ct.at(0, 0, 233), -1024);
}

TEST_F(SharedCt, EveryFormatKeepsARealScan) {
  const CtVolume ct = read("totalsegmentator/example_ct.nii.gz").volume;
  const TemporaryFolder folder;
  RecordingMonitor monitor;
  for (const char* name : {"a.nrrd", "a.nii.gz", "a.mha"}) {
    write_ct(folder / name, ct);
    const CtVolume back = read_ct(folder / name, {}, monitor).volume;
    EXPECT_TRUE(back.voxels == ct.voxels) << name;
    EXPECT_LT(grid_distance_mm(back.grid, ct.grid), 1e-3) << name;
  }
  write_dicom_series(folder / "series", ct);
  const CtVolume back = read_ct(folder / "series", {}, monitor).volume;
  EXPECT_TRUE(back.voxels == ct.voxels);
  EXPECT_LT(grid_distance_mm(back.grid, ct.grid), 1e-3);
}

}  // namespace
}  // namespace incise
