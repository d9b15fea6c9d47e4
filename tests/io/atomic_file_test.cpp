#include "io/output_folder.hpp"
#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/io/abandoned_files.hpp>
#include <incise/io/atomic_file.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <ostream>
#include <stdexcept>

namespace incise {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using testing::entries_in;
using testing::kManifest;

TEST(WriteAtomically, WritesTheBytesAndLeavesNothingElse) {
  const incise::testing::TemporaryFolder folder;
  write_atomically(folder / "a.bin", [](std::ostream& stream) { stream << std::string("1\n\0\r2", 5); });
  EXPECT_EQ(read_text(folder / "a.bin"), std::string("1\n\0\r2", 5));
  EXPECT_EQ(entries_in(folder.path()), 1u);
}

TEST(WriteAtomically, KeepsTheOlderFileWhenTheWriterFails) {
  const incise::testing::TemporaryFolder folder;
  write_atomically(folder / "a.txt", [](std::ostream& stream) { stream << "old"; });
  EXPECT_THROW(write_atomically(folder / "a.txt",
                                [](std::ostream& stream) {
                                  stream << "half";
                                  throw std::runtime_error("stopped");
                                }),
               std::runtime_error);
  EXPECT_EQ(read_text(folder / "a.txt"), "old");
  EXPECT_EQ(entries_in(folder.path()), 1u);
}

TEST(WriteAtomically, RefusesAFailedStream) {
  const incise::testing::TemporaryFolder folder;
  EXPECT_THROW(write_atomically(folder / "a.txt", [](std::ostream& stream) { stream.setstate(std::ios::badbit); }),
               DataError);
  EXPECT_EQ(entries_in(folder.path()), 0u);
}

TEST(WriteAtomically, MakesNoFolders) {
  const incise::testing::TemporaryFolder folder;
  EXPECT_THAT([&] { write_atomically(folder / "missing" / "a.txt", [](std::ostream&) {}); },
              ThrowsMessage<DataError>(HasSubstr("expected an existing folder")));
  EXPECT_EQ(entries_in(folder.path()), 0u);
}

TEST(WriteAtomically, RefusesAFolderAsTheFileToWrite) {
  const incise::testing::TemporaryFolder folder;
  EXPECT_THROW(write_atomically(folder.path(), [](std::ostream&) {}), DataError);
}

TEST(RemoveAbandonedTemporaries, TakesWhatDeadProcessesLeftAndNothingElse) {
  const incise::testing::TemporaryFolder folder;
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ASSERT_GT(child, 0);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);  // a number that no process has any more
  const auto name = [](const char* of, pid_t process) { return std::string(".") + of + "." + std::to_string(process) + ".3.part"; };
  std::ofstream(folder / name("a.checkpoint", child)) << "half";
  fs::create_directory(folder / name("as_planned", child));
  std::ofstream(folder / name("as_planned", child) / "incision.json") << "half";
  std::ofstream(folder / name("b.csv", ::getpid())) << "of an earlier process with this number";
  remove_abandoned_temporaries(folder / "nowhere");
  const std::string others[] = {name("c.csv", ::getppid()), "a.checkpoint", ".hidden.part", ".x.12.part", "x." + std::to_string(child) + ".3.part"};
  for (const std::string& other : others) std::ofstream(folder / other) << "kept";
  remove_abandoned_temporaries(folder.path());
  for (const std::string& other : others) EXPECT_TRUE(fs::exists(folder / other)) << other;
  EXPECT_EQ(entries_in(folder.path()), std::size(others));
}

TEST(ReadText, NamesAMissingFileAndAFolder) {
  const incise::testing::TemporaryFolder folder;
  EXPECT_THAT([&] { static_cast<void>(read_text(folder / "none.txt")); },
              ThrowsMessage<DataError>(HasSubstr("none.txt: found no such file")));
  EXPECT_THAT([&] { static_cast<void>(read_text(folder.path())); },
              ThrowsMessage<DataError>(HasSubstr("found a folder, expected a file")));
}

TEST(AtomicFolder, AppearsOnlyWithCommitAndReplacesTheOlderOne) {
  const incise::testing::TemporaryFolder folder;
  for (const char* text : {"old", "new"}) {
    AtomicFolder output(folder / "out/");
    std::ofstream(output.path() / text) << text;
    std::ofstream(output.path() / "manifest.json") << kManifest;
    output.commit();
  }
  EXPECT_TRUE(fs::exists(folder / "out" / "new"));
  EXPECT_FALSE(fs::exists(folder / "out" / "old"));
  EXPECT_EQ(entries_in(folder.path()), 1u);
}

TEST(AtomicFolder, IsGoneWithoutCommitAndTheOlderOneStays) {
  const incise::testing::TemporaryFolder folder;
  {
    AtomicFolder older(folder / "out");
    std::ofstream(older.path() / "old") << "old";
    std::ofstream(older.path() / "manifest.json") << kManifest;
    older.commit();
  }
  {
    const AtomicFolder output(folder / "out");
    std::ofstream(output.path() / "new") << "new";
  }
  EXPECT_TRUE(fs::exists(folder / "out" / "old"));
  EXPECT_EQ(entries_in(folder.path()), 1u);
}

TEST(AtomicFolder, IsReplaceableOnlyWhileItHoldsNothingButItsOwnFiles) {
  const incise::testing::TemporaryFolder folder;
  const fs::path out = folder / "out";
  EXPECT_NO_THROW(require_replaceable(out)) << "a free name";
  AtomicFolder output(out);
  fs::create_directory(output.path() / "frames");
  std::ofstream(output.path() / "frames" / "0.vtu") << "frame";
  std::ofstream(output.path() / "manifest.json") << kManifest;
  output.commit();
  EXPECT_NO_THROW(require_replaceable(out));
  EXPECT_THAT(read_text(out / "manifest.json"), HasSubstr("frames/0.vtu"));
  std::ofstream(out / "frames" / "note.txt") << "mine";
  EXPECT_THAT([&] { require_replaceable(out); }, ThrowsMessage<DataError>(HasSubstr("'frames/note.txt' of another origin")));
  fs::remove(out / "frames" / "note.txt");
  fs::create_symlink("/nowhere", out / "link");
  EXPECT_THAT([&] { require_replaceable(out); }, ThrowsMessage<DataError>(HasSubstr("'link'")));
  fs::remove(out / "link");
  EXPECT_NO_THROW(require_replaceable(out));
  std::ofstream(out / "manifest.json") << kManifest;
  EXPECT_THAT([&] { require_replaceable(out); }, ThrowsMessage<DataError>(HasSubstr("lists no files")));
}

TEST(AtomicFolder, DoesNotReplaceAFile) {
  const incise::testing::TemporaryFolder folder;
  std::ofstream(folder / "out") << "a file";
  EXPECT_THROW(AtomicFolder(folder / "out"), DataError);
}

}  // namespace
}  // namespace incise
