#include "durable.hpp"

#include <incise/core/problem.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <vector>

namespace incise {
namespace fs = std::filesystem;

std::string synced(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (file < 0) return system_reason(errno);
  const int problem = ::fsync(file) == 0 || errno == EINVAL ? 0 : errno;
  ::close(file);
  return problem == 0 ? "" : system_reason(problem);
}

std::string synced_tree(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> all{folder};
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (!entry->is_symlink() && (entry->is_regular_file() || entry->is_directory())) all.push_back(entry->path());
  }
  if (error) return system_reason(error);
  for (auto path = all.rbegin(); path != all.rend(); ++path) {
    if (std::string problem = synced(*path); !problem.empty()) return problem;
  }
  return "";
}

std::string put_in_place(const fs::path& folder, const fs::path& target, const fs::path& older, fs::path& replaced, Exchange exchange) {
  std::error_code error;
  replaced.clear();
  if (!fs::exists(fs::symlink_status(target, error))) {
    fs::rename(folder, target, error);
    return error ? system_reason(error) : "";
  }
  if (exchange == Exchange::IfPossible) {
    if (::renameat2(AT_FDCWD, folder.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) == 0) {
      replaced = folder;
      return "";
    }
    if (errno != EINVAL && errno != ENOSYS) return system_reason(errno);
  }
  fs::rename(target, older, error);
  if (error) return system_reason(error);
  fs::rename(folder, target, error);
  if (!error) {
    replaced = older;
    return "";
  }
  const std::string problem = system_reason(error);
  fs::rename(older, target, error);
  return problem;
}

}  // namespace incise
