#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/folder_lock.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <sstream>

namespace incise {
namespace {

constexpr const char* kExpected = "a folder that no other run writes into";

/// Returns the process that holds a lock on an inode, from Linux's list of locks; 0 if it is not listed.
pid_t holder_of(ino_t inode) {
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string number, kind, manner, access, place;
    pid_t process = 0;
    if (!(words >> number >> kind >> manner >> access >> process >> place) || kind != "FLOCK") continue;
    if (place.substr(place.rfind(':') + 1) == std::to_string(inode)) return process;
  }
  return 0;
}

std::string description_of(pid_t process) {
  if (process <= 0) return "a folder that another process writes into";
  std::ifstream stream(fmt::format("/proc/{}/cmdline", process), std::ios::binary);
  std::string command((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  while (!command.empty() && command.back() == '\0') command.pop_back();
  std::replace(command.begin(), command.end(), '\0', ' ');
  return fmt::format("a folder that process {} writes into ({})", process, command.empty() ? "of unknown name" : command);
}

/// Whether a name still leads to the folder that was opened; its owner may have removed it since.
bool is_still_there(int file, const std::filesystem::path& folder) {
  struct stat opened {};
  struct stat named {};
  return ::fstat(file, &opened) == 0 && ::stat(folder.c_str(), &named) == 0 && opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

int open_folder(const std::filesystem::path& folder) {
  make_folder(folder);
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) throw DataError(folder, "", system_reason(errno), "a folder that can be read and written");
  return file;
}

[[noreturn]] void refuse(const std::filesystem::path& folder, ino_t inode, int problem) {
  if (problem == EWOULDBLOCK)
    throw DataError(folder, "", description_of(holder_of(inode)), kExpected, "Wait until it has ended, or choose another place for the output");
  throw DataError(folder, "", fmt::format("a folder that cannot be locked: {}", system_reason(problem)), kExpected,
                  "Choose a local disk for the output");
}

}  // namespace

FolderLock::FolderLock(std::filesystem::path folder) : folder_(std::move(folder)) {
  constexpr int kMostTries = 100;  // a try fails if another process removes the folder between opening and locking it
  for (int i = 0; i < kMostTries; ++i) {
    file_ = open_folder(folder_);
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
      const int problem = errno;
      struct stat opened {};
      ::fstat(file_, &opened);
      release();
      refuse(folder_, opened.st_ino, problem);
    }
    if (is_still_there(file_, folder_)) return;
    release();
  }
  throw DataError(folder_, "", "a folder that is removed again and again", kExpected);
}

FolderLock::~FolderLock() { release(); }

void FolderLock::release() {
  if (file_ >= 0) {
    ::flock(file_, LOCK_UN);  // a child that another thread has forked holds a copy of the descriptor
    ::close(file_);
  }
  file_ = -1;
}

}  // namespace incise
