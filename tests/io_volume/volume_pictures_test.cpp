// A stack of PNG pictures: order, orientation, and the two things that only the user knows.
#include "io_volume/handmade_files.hpp"
#include "support/monitors.hpp"
#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/io/volume_io.hpp>

#include <gmock/gmock.h>

namespace incise {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace incise::testing;

const CtReadSettings kStated{.spacing_mm = Vec3(0.5, 0.6, 2), .hu = GrayToHu{16, -1024}};

class PictureFolder : public ::testing::Test {
 protected:
  /// A picture of 3 x 2 gray pixels, all of one level.
  void put(const std::string& name, int gray) const {
    write_bytes(folder / name, png_bytes(3, 2, 8, 0, std::string(6, static_cast<char>(gray))));
  }
  [[nodiscard]] ReadVolume read(const CtReadSettings& settings = kStated) const {
    RecordingMonitor monitor;
    return read_ct(folder.path(), settings, monitor);
  }
  template <class Failure = DataError>
  [[nodiscard]] std::string failure(const CtReadSettings& settings = kStated) const {
    return message_of<Failure>([&] { (void)read(settings); });
  }
  [[nodiscard]] static std::vector<int> first_of_each_slice(const CtVolume& ct) {
    std::vector<int> values;
    for (int k = 0; k < ct.grid.size[2]; ++k) values.push_back(ct.at(0, 0, k));
    return values;
  }
  TemporaryFolder folder;
};

TEST_F(PictureFolder, IsSortedByNumberNotAsText) {
  for (int n = 1; n <= 11; ++n) put(fmt::format("texture-{}.png", n), n);
  EXPECT_THAT(first_of_each_slice(read().volume),
              ElementsAre(-1008, -992, -976, -960, -944, -928, -912, -896, -880, -864, -848));
}

TEST_F(PictureFolder, HasColumnsToTheLeftRowsToTheBackAndSlicesToTheHead) {
  write_bytes(folder / "0.png", png_bytes(3, 2, 8, 0, std::string("\x01\x02\x03\x04\x05\x06")));
  put("1.png", 64);
  const ReadVolume result = read();
  const CtVolume& ct = result.volume;
  EXPECT_THAT(ct.grid.size, ElementsAre(3, 2, 2));
  EXPECT_EQ(ct.grid.direction, Mat3::Identity());
  EXPECT_EQ(ct.grid.origin_mm, Vec3::Zero());
  EXPECT_EQ(ct.grid.world_from_index(Vec3(2, 1, 1)), Vec3(1, 0.6, 2));
  EXPECT_EQ(ct.at(2, 0, 0), 16 * 3 - 1024);
  EXPECT_EQ(ct.at(0, 1, 0), 16 * 4 - 1024);
  EXPECT_EQ(ct.at(1, 1, 1), 0);
  EXPECT_EQ(result.diagnostics.format, VolumeFormat::PictureStack);
  EXPECT_EQ(result.diagnostics.slices, 2);
  EXPECT_THAT(result.diagnostics.notices, IsEmpty());
}

TEST_F(PictureFolder, NumberedFromTheHeadIsTurnedOver) {
  put("0.png", 10);
  put("1.png", 20);
  CtReadSettings settings = kStated;
  settings.first_picture_is_head = true;
  EXPECT_THAT(first_of_each_slice(read(settings).volume), ElementsAre(16 * 20 - 1024, 16 * 10 - 1024));
}

TEST_F(PictureFolder, MayHaveSixteenBits) {
  for (const char* name : {"0.png", "1.png"})
    write_bytes(folder / name, png_bytes(2, 1, 16, 0, big_endian(1064, 2) + big_endian(4095, 2)));
  EXPECT_THAT(read({.spacing_mm = Vec3(1, 1, 1), .hu = GrayToHu{1, -1024}}).volume.voxels,
              ElementsAre(40, 3071, 40, 3071));
}

TEST_F(PictureFolder, NeedsSpacingAndHounsfieldUnitsStated) {
  put("0.png", 10);
  put("1.png", 20);
  EXPECT_THAT(failure<CaseError>({.hu = GrayToHu{}}), AllOf(HasSubstr("ct.spacing_mm"), HasSubstr("nothing")));
  EXPECT_THAT(failure<CaseError>({.spacing_mm = Vec3(1, 1, 1)}), AllOf(HasSubstr("ct.hu"), HasSubstr("nothing")));
  EXPECT_THAT(failure<CaseError>({.spacing_mm = Vec3(1, -1, 1), .hu = GrayToHu{}}),
              AllOf(HasSubstr("ct.spacing_mm"), HasSubstr("[1, -1, 1]")));
  EXPECT_THAT(failure<CaseError>({.spacing_mm = Vec3(1, 1, 1), .hu = GrayToHu{0, 0}}),
              AllOf(HasSubstr("ct.hu"), HasSubstr("slope")));
}

TEST_F(PictureFolder, RefusesAHoleInTheNumbering) {
  for (const int n : {1, 2, 4}) put(fmt::format("s{}.png", n), n);
  EXPECT_THAT(failure(), AllOf(HasSubstr("gap in the numbering"), HasSubstr("'s2.png' and 's4.png'")));
}

TEST_F(PictureFolder, RefusesTwoPicturesOfOneNumberAndTwoStacks) {
  put("s1.png", 1);
  put("s01.png", 1);
  EXPECT_THAT(failure(), HasSubstr("one number"));
  std::filesystem::remove(folder / "s01.png");
  put("t2.png", 1);
  EXPECT_THAT(failure(), HasSubstr("'s1.png' and 't2.png'"));
  put("cover.png", 1);
  EXPECT_THAT(failure(), AllOf(HasSubstr("cover"), HasSubstr("number")));
}

TEST_F(PictureFolder, RefusesColourOtherSizesAndOneSlice) {
  put("0.png", 1);
  EXPECT_THAT(failure(), HasSubstr("single slice"));
  write_bytes(folder / "1.png", png_bytes(1, 2, 8, 2, std::string(6, '\1')));
  EXPECT_THAT(failure(), AllOf(HasSubstr("1.png"), HasSubstr("colour")));
  write_bytes(folder / "1.png", png_bytes(3, 2, 8, 4, std::string(12, '\1')));
  EXPECT_THAT(failure(), AllOf(HasSubstr("1.png"), HasSubstr("transparency")));
  write_bytes(folder / "1.png", png_bytes(8, 1, 4, 0, std::string(4, '\1')));
  EXPECT_THAT(failure(), HasSubstr("bit depth: found 4"));
  write_bytes(folder / "1.png", png_bytes(2, 3, 8, 0, std::string(6, '\1')));
  EXPECT_THAT(failure(), AllOf(HasSubstr("2 x 3"), HasSubstr("3 x 2 as in '0.png'")));
}

TEST_F(PictureFolder, RefusesDamagedPictures) {
  put("0.png", 1);
  const std::string whole = png_bytes(3, 2, 8, 0, std::string(6, '\1'));
  for (std::size_t length = 0; length < whole.size(); ++length) {
    write_bytes(folder / "1.png", whole.substr(0, length));
    EXPECT_THAT(failure(), HasSubstr("1.png")) << length << " of " << whole.size() << " bytes";
  }
  std::string flipped = whole;
  flipped[flipped.size() - 20] ^= 1;
  write_bytes(folder / "1.png", flipped);
  EXPECT_THAT(failure(), AllOf(HasSubstr("1.png"), HasSubstr("a picture that cannot be read (IDAT: ")));
  write_bytes(folder / "1.png", "a letter");
  EXPECT_THAT(failure(), HasSubstr("1.png"));
}

TEST_F(PictureFolder, RefusesLevelsBeyondSixteenBits) {
  put("0.png", 1);
  put("1.png", 200);
  EXPECT_THAT(failure({.spacing_mm = Vec3(1, 1, 1), .hu = GrayToHu{1000, 0}}),
              AllOf(HasSubstr("1.png: pixel (0, 0)"), HasSubstr("gray level 200")));
}

TEST_F(PictureFolder, TellsOfRoundingAndOfOtherFiles) {
  put("0.png", 1);
  put("1.png", 2);
  write_bytes(folder / "notes.txt", "hello");
  const ReadVolume result = read({.spacing_mm = Vec3(1, 1, 1), .hu = GrayToHu{0.4, 0}});
  EXPECT_THAT(result.diagnostics.notices, ElementsAre(HasSubstr("passed over: 1"), HasSubstr("rounded")));
  EXPECT_THAT(first_of_each_slice(result.volume), ElementsAre(0, 1));
}

}  // namespace
}  // namespace incise
