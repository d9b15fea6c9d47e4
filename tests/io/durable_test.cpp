#include "io/durable.hpp"
#include "io/output_folder.hpp"
#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/io/abandoned_files.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/folder_lock.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <functional>
#include <iterator>

namespace incise {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using testing::entries_in;
using testing::kManifest;

/// Runs `work` in a process of its own and kills it (SIGKILL) at its stop number `count`: each system call is two, before and after.
/// Returns whether it was killed; false: it came to its end before.
bool killed_at_stop(int count, const std::function<void()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    if (::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) ::_exit(2);
    ::raise(SIGSTOP);
    try {
      work();
    } catch (...) {
      ::_exit(1);
    }
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSTOPPED(status));
  for (int i = 0; i < count; ++i) {
    ::ptrace(PTRACE_SYSCALL, child, nullptr, nullptr);
    ::waitpid(child, &status, 0);
    if (WIFEXITED(status)) {
      EXPECT_EQ(WEXITSTATUS(status), 0);
      return false;
    }
  }
  ::kill(child, SIGKILL);
  ::waitpid(child, &status, 0);
  return true;
}

void fill(const fs::path& folder, const std::string& text) {
  std::ofstream(folder / "a.txt") << text;
  fs::create_directory(folder / "frames");
  std::ofstream(folder / "frames" / "b.txt") << text;
  std::ofstream(folder / "manifest.json") << kManifest;
}

void write_result(const fs::path& target, const std::string& text) {
  AtomicFolder output(target);
  fill(output.path(), text);
  output.commit();
}

void write_text(const fs::path& file, const std::string& text) {
  write_atomically(file, [&text](std::ostream& stream) { stream << text; });
}

/// "old" or "new": what every file of a result says; anything else is a mixture or a loss.
std::string state_of(const fs::path& folder) {
  if (!fs::exists(folder / "manifest.json")) return "no result";
  const std::string a = read_text(folder / "a.txt"), b = read_text(folder / "frames" / "b.txt");
  return a == b ? a : a + " and " + b;
}

TEST(KillAtEveryStep, OfReplacingAFolderLeavesTheOldOrTheNewOne) {
  int kills = 0, of_new = 0;
  for (int stop = 1;; ++stop) {
    const incise::testing::TemporaryFolder folder;
    write_result(folder / "out", "old");
    if (!killed_at_stop(stop, [&folder] { write_result(folder / "out", "new"); })) break;
    ++kills;
    const std::string state = state_of(folder / "out");
    ASSERT_TRUE(state == "old" || state == "new") << state << " at stop " << stop;
    of_new += state == "new" ? 1 : 0;
    remove_abandoned_temporaries(folder.path());
    ASSERT_EQ(state_of(folder / "out"), state) << "at stop " << stop;
    ASSERT_EQ(entries_in(folder.path()), 1u) << "at stop " << stop;
  }
  EXPECT_GT(kills, 50);
  EXPECT_GT(of_new, 1);
  EXPECT_LT(of_new, kills);
}

TEST(KillAtEveryStep, WhereNamesCannotBeExchangedLosesNeitherOnceTidied) {
  int between = 0;
  for (int stop = 1;; ++stop) {
    const incise::testing::TemporaryFolder folder;
    write_result(folder / "out", "old");
    const auto replace = [&folder] {
      const auto name = [&folder](const char* ending) { return folder / fs::path("." + std::string("out.") + std::to_string(::getpid()) + ".7." + ending); };
      fs::create_directory(name("part"));
      fill(name("part"), "new");
      fs::path replaced;
      if (!put_in_place(name("part"), folder / "out", name("older"), replaced, Exchange::Never).empty()) ::_exit(1);
      fs::remove_all(replaced);
    };
    if (!killed_at_stop(stop, replace)) break;
    between += fs::exists(folder / "out") ? 0 : 1;
    remove_abandoned_temporaries(folder.path());
    const std::string state = state_of(folder / "out");
    ASSERT_TRUE(state == "old" || state == "new") << state << " at stop " << stop;
    ASSERT_EQ(entries_in(folder.path()), 1u) << "at stop " << stop;
  }
  EXPECT_GT(between, 0) << "the moment between the two renames was never met";
}

TEST(KillAtEveryStep, OfReplacingAFileLeavesTheOldOrTheNewOne) {
  int of_new = 0;
  for (int stop = 1;; ++stop) {
    const incise::testing::TemporaryFolder folder;
    write_text(folder / "a.txt", "old");
    if (!killed_at_stop(stop, [&folder] { write_text(folder / "a.txt", "new"); })) break;
    const std::string text = read_text(folder / "a.txt");
    ASSERT_TRUE(text == "old" || text == "new") << text << " at stop " << stop;
    of_new += text == "new" ? 1 : 0;
    write_text(folder / "a.txt", "newer");
    ASSERT_EQ(entries_in(folder.path()), 1u) << "what the killed process left is removed by the next one, stop " << stop;
  }
  EXPECT_GT(of_new, 0);
}

TEST(KillAtEveryStep, OfRemovingAResultLeavesAllOrNothing) {
  for (int stop = 1;; ++stop) {
    const incise::testing::TemporaryFolder folder;
    write_result(folder / "out", "old");
    if (!killed_at_stop(stop, [&folder] { remove_replaceable(folder / "out"); })) break;
    ASSERT_EQ(state_of(folder / "out"), fs::exists(folder / "out") ? "old" : "no result") << "at stop " << stop;
    remove_abandoned_temporaries(folder.path());
    ASSERT_LE(entries_in(folder.path()), 1u) << "at stop " << stop;
  }
}

TEST(RequireReplaceable, RefusesLinksAndManifestsOfAnotherOrigin) {
  const incise::testing::TemporaryFolder folder;
  write_result(folder / "elsewhere", "old");
  fs::create_directory_symlink(folder / "elsewhere", folder / "out");
  EXPECT_THAT([&] { require_replaceable(folder / "out"); }, ThrowsMessage<DataError>(HasSubstr("found a link")));
  EXPECT_THAT([&] { require_replaceable(folder / "out/"); }, ThrowsMessage<DataError>(HasSubstr("found a link")));
  EXPECT_THAT([&] { AtomicFolder(folder / "out"); }, ThrowsMessage<DataError>(HasSubstr("found a link")));
  EXPECT_THAT([&] { remove_replaceable(folder / "out"); }, ThrowsMessage<DataError>(HasSubstr("found a link")));
  EXPECT_EQ(state_of(folder / "elsewhere"), "old");
  std::ofstream(folder / "elsewhere" / "manifest.json") << R"({"name": "a web page", "files": ["a.txt", "frames/b.txt", "manifest.json"]})";
  EXPECT_THAT([&] { remove_replaceable(folder / "elsewhere"); }, ThrowsMessage<DataError>(HasSubstr("manifest.json of another origin")));
  EXPECT_EQ(state_of(folder / "elsewhere"), "old");
}

TEST(AtomicFolder, LooksAgainForForeignFilesBeforeItReplaces) {
  const incise::testing::TemporaryFolder folder;
  write_result(folder / "out", "old");
  AtomicFolder output(folder / "out");
  fill(output.path(), "new");
  std::ofstream(folder / "out" / "notes.txt") << "mine";
  EXPECT_THAT([&] { output.commit(); }, ThrowsMessage<DataError>(HasSubstr("'notes.txt' of another origin")));
  EXPECT_EQ(read_text(folder / "out" / "notes.txt"), "mine");
  EXPECT_EQ(state_of(folder / "out"), "old");
}

TEST(AtomicFolder, DoesNotReplaceACaseThatWasEdited) {
  const incise::testing::TemporaryFolder folder;
  const auto make = [&folder](const char* text) {
    AtomicFolder output(folder / "specimen");
    std::ofstream(output.path() / "case.yaml") << text;
    std::ofstream(output.path() / "manifest.json") << kManifest;
    output.commit();
  };
  make("seed 1");
  make("seed 2");
  EXPECT_EQ(read_text(folder / "specimen" / "case.yaml"), "seed 2");
  std::ofstream(folder / "specimen" / "case.yaml") << "mine";
  EXPECT_THAT([&] { make("seed 3"); },
              ThrowsMessage<DataError>(HasSubstr("'case.yaml', changed since it was written")));
  EXPECT_EQ(read_text(folder / "specimen" / "case.yaml"), "mine");
}

TEST(RemoveAbandonedTemporaries, LeavesWhatAnotherProcessWritesWhateverItsNumber) {
  const incise::testing::TemporaryFolder folder;
  int ready[2], go[2];
  ASSERT_EQ(::pipe(ready) | ::pipe(go), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(go[1]);
    AtomicFolder output(folder / "out");
    char byte = 0;
    if (::write(ready[1], "r", 1) != 1 || ::read(go[0], &byte, 1) < 0) ::_exit(1);
    ::_exit(0);
  }
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  ASSERT_EQ(entries_in(folder.path()), 1u);
  // As seen from another container: the number in the name is that of no process here.
  const fs::path seen = fs::directory_iterator(folder.path())->path();
  fs::rename(seen, folder / ".out.999999999.0.part");
  remove_abandoned_temporaries(folder.path());
  EXPECT_EQ(entries_in(folder.path()), 1u);
  ::close(go[1]);
  int status = 0;
  ::waitpid(child, &status, 0);
  remove_abandoned_temporaries(folder.path());
  EXPECT_EQ(entries_in(folder.path()), 0u);
  for (const int end : {ready[0], ready[1], go[0]}) ::close(end);
}

TEST(FolderLock, IsGivenBackThoughAChildThatWasForkedMeanwhileLives) {
  const incise::testing::TemporaryFolder folder;
  std::optional<FolderLock> lock(folder / "out");
  const pid_t child = ::fork();
  if (child == 0) {
    ::pause();
    ::_exit(0);
  }
  lock.reset();
  EXPECT_NO_THROW(FolderLock(folder / "out"));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
}

TEST(FolderLock, IsHeldByOneAndGivenBackByAKilledProcess) {
  const incise::testing::TemporaryFolder folder;
  {
    const FolderLock lock(folder / "out");
    EXPECT_THAT([&] { FolderLock(folder / "out"); },
                ThrowsMessage<DataError>(AllOf(HasSubstr("out: found a folder that process " + std::to_string(::getpid()) + " writes into"),
                                               HasSubstr("expected a folder that no other run writes into"))));
    EXPECT_EQ(entries_in(folder / "out"), 0u) << "no file is made";
  }
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const FolderLock lock(folder / "out");
    if (::write(ready[1], "r", 1) != 1) ::_exit(1);
    while (true) ::pause();
  }
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  EXPECT_THROW(FolderLock(folder / "out"), DataError);
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_NO_THROW(FolderLock(folder / "out"));
  for (const int end : ready) ::close(end);
}

TEST(FolderLock, RefusesAFileInPlaceOfAFolder) {
  const incise::testing::TemporaryFolder folder;
  std::ofstream(folder / "out") << "a file";
  EXPECT_THROW(FolderLock(folder / "out"), DataError);
}

}  // namespace
}  // namespace incise
