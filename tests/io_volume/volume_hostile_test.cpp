// Volumes that were made, or happened, to do harm: each ends in one sentence that names the file, whatever the image libraries do.
#include "io_volume/handmade_files.hpp"
#include "support/monitors.hpp"
#include "support/temporary_folder.hpp"

#include <incise/io/volume_io.hpp>

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <zlib.h>

namespace incise {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using namespace incise::testing;

class HostileVolume : public ::testing::Test {
 protected:
  std::string says(const char* name, const std::string& bytes) {
    write_bytes(folder / name, bytes);
    RecordingMonitor monitor;
    return message_of<DataError>([&] { (void)read_ct(folder / name, {}, monitor); });
  }
  /// A stack of two pictures, the second of them as given.
  std::string stack_says(const std::string& second) {
    const fs::path stack = folder / "stack";
    fs::create_directory(stack);
    write_bytes(stack / "0.png", png_bytes(3, 2, 8, 0, std::string(6, '\1')));
    write_bytes(stack / "1.png", second);
    CtReadSettings settings{.spacing_mm = Vec3(1, 1, 1), .hu = GrayToHu{}};
    RecordingMonitor monitor;
    return message_of<DataError>([&] { (void)read_ct(stack, settings, monitor); });
  }
  TemporaryFolder folder;
};

/// A PNG file of these chunks, each with its sum.
std::string png_of(const std::vector<std::pair<std::string, std::string>>& chunks) {
  std::string all = "\x89PNG\r\n\x1a\n";
  for (const auto& [name, content] : chunks) {
    const std::string body = name + content;
    all += big_endian(content.size(), 4) + body +
           big_endian(crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())), 4);
  }
  return all;
}

std::string png_header(std::uint32_t width, std::uint32_t height, int interlace = 0) {
  return big_endian(width, 4) + big_endian(height, 4) + std::string{8, 0, 0, 0, static_cast<char>(interlace)};
}

TEST_F(HostileVolume, APictureWithoutPixelsWithoutWidthOrWithABadInterlaceByteEndsNoProcess) {
  EXPECT_THAT(stack_says(png_of({{"IHDR", png_header(3, 2)}, {"IEND", ""}})), AllOf(HasSubstr("1.png"), HasSubstr("a picture that cannot be read (IEND")));
  EXPECT_THAT(stack_says(png_of({{"IHDR", png_header(0, 2)}, {"IDAT", "x"}, {"IEND", ""}})), HasSubstr("a picture that cannot be read (Invalid IHDR data)"));
  EXPECT_THAT(stack_says(png_of({{"IHDR", png_header(3, 2, 77)}, {"IDAT", "x"}, {"IEND", ""}})), HasSubstr("a picture that cannot be read (Invalid IHDR data)"));
  EXPECT_THAT(stack_says(png_of({{"IHDR", png_header(3, 2)}, {"IDAT", "not packed"}, {"IEND", ""}})), HasSubstr("a picture that cannot be read (IDAT: "));
  EXPECT_THAT(stack_says(png_of({{"IHDR", png_header(40000, 30000)}, {"IDAT", "x"}, {"IEND", ""}})), HasSubstr("40000 x 30000 pixels"));
}

TEST_F(HostileVolume, AnInterlacedPictureIsReadAsItIs) {
  // libpng's own way of seven passes: a gray of one pixel has all of it in the first.
  std::string row("\0\x2a", 2);
  uLongf size = compressBound(row.size());
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(row.data()), row.size());
  packed.resize(size);
  const std::string picture = png_of({{"IHDR", png_header(1, 1, 1)}, {"IDAT", packed}, {"IEND", ""}});
  const fs::path stack = folder / "stack";
  fs::create_directory(stack);
  write_bytes(stack / "0.png", picture);
  write_bytes(stack / "1.png", picture);
  CtReadSettings settings{.spacing_mm = Vec3(1, 1, 1), .hu = GrayToHu{}};
  RecordingMonitor monitor;
  EXPECT_EQ(read_ct(stack, settings, monitor).volume.voxels, (std::vector<std::int16_t>{42, 42}));
}

const std::string kGeometry = "space: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n";

TEST_F(HostileVolume, ANrrdWithoutItsBlankLineOrOfFarMoreVoxelsThanBytes) {
  EXPECT_THAT(says("a.nrrd", "NRRD0004\ntype: short\ndimension: 3\nsizes: 2 2 2\nencoding: raw\nendian: little\n" + kGeometry), HasSubstr("no blank line"));
  EXPECT_THAT(says("b.nrrd", "NRRD0004\ntype: short\ndimension: 3\nsizes: 1000 1000 1000\nencoding: raw\nendian: little\n" + kGeometry + "\nxx"),
              AllOf(HasSubstr("b.nrrd"), HasSubstr("2000000000 bytes of voxels")));
}

TEST_F(HostileVolume, AMetaImageOfNoOrVeryManyAxes) {
  for (const char* count : {"-3", "100000000", "0", "x", "99999999999999999999"}) {
    EXPECT_THAT(says("a.mha", fmt::format("ObjectType = Image\nNDims = {}\nDimSize = 2 2 2\nElementType = MET_SHORT\nElementDataFile = LOCAL\n", count)),
                AllOf(HasSubstr("a.mha"), HasSubstr("NDims")))
        << count;
  }
}

TEST_F(HostileVolume, AbsurdSpacing) {
  const std::string begin = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\nspace: left-posterior-superior\nspace origin: (0,0,0)\n";
  for (const char* spacing : {"1e-9", "1e9"}) {
    EXPECT_THAT(says("a.nrrd", begin + fmt::format("space directions: ({0},0,0) (0,{0},0) (0,0,{0})\n\n12345678", spacing)), HasSubstr("spacing")) << spacing;
  }
  for (const char* first : {"(1e200,0,0)", "(1e155,0,0)", "(0,1e308,1e308)", "none", "(nan,0,0)", "(x,0,0)"}) {
    EXPECT_THAT(says("a.nrrd", begin + fmt::format("space directions: {} (0,1,0) (0,0,1)\n\n12345678", first)),
                HasSubstr("a.nrrd"))
        << first;
  }
  EXPECT_THAT(says("a.nrrd", begin + "space directions: (1e200,0,0) (0,1,0) (0,0,1)\n\n12345678"),
              AllOf(HasSubstr("space directions: found voxel spacing inf along axis 0"), HasSubstr("0.0001 to")));
  EXPECT_THAT(says("a.nrrd", begin + "space directions: none (0,1,0) (0,0,1)\n\n12345678"),
              HasSubstr("space directions: found 'none (0,1,0) (0,0,1)', expected the voxel size along three axes"));
  EXPECT_THAT(
      says("a.nrrd", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\nspacings: nan 1 1\n\n12345678"),
      HasSubstr("spacings: found voxel spacing nan"));
  EXPECT_THAT(says("a.nrrd", begin + "space directions: (0.01,0,0) (0,1,0) (0,0,100)\n\n12345678"),
              AllOf(HasSubstr("a.nrrd: spacing: found voxels of 0.01 x 1 x 100 mm"),
                    HasSubstr("at most 50 times the shortest")));
  for (const char* spacing : {"1e-300\\1", "1e300\\1e300", "1e-7\\1e-7"}) {
    const fs::path series = folder / "series";
    fs::create_directory(series);
    for (int k = 0; k < 2; ++k) {
      write_bytes(series / fmt::format("{}.dcm", k), HandmadeSlice(2, 2, Vec3(0, 0, k), {1, 2, 3, 4}).text(0x00280030, "DS", spacing).bytes());
    }
    RecordingMonitor monitor;
    EXPECT_THAT(message_of<DataError>([&] { (void)read_ct(series, {}, monitor); }), HasSubstr("PixelSpacing")) << spacing;
  }
  const fs::path far_away = folder / "far";
  fs::create_directory(far_away);
  for (int k = 0; k < 2; ++k) write_bytes(far_away / fmt::format("{}.dcm", k), HandmadeSlice(2, 2, Vec3(0, 0, 1e200 * k), {1, 2, 3, 4}).bytes());
  RecordingMonitor monitor;
  EXPECT_THAT(message_of<DataError>([&] { (void)read_ct(far_away, {}, monitor); }), HasSubstr("ImagePositionPatient"));
}

TEST_F(HostileVolume, AnNrrdInOtherUnitsThanMillimetres) {
  const std::string begin = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n";
  EXPECT_THAT(says("a.nrrd", begin + kGeometry + "space units: \"m\" \"m\" \"m\"\n\n12345678"),
              HasSubstr("space units: found 'm' for axis 0, expected \"mm\""));
  EXPECT_THAT(says("a.nrrd", begin + kGeometry + "space units: \"mm\" \"mm\" \"um\"\n\n12345678"),
              HasSubstr("space units: found 'um' for axis 2"));
  EXPECT_THAT(says("a.nrrd", begin + "spacings: 1 1 1\nunits: \"cm\" \"cm\" \"cm\"\n\n12345678"),
              HasSubstr("units: found 'cm' for axis 0"));
  write_bytes(folder / "b.nrrd",
              begin + kGeometry + "space units: \"mm\" \"Millimeter\" \"\"\nspace units:=m\n\n12345678");
  RecordingMonitor monitor;
  EXPECT_EQ(read_ct(folder / "b.nrrd", {}, monitor).volume.grid.spacing_mm, Vec3(1, 1, 1));
}

TEST_F(HostileVolume, APipeHangsNobody) {
  ASSERT_EQ(::mkfifo((folder / "ct.nrrd").c_str(), 0600), 0);
  RecordingMonitor monitor;
  EXPECT_THAT(message_of<DataError>([&] { (void)read_ct(folder / "ct.nrrd", {}, monitor); }), HasSubstr("found a pipe"));
  write_bytes(folder / "a.mhd", "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementSpacing = 1 1 1\nElementType = MET_UCHAR\nElementDataFile = /dev/zero\n");
  EXPECT_THAT(message_of<DataError>([&] { (void)read_ct(folder / "a.mhd", {}, monitor); }),
              AllOf(HasSubstr("a.mhd"), HasSubstr("found a device ('/dev/zero')")));
}

TEST_F(HostileVolume, ASeriesWhoseNumbersOverflowIsNoSeries) {
  for (const char* numbers :
       {"-9223372036854775807 9223372036854775807 1", "1 9223372036854775807 9223372036854775806"}) {
    const std::string header =
        "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementSpacing = 1 1 1\nElementType = MET_SHORT\n";
    EXPECT_THAT(says("a.mhd", header + "ElementDataFile = s%d.raw " + numbers + "\n"), HasSubstr("a.mhd")) << numbers;
  }
}

TEST_F(HostileVolume, AHeaderWhoseDataAreAFolderIsTheFileThatIsNamed) {
  const std::string said = says("ct.nhdr",
                                "NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: 2 2 "
                                "2\nspace directions: (2,0,0) (0,2,0) (0,0,2)\n"
                                "encoding: raw\nendian: little\nspace origin: (0,0,0)\ndata file: .\n");
  EXPECT_THAT(said, AllOf(HasSubstr("ct.nhdr: data file: found a folder"), HasSubstr("expected a file")));
}

}  // namespace
}  // namespace incise
