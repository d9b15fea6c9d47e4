// Single-file formats: NRRD, NIfTI, MetaImage.
#include "io_volume/handmade_files.hpp"
#include "support/monitors.hpp"
#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/io/volume_io.hpp>

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <limits>

namespace incise {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace incise::testing;

const std::string kOneMillimetre =
    "space: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n";

ReadVolume read_quietly(const fs::path& path) {
  RecordingMonitor monitor;
  return read_ct(path, {}, monitor);
}

std::string failure_of(const fs::path& path) {
  return message_of<DataError>([&path] { (void)read_quietly(path); });
}

/// File name, and how far a corner may move: only NIfTI holds geometry in single precision.
struct FormatCase {
  const char* name;
  double tolerance_mm;
};

class EveryFormat : public ::testing::TestWithParam<FormatCase> {
 protected:
  TemporaryFolder folder;
  fs::path file = folder / GetParam().name;

  /// The file that holds the voxels: beside the header, or the file itself.
  fs::path voxel_file() const {
    if (file.extension() == ".mhd") return folder / "ct.zraw";
    return file.extension() == ".nhdr" ? folder / "ct.raw.gz" : file;
  }
};

INSTANTIATE_TEST_SUITE_P(Volumes, EveryFormat,
                         ::testing::Values(FormatCase{"ct.nrrd", 1e-11}, FormatCase{"ct.nhdr", 1e-11},
                                           FormatCase{"ct.mha", 1e-11}, FormatCase{"ct.mhd", 1e-11},
                                           FormatCase{"ct.nii", 1e-4}, FormatCase{"ct.nii.gz", 1e-4}),
                         [](const auto& test) {
                           std::string name = test.param.name;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

TEST_P(EveryFormat, ReturnsTheCtThatWasWritten) {
  const CtVolume ct = oblique_ct();
  write_ct(file, ct);
  const ReadVolume back = read_quietly(file);
  EXPECT_EQ(back.volume.voxels, ct.voxels);
  EXPECT_EQ(back.volume.grid.size, ct.grid.size);
  EXPECT_LT(grid_distance_mm(back.volume.grid, ct.grid), GetParam().tolerance_mm);
  EXPECT_THAT(back.diagnostics.notices, IsEmpty());
  EXPECT_FALSE(back.diagnostics.is_resampled);
}

TEST_P(EveryFormat, ReturnsTheLabelsThatWereWritten) {
  LabelVolume labels;
  labels.grid = oblique_ct().grid;
  for (std::size_t v = 0; v < labels.grid.voxel_count(); ++v)
    labels.voxels.push_back(static_cast<std::uint8_t>(v * 2 % 256));
  write_labels(file, labels);
  const LabelVolume back = read_labels(file);
  EXPECT_EQ(back.voxels, labels.voxels);
  EXPECT_LT(grid_distance_mm(back.grid, labels.grid), GetParam().tolerance_mm);
}

TEST_P(EveryFormat, KeepsAMirroredGrid) {
  CtVolume ct = oblique_ct();
  ct.grid.direction.col(0) *= -1;
  write_ct(file, ct);
  const CtVolume back = read_quietly(file).volume;
  EXPECT_EQ(back.voxels, ct.voxels);
  EXPECT_LT(grid_distance_mm(back.grid, ct.grid), GetParam().tolerance_mm);
}

TEST_P(EveryFormat, ReplacesAnOlderFileAndLeavesNothingElse) {
  CtVolume ct = oblique_ct();
  write_ct(file, ct);
  ct.voxels[0] = 77;
  write_ct(file, ct);
  EXPECT_EQ(read_quietly(file).volume.voxels[0], 77);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), voxel_file() == file ? 1 : 2);
}

TEST_P(EveryFormat, RefusesEveryFileThatIsCutShort) {
  write_ct(file, oblique_ct());
  const fs::path voxels = voxel_file();
  const fs::path named = file.extension() == ".nhdr" ? file : voxels;  // the reader of NRRD knows only the header
  const std::string whole = read_bytes(voxels);
  for (const double part : {0.0, 0.02, 0.2, 0.5, 0.8, 0.97}) {
    const auto length = static_cast<std::size_t>(part * static_cast<double>(whole.size()));
    write_bytes(voxels, whole.substr(0, length));
    EXPECT_THAT(failure_of(file), HasSubstr(named.filename().string())) << length << " of " << whole.size() << " bytes";
  }
}

TEST_P(EveryFormat, RefusesATextFileOfThatName) {
  write_bytes(file, "Dear colleague,\nplease find the volume attached.\n");
  EXPECT_THAT(failure_of(file), HasSubstr(file.filename().string()));
}

TEST_P(EveryFormat, RefusesASingleSlice) {
  CtVolume ct = oblique_ct();
  ct.grid.size[2] = 1;
  ct.voxels.resize(ct.grid.voxel_count());
  write_ct(file, ct);
  EXPECT_THAT(failure_of(file), HasSubstr("single slice"));
}

/// No file of this process grows beyond a few kilobytes: what a full disk does to a writer.
class FullDisk {
 public:
  FullDisk() : old_action_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_limit_);
    rlimit small = old_limit_;
    small.rlim_cur = 4096;
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &old_limit_);
    std::signal(SIGXFSZ, old_action_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit old_limit_{};
  void (*old_action_)(int);
};

TEST_P(EveryFormat, LeavesTheOlderFileWhenTheDiskFillsUp) {
  CtVolume noise = oblique_ct();
  write_ct(file, noise);
  const std::string before = read_bytes(file);
  const auto files_before = std::distance(fs::directory_iterator(folder.path()), {});
  noise.grid.size = {40, 40, 40};
  noise.voxels.resize(noise.grid.voxel_count());
  std::uint32_t state = 1;  // values that do not compress
  for (auto& value : noise.voxels) value = static_cast<std::int16_t>((state = state * 1664525U + 1013904223U) >> 16);
  std::string message;
  {
    const FullDisk full_disk;
    message = testing::refusal_of<DataError>([&] { write_ct(file, noise); });
  }
  EXPECT_THAT(message, HasSubstr(file.filename().string()));
  EXPECT_TRUE(read_bytes(file) == before);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), files_before);
}

TEST_P(EveryFormat, RemovesWhatAKilledProcessLeft) {
  const fs::path left = folder / (".." + file.filename().string() + ".4194305.0.part");  // above every process id
  fs::create_directory(left);
  write_ct(file, oblique_ct());
  EXPECT_TRUE(fs::exists(file));
  EXPECT_FALSE(fs::exists(left));
}

TEST_P(EveryFormat, LeavesNothingWhereTheFolderIsMissingOrReadOnly) {
  EXPECT_THAT(message_of<DataError>([&] { write_ct(folder / "no such folder" / GetParam().name, oblique_ct()); }),
              HasSubstr("no such folder"));
  EXPECT_FALSE(fs::exists(folder / "no such folder"));
  fs::create_directory(file);  // a folder in the file's place
  EXPECT_THAT(message_of<DataError>([&] { write_ct(file, oblique_ct()); }), HasSubstr("a folder"));
  EXPECT_THAT(fs::is_empty(file), true);
  if (::geteuid() == 0) return;  // permissions do not hold back root
  const fs::path locked = folder / "locked";
  fs::create_directory(locked);
  fs::permissions(locked, fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THAT(message_of<DataError>([&] { write_ct(locked / GetParam().name, oblique_ct()); }), HasSubstr("locked"));
  EXPECT_TRUE(fs::is_empty(locked));
}

TEST(Nifti, IsRasOnDiskAndLpsInMemory) {
  const TemporaryFolder folder;
  const CtVolume ct = oblique_ct();
  write_ct(folder / "ct.nii", ct);
  // srow_x, srow_y, srow_z of the NIfTI-1 header: three rows of four floats from byte 280 on.
  const std::string bytes = read_bytes(folder / "ct.nii");
  std::array<float, 12> affine{};
  std::memcpy(affine.data(), bytes.data() + 280, sizeof affine);
  const Vec3 signs(-1, -1, 1);
  for (int row = 0; row < 3; ++row) {
    EXPECT_NEAR(affine[4 * row + 3], signs[row] * ct.grid.origin_mm[row], 1e-4);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(affine[4 * row + axis], signs[row] * ct.grid.direction(row, axis) * ct.grid.spacing_mm[axis], 1e-6);
    }
  }
}

TEST(Nrrd, HandmadeFileIsReadAsItSays) {
  const TemporaryFolder folder;
  // Slices run to the feet, spacing differs on each axis, space is RAS: x and y change sign on the way to LPS.
  write_bytes(
      folder / "ct.nrrd",
      nrrd_bytes(
          "short", {2, 1, 2},
          "space: right-anterior-superior\nspace directions: (0.5,0,0) (0,2,0) (0,0,-3)\nspace origin: (10,20,30)\n",
          raw_bytes<std::int16_t>({-1024, 1, 2, 3000})));
  const CtVolume ct = read_quietly(folder / "ct.nrrd").volume;
  EXPECT_THAT(ct.voxels, ElementsAre(-1024, 1, 2, 3000));
  EXPECT_TRUE(ct.grid.spacing_mm.isApprox(Vec3(0.5, 2, 3)));
  EXPECT_TRUE(ct.grid.world_from_index(Vec3(1, 0, 1)).isApprox(Vec3(-10.5, -20, 27)));
}

TEST(Nrrd, RoundsFractionsWithANotice) {
  const TemporaryFolder folder;
  write_bytes(folder / "ct.nrrd",
              nrrd_bytes("float", {2, 1, 2}, kOneMillimetre, raw_bytes<float>({-0.6F, 0.4F, 41.5F, 7.0F})));
  RecordingMonitor monitor;
  const ReadVolume result = read_ct(folder / "ct.nrrd", {}, monitor);
  EXPECT_THAT(result.volume.voxels, ElementsAre(-1, 0, 42, 7));
  EXPECT_THAT(monitor.messages, ElementsAre(HasSubstr("rounded")));
  EXPECT_EQ(monitor.messages, result.diagnostics.notices);
  EXPECT_THAT(monitor.severities, ElementsAre(Severity::Notice));
}

TEST(Nrrd, RefusesANaNAndSaysWhere) {
  const TemporaryFolder folder;
  write_bytes(folder / "ct.nrrd", nrrd_bytes("float", {2, 1, 2}, kOneMillimetre,
                                             raw_bytes<float>({0, 0, 0, std::numeric_limits<float>::quiet_NaN()})));
  EXPECT_THAT(failure_of(folder / "ct.nrrd"), AllOf(HasSubstr("voxel (1, 0, 1)"), HasSubstr("nan")));
}

TEST(Nrrd, RefusesValuesBeyondSixteenBits) {
  const TemporaryFolder folder;
  write_bytes(folder / "ct.nrrd",
              nrrd_bytes("int", {2, 1, 2}, kOneMillimetre, raw_bytes<std::int32_t>({0, 32767, 32768, 0})));
  EXPECT_THAT(failure_of(folder / "ct.nrrd"), AllOf(HasSubstr("voxel (0, 0, 1)"), HasSubstr("32768")));
}

TEST(Nrrd, RefusesAVolumeWithoutSpacing) {
  const TemporaryFolder folder;
  write_bytes(folder / "ct.nrrd", nrrd_bytes("short", {2, 1, 2}, "", raw_bytes<std::int16_t>({0, 0, 0, 0})));
  EXPECT_THAT(failure_of(folder / "ct.nrrd"), HasSubstr("spacing"));
}

TEST(Nrrd, TellsThatNoAnatomicalSpaceIsNamed) {
  const TemporaryFolder folder;
  write_bytes(folder / "ct.nrrd",
              nrrd_bytes("short", {2, 1, 2}, "spacings: 1 1 2\n", raw_bytes<std::int16_t>({0, 0, 0, 0})));
  EXPECT_THAT(read_quietly(folder / "ct.nrrd").diagnostics.notices, ElementsAre(HasSubstr("LPS")));
}

TEST(Nrrd, RefusesSkewedAxes) {
  const TemporaryFolder folder;
  write_bytes(
      folder / "ct.nrrd",
      nrrd_bytes("short", {2, 1, 2},
                 "space: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0.3,1)\nspace origin: (0,0,0)\n",
                 raw_bytes<std::int16_t>({0, 0, 0, 0})));
  EXPECT_THAT(failure_of(folder / "ct.nrrd"), HasSubstr("right angles"));
}

TEST(Nrrd, RefusesColour) {
  const TemporaryFolder folder;
  write_bytes(
      folder / "ct.nrrd",
      "NRRD0004\ntype: unsigned char\ndimension: 4\nsizes: 3 2 1 2\nkinds: RGB-color domain domain domain\nencoding: "
      "raw\n"
      "space: left-posterior-superior\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n\n" +
          std::string(12, 'x'));
  EXPECT_THAT(failure_of(folder / "ct.nrrd"), HasSubstr("colour"));
}

TEST(Nrrd, RefusesASizeBeyondReason) {
  const TemporaryFolder folder;
  write_bytes(folder / "ct.nrrd", nrrd_bytes("short", {90000, 90000, 90000}, kOneMillimetre, "abc"));
  EXPECT_THAT(failure_of(folder / "ct.nrrd"), HasSubstr("voxels"));
}

TEST(MetaImage, RefusesAVolumeWithoutSpacing) {
  const TemporaryFolder folder;
  write_bytes(folder / "ct.mha",
              "ObjectType = Image\nNDims = 3\nDimSize = 2 1 2\nElementType = MET_SHORT\nElementDataFile = LOCAL\n" +
                  std::string(8, '\0'));
  EXPECT_THAT(failure_of(folder / "ct.mha"), HasSubstr("spacing"));
}

TEST(MetaImage, RefusesAHeaderWhoseVoxelsAreMissing) {
  const TemporaryFolder folder;
  write_ct(folder / "ct.mhd", oblique_ct());
  fs::remove(folder / "ct.zraw");
  EXPECT_THAT(failure_of(folder / "ct.mhd"), HasSubstr("ct.mhd"));
}

TEST(ReadLabels, RefusesFractionsAndLargeNumbers) {
  const TemporaryFolder folder;
  write_bytes(folder / "half.nrrd", nrrd_bytes("float", {2, 1, 2}, kOneMillimetre, raw_bytes<float>({0, 1, 0.5F, 1})));
  EXPECT_THAT(message_of<DataError>([&] { (void)read_labels(folder / "half.nrrd"); }),
              AllOf(HasSubstr("voxel (0, 0, 1)"), HasSubstr("0.5"), HasSubstr("[0, 255]")));
  write_bytes(folder / "large.nrrd",
              nrrd_bytes("short", {2, 1, 2}, kOneMillimetre, raw_bytes<std::int16_t>({0, 256, 0, 1})));
  EXPECT_THAT(message_of<DataError>([&] { (void)read_labels(folder / "large.nrrd"); }),
              AllOf(HasSubstr("voxel (1, 0, 0)"), HasSubstr("256")));
  write_bytes(folder / "whole.nrrd", nrrd_bytes("float", {2, 1, 2}, kOneMillimetre, raw_bytes<float>({0, 1, 2, 255})));
  EXPECT_THAT(read_labels(folder / "whole.nrrd").voxels, ElementsAre(0, 1, 2, 255));
}

TEST(ReadCt, RefusesWhatIsNoVolume) {
  const TemporaryFolder folder;
  EXPECT_THAT(failure_of(folder / "absent.nrrd"), HasSubstr("no such file"));
  EXPECT_THAT(failure_of(folder / "absent"), HasSubstr("no such file"));
  write_bytes(folder / "notes.txt", "hello");
  EXPECT_THAT(failure_of(folder / "notes.txt"), AllOf(HasSubstr("'.txt'"), HasSubstr(".nrrd")));
  EXPECT_THAT(failure_of(folder.path()), HasSubstr("without DICOM files or PNG pictures"));
  EXPECT_THAT(message_of<DataError>([&] { (void)read_labels(folder.path()); }),
              AllOf(HasSubstr("a folder"), HasSubstr(".nrrd, .nhdr, .nii")));
  EXPECT_THAT(message_of<DataError>([&] { write_ct(folder / "ct.txt", oblique_ct()); }),
              AllOf(HasSubstr("'.txt'"), HasSubstr(".nrrd, .nhdr, .nii")));
}

TEST(ReadCt, StopsOnRequest) {
  const TemporaryFolder folder;
  write_ct(folder / "ct.nrrd", oblique_ct());
  RecordingMonitor monitor;
  monitor.stop = true;
  EXPECT_THROW((void)read_ct(folder / "ct.nrrd", {}, monitor), Cancelled);
}

TEST(ReadCt, RefusesSettingsThatBelongToAnotherFormat) {
  const TemporaryFolder folder;
  write_ct(folder / "ct.nrrd", oblique_ct());
  RecordingMonitor monitor;
  const auto failure = [&](const CtReadSettings& settings) {
    return message_of<CaseError>([&] { (void)read_ct(folder / "ct.nrrd", settings, monitor); });
  };
  EXPECT_THAT(failure({.spacing_mm = Vec3(1, 1, 1)}), HasSubstr("ct.spacing_mm"));
  EXPECT_THAT(failure({.hu = GrayToHu{}}), HasSubstr("ct.hu"));
  EXPECT_THAT(failure({.first_picture_is_head = true}), HasSubstr("ct.first_picture_is_head"));
  EXPECT_THAT(failure({.series_uid = "1.2"}), HasSubstr("ct.series_uid"));
}

TEST(WriteCt, RefusesAnotherExtensionAndBrokenGrids) {
  const TemporaryFolder folder;
  CtVolume ct = oblique_ct();
  EXPECT_THAT(message_of<DataError>([&] { write_ct(folder / "ct.tif", ct); }), HasSubstr("'.tif'"));
  ct.voxels.pop_back();
  EXPECT_THAT(message_of<InvalidArgument>([&] { write_ct(folder / "ct.nrrd", ct); }),
              HasSubstr("expected 140 voxels, found 139"));
  ct = oblique_ct();
  ct.grid.direction(0, 0) = 2;
  EXPECT_THROW(write_ct(folder / "ct.nrrd", ct), InvalidArgument);
  ct = oblique_ct();
  ct.grid.spacing_mm[1] = 0;
  EXPECT_THROW(write_ct(folder / "ct.nrrd", ct), InvalidArgument);
  ct = oblique_ct();
  ct.grid.origin_mm[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_ct(folder / "ct.nrrd", ct), InvalidArgument);
  EXPECT_THROW(write_ct(folder / "ct.nrrd", CtVolume{}), InvalidArgument);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace incise
