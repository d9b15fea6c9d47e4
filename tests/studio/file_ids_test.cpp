#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/studio/file_ids.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <map>

namespace incise::studio {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

class FileIdsTest : public ::testing::Test {
 protected:
  FileIdsTest() {
    fs::create_directories(root() / "patient");
    fs::create_directories(folder_ / "outside");
    std::ofstream(root() / "patient" / "case.yaml") << "schema: incise.case/1\n";
    std::ofstream(root() / "ct.nrrd") << "NRRD0004\n";
    std::ofstream(root() / ".hidden") << "x";
    std::ofstream(folder_ / "outside" / "secret.csv") << "x";
  }
  fs::path root() const { return folder_ / "root"; }
  static std::map<std::string, Json> by_name(const Json& list) {
    std::map<std::string, Json> entries;
    for (const Json& entry : list.at("entries")) entries[entry.at("name").get<std::string>()] = entry;
    return entries;
  }
  testing::TemporaryFolder folder_;
};

TEST_F(FileIdsTest, ListsAFolderWithKindsAndWithoutHiddenFiles) {
  FileIds files({root()}, "salt");
  const auto entries = by_name(files.list(""));
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries.at("patient").at("kind"), "case");
  EXPECT_EQ(entries.at("ct.nrrd").at("kind"), "scan");
  EXPECT_EQ(entries.at("ct.nrrd").at("bytes"), 9);
  EXPECT_EQ(files.path_of(entries.at("ct.nrrd").at("id"), "file"), fs::canonical(root() / "ct.nrrd"));
  const Json inner = files.list(entries.at("patient").at("id"));
  EXPECT_EQ(inner.at("up"), files.list("").at("folder").at("id"));
  EXPECT_TRUE(files.list("").at("up").is_null()) << "there is nothing above a root";
}

TEST_F(FileIdsTest, LeavesOutLinksThatLeaveTheRoots) {
  fs::create_symlink(folder_ / "outside", root() / "way_out");
  fs::create_symlink(folder_ / "outside" / "secret.csv", root() / "secret.csv");
  fs::create_symlink("patient", root() / "way_in");
  FileIds files({root()}, "salt");
  const auto entries = by_name(files.list(""));
  EXPECT_FALSE(entries.contains("way_out"));
  EXPECT_FALSE(entries.contains("secret.csv"));
  EXPECT_TRUE(entries.contains("way_in"));
  EXPECT_THROW(static_cast<void>(files.id_of(root() / ".." / "outside" / "secret.csv")), DataError);
  EXPECT_THROW(static_cast<void>(files.id_of(root() / "way_out")), DataError);
}

TEST_F(FileIdsTest, AFolderWhoseNameBeginsLikeARootIsNotWithinIt) {
  fs::create_directories(folder_ / "root_of_another");
  FileIds files({root()}, "salt");
  EXPECT_THROW(static_cast<void>(files.id_of(folder_ / "root_of_another")), DataError);
}

TEST_F(FileIdsTest, LooksAgainWhenAnIdIsUsed) {
  FileIds files({root()}, "salt");
  const std::string id = files.id_of(root() / "ct.nrrd");
  fs::remove(root() / "ct.nrrd");
  EXPECT_THROW(static_cast<void>(files.path_of(id, "file")), DataError);
  fs::create_symlink(folder_ / "outside" / "secret.csv", root() / "ct.nrrd");
  EXPECT_THROW(static_cast<void>(files.path_of(id, "file")), DataError);
}

TEST_F(FileIdsTest, NoTextIsAnIdThatWasNotGiven) {
  FileIds files({root()}, "salt");
  static_cast<void>(files.list(""));
  for (const char* text : {"..", "/", "/etc/passwd", "../outside/secret.csv", "0"})
    EXPECT_THROW(static_cast<void>(files.path_of(text, "file")), CaseError) << text;
  FileIds others({root()}, "another salt");
  EXPECT_THROW(static_cast<void>(files.path_of(others.id_of(root() / "ct.nrrd"), "file")), CaseError);
}

TEST_F(FileIdsTest, ARootHasToBeAFolder) {
  EXPECT_THROW(FileIds({root() / "ct.nrrd"}, "salt"), DataError);
  EXPECT_THROW(FileIds({root() / "nowhere"}, "salt"), DataError);
}

TEST_F(FileIdsTest, ANameThatIsNotUtf8DoesNotEndTheList) {
  std::ofstream(root() / "\xff.csv") << "x";
  FileIds files({root()}, "salt");
  EXPECT_EQ(files.list("").at("entries").size(), 3U);
  EXPECT_NO_THROW(static_cast<void>(files.list("").dump()));
}

}  // namespace
}  // namespace incise::studio
