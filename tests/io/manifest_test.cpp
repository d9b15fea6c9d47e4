#include "io/io_test_support.hpp"

#include <incise/io/manifest.hpp>

#include <nlohmann/json.hpp>

#include <limits>

namespace incise {
namespace {

using incise::testing::refusal_of;
using incise::testing::TemporaryFolder;
using incise::testing::write_file;
using ::testing::HasSubstr;

constexpr const char* kHashOfAbc =
    "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";  // FIPS 180-4, example 1
constexpr const char* kHashOfNothing = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";

TEST(Sha256, GivesThePublishedDigests) {
  EXPECT_EQ(sha256_of_text("abc"), kHashOfAbc);
  EXPECT_EQ(sha256_of_text(""), kHashOfNothing);
  const TemporaryFolder folder;
  EXPECT_EQ(sha256_of_file(write_file(folder / "a", "abc")), kHashOfAbc);
  EXPECT_EQ(sha256_of_file(write_file(folder / "big", std::string(1000000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");  // FIPS 180-4: a million times "a"
}

TEST(Sha256, OfAFolderDependsOnNamesAndContentsOnly) {
  const TemporaryFolder one, two;
  for (const auto& [folder, names] :
       {std::pair{&one, std::vector<std::string>{"a", "b"}}, std::pair{&two, std::vector<std::string>{"b", "a"}}}) {
    std::filesystem::create_directory(*folder / "sub");
    for (const auto& name : names) write_file(*folder / "sub" / name, "abc" + name);
  }
  const std::string hash = sha256_of_folder(one.path());
  EXPECT_EQ(hash, sha256_of_folder(two.path()));
  EXPECT_EQ(hash, sha256_of_text(sha256_of_text("abca") + "  sub/a\n" + sha256_of_text("abcb") + "  sub/b\n"));
  std::filesystem::rename(two / "sub/a", two / "sub/c");
  EXPECT_NE(hash, sha256_of_folder(two.path()));
}

TEST(Sha256, NamesWhatCannotBeRead) {
  const TemporaryFolder folder;
  EXPECT_THAT(refusal_of<DataError>([&] { return sha256_of_file(folder / "none"); }), HasSubstr("no such file"));
  EXPECT_THAT(refusal_of<DataError>([&] { return sha256_of_file(folder.path()); }), HasSubstr("found a folder"));
  EXPECT_THAT(refusal_of<DataError>([&] { return sha256_of_folder(folder / "none"); }), HasSubstr("no such folder"));
}

TEST(ManifestFile, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  Manifest manifest;
  manifest.version = "0.1.0";
  manifest.commit = "abc";
  manifest.command = "incise demo -o \"out folder\"";
  manifest.settings_json = R"({"cut": {"dullness": 9}})";
  manifest.seed = 18446744073709551615ull;
  manifest.threads = 2;
  manifest.instruction_set = "avx2";
  manifest.inputs = {{"ct/", kHashOfAbc}};
  manifest.wall_s = 1.25;
  manifest.machine = machine_description();
  write_manifest(folder.path(), manifest);
  const Manifest back = read_manifest(folder.path());
  EXPECT_EQ(back.command, manifest.command);
  EXPECT_EQ(back.seed, manifest.seed);
  EXPECT_EQ(back.inputs.at(0).sha256, kHashOfAbc);
  EXPECT_EQ(back.wall_s, 1.25);
  EXPECT_EQ(back.machine, manifest.machine);
  EXPECT_EQ(nlohmann::json::parse(back.settings_json)["cut"]["dullness"], 9);
}

TEST(ManifestFile, RefusesSettingsThatAreNotJsonAndTimesThatAreNotFinite) {
  const TemporaryFolder folder;
  Manifest manifest{.settings_json = "{"};
  EXPECT_THROW(write_manifest(folder.path(), manifest), InvalidArgument);
  manifest.settings_json = "{}";
  manifest.wall_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_manifest(folder.path(), manifest), InvalidArgument);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(ManifestFile, NamesAMissingKey) {
  const TemporaryFolder folder;
  write_file(folder / "manifest.json", R"({"version": "1"})");
  EXPECT_THAT(refusal_of<DataError>([&] { return read_manifest(folder.path()); }),
              HasSubstr("/commit: found no such key"));
}

TEST(MachineDescription, SaysProcessorCoresAndCompilerInOneLine) {
  const std::string text = machine_description();
  EXPECT_THAT(text, HasSubstr("logical cores"));
  EXPECT_THAT(text, HasSubstr("++ "));
  EXPECT_EQ(text.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace incise
