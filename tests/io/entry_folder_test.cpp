#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/entry_folder.hpp>

#include <gmock/gmock.h>

#include <fstream>

namespace incise {
namespace {

class EntryFolderTest : public ::testing::Test {
 protected:
  [[nodiscard]] EntryFolder open() const { return EntryFolder(folder_ / "cache"); }
  void expect_refused(const std::string& says) const {
    EXPECT_THAT(testing::refusal_of<DataError>([&] { return open(); }), ::testing::HasSubstr(says));
  }
  testing::TemporaryFolder folder_;
  const std::string entry_ = std::string(kCacheMagic) + "what is kept";
};

TEST_F(EntryFolderTest, KeepsEntriesAlsoInFoldersOfTheirOwn) {
  EXPECT_FALSE(open().holds("plan"));
  EXPECT_EQ(open().load("plan"), std::nullopt);
  open().save("plan", entry_);
  open().save("calibration_run/0123", entry_);
  EXPECT_EQ(open().load("plan"), entry_);
  EXPECT_EQ(open().load("calibration_run/0123"), entry_);
  open().remove("plan");
  open().remove("plan");
  EXPECT_FALSE(open().holds("plan"));
}

TEST_F(EntryFolderTest, RefusesWhatIsNotItsOwnBeforeAnythingIsComputed) {
  open().save("plan", entry_);
  const std::filesystem::path cache = folder_ / "cache";
  std::ofstream(folder_ / "thesis.txt") << "years of work";
  std::filesystem::create_symlink(folder_ / "thesis.txt", cache / "mesh.bin");
  expect_refused("mesh.bin: found a link");
  std::filesystem::remove(cache / "mesh.bin");
  std::filesystem::create_directories(cache / "mesh.bin");
  expect_refused("mesh.bin: found no regular file");
  std::filesystem::remove(cache / "mesh.bin");
  std::ofstream(cache / "mesh.bin") << "years of work";
  expect_refused("mesh.bin: found a file of another origin");
  EXPECT_EQ(read_text(cache / "mesh.bin"), "years of work");
  std::ofstream(cache / "mesh.bin", std::ios::trunc) << entry_.substr(0, 5);
  EXPECT_NO_THROW(static_cast<void>(open())) << "an entry that was cut short is damaged, not foreign";
  std::ofstream(cache / "note.txt") << "a note of the user's own";
  EXPECT_NO_THROW(static_cast<void>(open()));
}

TEST_F(EntryFolderTest, RefusesALinkOrAFileInItsPlace) {
  std::filesystem::create_directories(folder_ / "elsewhere");
  std::filesystem::create_directory_symlink(folder_ / "elsewhere", folder_ / "cache");
  expect_refused("cache: found a link");
  std::filesystem::remove(folder_ / "cache");
  std::ofstream(folder_ / "cache") << "a file";
  expect_refused("cache: found no folder");
}

}  // namespace
}  // namespace incise
