// DICOM series: what each slice says, and what is refused. Slices are put together by hand.
#include "io_volume/handmade_files.hpp"
#include "support/monitors.hpp"
#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/io/volume_io.hpp>

#include <gmock/gmock.h>

namespace incise {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace incise::testing;

ReadVolume read(const fs::path& path, const CtReadSettings& settings = {}) {
  RecordingMonitor monitor;
  return read_ct(path, settings, monitor);
}

/// A 2 x 1 slice at a height, both pixels with one stored value.
HandmadeSlice flat_slice(double z_mm, std::uint16_t stored = 1024) {
  return {2, 1, Vec3(0, 0, z_mm), {stored, stored}};
}

class DicomFolder : public ::testing::Test {
 protected:
  void put(const std::string& name, const HandmadeSlice& slice) const { write_bytes(folder / name, slice.bytes()); }
  [[nodiscard]] std::string failure() const {
    return message_of<DataError>([this] { (void)read(folder.path()); });
  }
  TemporaryFolder folder;
};

TEST_F(DicomFolder, IsSortedByPositionNotByName) {
  put("I10", flat_slice(30, 1003));
  put("I100", flat_slice(10, 1001));
  put("I20", flat_slice(20, 1002));
  const ReadVolume result = read(folder.path());
  EXPECT_THAT(result.volume.voxels, ElementsAre(-23, -23, -22, -22, -21, -21));
  EXPECT_EQ(result.volume.grid.origin_mm, Vec3(0, 0, 10));
  EXPECT_EQ(result.diagnostics.slices, 3);
  EXPECT_EQ(result.diagnostics.format, VolumeFormat::DicomSeries);
  EXPECT_EQ(result.diagnostics.series_uid, "1.2.3");
}

TEST_F(DicomFolder, TakesSpacingFromPositionsNotFromThickness) {
  put("a.dcm", flat_slice(0));  // each says SliceThickness 9
  put("b.dcm", flat_slice(2.5));
  put("c.dcm", flat_slice(5));
  EXPECT_DOUBLE_EQ(read(folder.path()).volume.grid.spacing_mm[2], 2.5);
}

TEST_F(DicomFolder, TakesRowSpacingFirstAndColumnSpacingSecond) {
  put("a.dcm", flat_slice(0).text(0x00280030, "DS", "0.7\\0.4"));
  put("b.dcm", flat_slice(1).text(0x00280030, "DS", "0.7\\0.4"));
  EXPECT_TRUE(read(folder.path()).volume.grid.spacing_mm.isApprox(Vec3(0.4, 0.7, 1)));
}

TEST_F(DicomFolder, RescalesEachFileByItsOwnNumbers) {
  put("a.dcm", flat_slice(0, 100).text(0x00281053, "DS", "2").text(0x00281052, "DS", "-1000"));
  put("b.dcm", flat_slice(1, 100).text(0x00281053, "DS", "3").text(0x00281052, "DS", "+5"));
  EXPECT_THAT(read(folder.path()).volume.voxels, ElementsAre(-800, -800, 305, 305));
}

TEST_F(DicomFolder, RoundsFractionalUnitsWithANotice) {
  put("a.dcm", flat_slice(0, 3).text(0x00281053, "DS", "0.5").text(0x00281052, "DS", "0"));
  put("b.dcm", flat_slice(1, 4).text(0x00281053, "DS", "0.5").text(0x00281052, "DS", "0"));
  const ReadVolume result = read(folder.path());
  EXPECT_THAT(result.volume.voxels, ElementsAre(2, 2, 2, 2));
  EXPECT_THAT(result.diagnostics.notices, ElementsAre(HasSubstr("rounded")));
}

TEST_F(DicomFolder, TurnsPaddingIntoAir) {
  // Signed pixels, padding -1500 as the GE HiSpeed writes it; the other pixel is tissue.
  const std::vector<std::uint16_t> stored{static_cast<std::uint16_t>(-1500), 40};
  for (const int z : {0, 1}) {
    put(fmt::format("{}.dcm", z), HandmadeSlice(2, 1, Vec3(0, 0, z), stored)
                                      .word(0x00280103, 1)
                                      .text(0x00281052, "DS", "0")
                                      .word(0x00280120, -1500, "SS"));
  }
  const ReadVolume result = read(folder.path());
  EXPECT_THAT(result.volume.voxels, ElementsAre(kAirHu, 40, kAirHu, 40));
  EXPECT_EQ(result.diagnostics.padding_voxels, 2U);
}

TEST_F(DicomFolder, TurnsARangeOfPaddingIntoAir) {
  for (const int z : {0, 1}) {
    put(fmt::format("{}.dcm", z), HandmadeSlice(4, 1, Vec3(0, 0, z), {4, 5, 7, 8})
                                      .text(0x00281052, "DS", "0")
                                      .word(0x00280120, 7)
                                      .word(0x00280121, 5));
  }
  EXPECT_THAT(read(folder.path()).volume.voxels, ElementsAre(4, kAirHu, kAirHu, 8, 4, kAirHu, kAirHu, 8));
}

TEST_F(DicomFolder, ReadsOnlyTheBitsStored) {
  // 12 bits stored: what lies above them is not part of the value.
  for (const int z : {0, 1}) {
    put(fmt::format("{}.dcm", z), HandmadeSlice(2, 1, Vec3(0, 0, z), {0x0400, 0x0fff})
                                      .word(0x00280101, 12)
                                      .word(0x00280102, 11)
                                      .word(0x00280103, 1)
                                      .text(0x00281052, "DS", "0"));
  }
  EXPECT_THAT(read(folder.path()).volume.voxels, ElementsAre(1024, -1, 1024, -1));
}

TEST_F(DicomFolder, StacksTowardsRowCrossColumnWhateverTheOrientation) {
  // Coronal: rows to the left of the patient, columns to the feet, so slices go to the front.
  for (const int k : {0, 1, 2}) {
    put(fmt::format("{}.dcm", k), HandmadeSlice(1, 1, Vec3(5, 10.0 + 2 * k, 7), {static_cast<std::uint16_t>(1024 + k)})
                                      .axes(Vec3::UnitX(), -Vec3::UnitZ()));
  }
  const CtVolume ct = read(folder.path()).volume;
  EXPECT_TRUE(ct.grid.direction.col(2).isApprox(Vec3::UnitY()));
  EXPECT_EQ(ct.grid.origin_mm, Vec3(5, 10, 7));
  EXPECT_THAT(ct.voxels, ElementsAre(0, 1, 2));
}

TEST_F(DicomFolder, WithSeveralSeriesNamesThemAndReadsTheChosenOne) {
  put("a0.dcm", flat_slice(0, 1025));
  put("a1.dcm", flat_slice(1, 1025));
  put("b0.dcm", flat_slice(0, 1026).text(0x0020000e, "UI", "1.2.99").text(0x0008103e, "LO", "THIN"));
  put("b1.dcm", flat_slice(4, 1026).text(0x0020000e, "UI", "1.2.99").text(0x0008103e, "LO", "THIN"));
  EXPECT_THAT(failure(), AllOf(HasSubstr("2 series"), HasSubstr("1.2.3"), HasSubstr("1.2.99 ('THIN', CT, 2 files)"),
                               HasSubstr("series_uid")));
  const ReadVolume chosen = read(folder.path(), {.series_uid = "1.2.99"});
  EXPECT_EQ(chosen.volume.voxels[0], 2);
  EXPECT_EQ(chosen.volume.grid.spacing_mm[2], 4);
  EXPECT_THAT(message_of<DataError>([this] { (void)read(folder.path(), {.series_uid = "1.7"}); }), HasSubstr("1.7"));
}

TEST_F(DicomFolder, PassesOverOtherFilesWithANotice) {
  put("a.dcm", flat_slice(0));
  put("b.dcm", flat_slice(1));
  write_bytes(folder / "README.txt", "hello");
  EXPECT_THAT(read(folder.path()).diagnostics.notices, ElementsAre(HasSubstr("passed over: 1")));
}

TEST_F(DicomFolder, RefusesASingleSliceAsFolderAndAsFile) {
  put("a.dcm", flat_slice(0));
  EXPECT_THAT(failure(), HasSubstr("single slice"));
  EXPECT_THAT(message_of<DataError>([this] { (void)read(folder / "a.dcm"); }),
              AllOf(HasSubstr("single slice"), HasSubstr("folder")));
}

TEST_F(DicomFolder, RefusesTwoSlicesAtOnePlace) {
  put("a.dcm", flat_slice(0));
  put("b.dcm", flat_slice(1));
  put("c.dcm", flat_slice(1));
  EXPECT_THAT(failure(), AllOf(HasSubstr("'b.dcm' and 'c.dcm'"), HasSubstr("same place")));
}

TEST_F(DicomFolder, RefusesMixedSizesSpacingsAndOrientations) {
  put("a.dcm", flat_slice(0));
  put("b.dcm", HandmadeSlice(1, 2, Vec3(0, 0, 1), {1, 1}));
  EXPECT_THAT(failure(), AllOf(HasSubstr("b.dcm"), HasSubstr("2 x 1"), HasSubstr("1 x 2 as in 'a.dcm'")));
  put("b.dcm", flat_slice(1).text(0x00280030, "DS", "1\\1.1"));
  EXPECT_THAT(failure(), AllOf(HasSubstr("PixelSpacing"), HasSubstr("1.1")));
  put("b.dcm", flat_slice(1).axes(Vec3::UnitX(), Vec3(0, 0.8, 0.6)));
  EXPECT_THAT(failure(), AllOf(HasSubstr("b.dcm"), HasSubstr("ImageOrientationPatient")));
}

TEST_F(DicomFolder, RefusesWhatIsNoPlainCt) {
  put("a.dcm", flat_slice(0));
  const auto failure_with = [this](const HandmadeSlice& slice) {
    put("b.dcm", slice);
    return failure();
  };
  EXPECT_THAT(failure_with(flat_slice(1).text(0x00080060, "CS", "MR")), AllOf(HasSubstr("'MR'"), HasSubstr("'CT'")));
  EXPECT_THAT(failure_with(flat_slice(1).word(0x00280002, 3).text(0x00280004, "CS", "RGB")), HasSubstr("colour"));
  EXPECT_THAT(failure_with(flat_slice(1).text(0x00280004, "CS", "MONOCHROME1")), HasSubstr("MONOCHROME1"));
  EXPECT_THAT(failure_with(flat_slice(1).text(0x00280008, "IS", "12")), HasSubstr("NumberOfFrames: found 12"));
  EXPECT_THAT(failure_with(flat_slice(1).erase(0x00281053)), HasSubstr("RescaleSlope: found nothing"));
  EXPECT_THAT(failure_with(flat_slice(1).text(0x00281053, "DS", "one")), HasSubstr("RescaleSlope: found 'one'"));
  EXPECT_THAT(failure_with(flat_slice(1).erase(0x00200032)), HasSubstr("ImagePositionPatient: found nothing"));
  EXPECT_THAT(failure_with(flat_slice(1).text(0x00200032, "DS", "1\\2")),
              HasSubstr("ImagePositionPatient: found '1\\2'"));
  EXPECT_THAT(failure_with(flat_slice(1).text(0x00200032, "DS", "1\\2\\nan")), HasSubstr("nan"));
  EXPECT_THAT(failure_with(flat_slice(1).axes(Vec3::UnitX(), Vec3::UnitX())), HasSubstr("right angles"));
  EXPECT_THAT(failure_with(flat_slice(1).text(0x00280030, "DS", "0\\1")), HasSubstr("PixelSpacing"));
  EXPECT_THAT(failure_with(flat_slice(1).word(0x00280100, 32)), HasSubstr("BitsAllocated: found 32"));
  EXPECT_THAT(failure_with(flat_slice(1).erase(0x7fe00010)), HasSubstr("PixelData: found nothing"));
  EXPECT_THAT(failure_with(HandmadeSlice(2, 1, Vec3(0, 0, 1), {7})),
              AllOf(HasSubstr("PixelData: found 2 bytes"), HasSubstr("4 bytes")));
  EXPECT_THAT(failure_with(flat_slice(1, 40000).text(0x00281053, "DS", "2")),
              AllOf(HasSubstr("pixel (0, 0)"), HasSubstr("78976 HU")));
}

TEST_F(DicomFolder, RefusesAnEncodingThatCannotBeDecodedAndNamesIt) {
  put("a.dcm", flat_slice(0).transfer_syntax("1.2.840.10008.1.2.4.100"));  // MPEG2: pixels are not that
  put("b.dcm", flat_slice(1).transfer_syntax("1.2.840.10008.1.2.4.100"));
  EXPECT_THAT(failure(), AllOf(HasSubstr("transfer syntax 1.2.840.10008.1.2.4.100"), HasSubstr("MPEG2")));
  // Fragments that are no picture: MPEG2, JPEG, JPEG-LS, JPEG 2000, run lengths.
  for (const char* syntax : {"1.2.840.10008.1.2.4.100", "1.2.840.10008.1.2.4.50", "1.2.840.10008.1.2.4.70",
                             "1.2.840.10008.1.2.4.80", "1.2.840.10008.1.2.4.90", "1.2.840.10008.1.2.5"}) {
    const std::string junk(100, 'x');
    put("a.dcm", flat_slice(0).transfer_syntax(syntax).encapsulate(junk));
    put("b.dcm", flat_slice(1).transfer_syntax(syntax).encapsulate(junk));
    EXPECT_THAT(failure(), AllOf(HasSubstr(".dcm: PixelData"), HasSubstr(fmt::format("transfer syntax {} (", syntax))));
  }
  put("a.dcm", flat_slice(0).transfer_syntax("1.2.840.10008.1.2.1.99"));
  EXPECT_THAT(failure(), AllOf(HasSubstr("1.2.840.10008.1.2.1.99"), HasSubstr("deflated")));
}

TEST_F(DicomFolder, RefusesASliceCutShortAtAnyByte) {
  put("a.dcm", flat_slice(0));
  const std::string whole = flat_slice(1).bytes();
  RecordingMonitor monitor;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    write_bytes(folder / "b.dcm", whole.substr(0, length));
    EXPECT_THAT(testing::refusal_of<DataError>([&] { return read_ct(folder.path(), {}, monitor); }), HasSubstr("b.dcm"))
        << "a slice of " << length << " of " << whole.size() << " bytes";
  }
}

TEST_F(DicomFolder, RefusesGarbageBehindTheMark) {
  put("a.dcm", flat_slice(0));
  write_bytes(folder / "b", std::string(128, 'x') + "DICM and then a letter to the editor, which is long enough");
  EXPECT_THAT(failure(), HasSubstr("/b: byte"));
}

TEST(WriteDicomSeries, ReturnsTheCtThatWasWritten) {
  const TemporaryFolder folder;
  const CtVolume ct = oblique_ct();
  write_dicom_series(folder / "ct", ct);
  const ReadVolume back = read(folder / "ct");
  EXPECT_EQ(back.volume.voxels, ct.voxels);
  EXPECT_EQ(back.volume.grid.size, ct.grid.size);
  EXPECT_LT(grid_distance_mm(back.volume.grid, ct.grid), 1e-8);  // numbers of at most 16 characters
  EXPECT_THAT(back.diagnostics.notices, IsEmpty());
  EXPECT_FALSE(back.diagnostics.is_resampled);
}

TEST(WriteDicomSeries, WritesPlainCtImageStorage) {
  const TemporaryFolder folder;
  CtVolume ct;
  ct.grid.size = {3, 2, 2};
  ct.grid.spacing_mm = Vec3(0.4, 0.7, 1.25);
  ct.grid.origin_mm = Vec3(-10, 20, 30.5);
  ct.voxels = {-1024, 0, 1, 2, 3, 3071, 5, 6, 7, 8, 9, 32767};
  write_dicom_series(folder / "ct", ct, {.patient_name = "Müller^Zunge"});
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "ct"), {}), 2);
  auto fields = dicom_fields(folder / "ct" / "IM0002.dcm");
  EXPECT_EQ(fields[0x00020010], std::string("1.2.840.10008.1.2.1\0", 20));
  EXPECT_EQ(fields[0x00080016], std::string("1.2.840.10008.5.1.4.1.1.2\0", 26));
  EXPECT_EQ(fields[0x00020003], fields[0x00080018]);
  EXPECT_EQ(fields[0x00080060], "CT");
  EXPECT_EQ(fields[0x00080005], "ISO_IR 192");
  EXPECT_EQ(fields[0x00100010], "Müller^Zunge ");
  EXPECT_EQ(fields[0x00180050], "1.25");
  EXPECT_EQ(fields[0x00200013], "2 ");
  EXPECT_EQ(fields[0x00200032], "-10\\20\\31.75");
  EXPECT_EQ(fields[0x00200037], "1\\0\\0\\0\\1\\0 ");
  EXPECT_EQ(fields[0x00280004], "MONOCHROME2 ");
  EXPECT_EQ(fields[0x00280010], std::string("\2\0", 2));
  EXPECT_EQ(fields[0x00280011], std::string("\3\0", 2));
  EXPECT_EQ(fields[0x00280030], "0.7\\0.4 ");
  EXPECT_EQ(fields[0x00280100], std::string("\20\0", 2));
  EXPECT_EQ(fields[0x00280103], std::string("\0\0", 2));
  EXPECT_EQ(fields[0x00281052], "-1024 ");
  EXPECT_EQ(fields[0x00281053], "1 ");
  EXPECT_EQ(fields[0x7fe00010], raw_bytes<std::uint16_t>({1029, 1030, 1031, 1032, 1033, 33791}));
}

TEST(WriteDicomSeries, GivesTheSameBytesForTheSameVolumeAndOtherUidsForAnother) {
  const TemporaryFolder folder;
  CtVolume ct = oblique_ct();
  write_dicom_series(folder / "a", ct);
  write_dicom_series(folder / "b", ct);
  EXPECT_TRUE(read_bytes(folder / "a/IM0003.dcm") == read_bytes(folder / "b/IM0003.dcm"));
  ++ct.voxels[0];
  write_dicom_series(folder / "c", ct);
  auto a = dicom_fields(folder / "a/IM0001.dcm");
  auto a2 = dicom_fields(folder / "a/IM0002.dcm");
  auto c = dicom_fields(folder / "c/IM0001.dcm");
  EXPECT_EQ(a[0x0020000e], a2[0x0020000e]);
  EXPECT_NE(a[0x00080018], a2[0x00080018]);
  EXPECT_NE(a[0x0020000e], c[0x0020000e]);
  EXPECT_THAT(a[0x0020000e], ::testing::MatchesRegex("2\\.25\\.[1-9][0-9]+.?"));
  EXPECT_LE(a[0x0020000e].size(), 64U);
}

TEST(WriteDicomSeries, WritesValuesBelowAirAsSignedPixels) {
  const TemporaryFolder folder;
  CtVolume ct = oblique_ct();
  ct.voxels[0] = -32768;
  write_dicom_series(folder / "ct", ct);
  EXPECT_EQ(read(folder / "ct").volume.voxels, ct.voxels);
  ct.voxels[1] = 32767;
  EXPECT_THAT(message_of<DataError>([&] { write_dicom_series(folder / "ct", ct); }), HasSubstr("-32768 to 32767 HU"));
}

TEST(WriteDicomSeries, LeavesASeriesThatIsThere) {
  const TemporaryFolder folder;
  CtVolume ct = oblique_ct();
  write_dicom_series(folder / "ct", ct);
  const auto files = std::distance(fs::directory_iterator(folder / "ct"), {});
  EXPECT_GT(files, 0);
  EXPECT_THROW(write_dicom_series(folder / "ct", ct), DataError) << "nobody knows whose scan that is";
  EXPECT_THROW(write_dicom_series(folder / "ct", ct, {.patient_id = "a\\b"}), InvalidArgument);
  EXPECT_THROW(write_dicom_series(folder / "ct", ct, {.patient_id = std::string(65, 'a')}), InvalidArgument);
  EXPECT_THROW(write_dicom_series(folder / "none/ct", ct), DataError);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "ct"), {}), files);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

}  // namespace
}  // namespace incise
