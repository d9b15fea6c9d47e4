#include "durable.hpp"

#include <incise/core/error.hpp>
#include <incise/io/abandoned_files.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/input_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/manifest.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <memory>
#include <optional>
#include <regex>
#include <set>
#include <vector>

namespace incise {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPart = "part";    // a file or folder that is being written
constexpr const char* kOlder = "older";  // a folder that a new one is about to replace

/// Returns a hidden name beside `path` that no other thread or process uses.
fs::path temporary_beside(const fs::path& path, const char* ending = kPart) {
  static std::atomic<unsigned> count = 0;  // only makes names differ; never part of a result
  std::error_code error;
  while (true) {
    const fs::path name = path.parent_path() / fmt::format(".{}.{}.{}.{}", path.filename().string(), ::getpid(), count++, ending);
    if (!fs::exists(fs::symlink_status(name, error))) return name;  // an earlier process with this number may have left one
  }
}

/// The parts of such a temporary name.
struct TemporaryName {
  std::string of;
  pid_t maker;
  bool is_older;
};

std::optional<TemporaryName> parsed(const std::string& name) {
  static const std::regex kTemporary(R"(\.([^/]+)\.([0-9]{1,9})\.[0-9]+\.(part|older))");
  std::smatch match;
  if (!std::regex_match(name, match, kTemporary)) return std::nullopt;
  return TemporaryName{match[1], static_cast<pid_t>(std::stol(match[2])), match[3] == kOlder};
}

/// Whether `path` lies inside an unfinished AtomicFolder, whose commit syncs everything at once.
bool is_in_temporary(const fs::path& path) {
  const fs::path parent = path.parent_path();
  return std::any_of(parent.begin(), parent.end(), [](const fs::path& part) { return parsed(part.string()).has_value(); });
}

bool is_held(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return false;
  const bool is_locked = ::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(file);
  return is_locked;
}

/// Also true if this process lacks permission to find out.
bool is_running(pid_t process) { return ::kill(process, 0) == 0 || errno != ESRCH; }

/// Returns "out" for "out/".
fs::path without_trailing_slash(const fs::path& path) {
  return path.has_filename() ? path : path.parent_path();
}

/// Returns the file that writing to `name` replaces: the target of a link, not the link.
fs::path replaced_by(const fs::path& name) {
  std::error_code error;
  return fs::is_symlink(name, error) && fs::exists(name, error) ? fs::canonical(name) : name;
}

constexpr const char* kManifest = "manifest.json";
constexpr const char* kFiles = "files";
constexpr const char* kCase = "case.yaml";  // the one file of a result that people edit
constexpr const char* kCaseDigest = "case_sha256";

/// Returns the relative paths of everything below a folder but folders; includes links and hidden files.
std::set<std::string> files_below(const fs::path& folder) {
  std::set<std::string> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_symlink() || !entry.is_directory()) files.insert(entry.path().lexically_relative(folder).generic_string());
  }
  return files;
}

void list_files_in_manifest(const fs::path& folder) {
  const fs::path file = folder / kManifest;
  if (!fs::exists(file)) return;
  nlohmann::ordered_json manifest = read_json(file);
  if (!manifest.is_object()) return;
  manifest[kFiles] = files_below(folder);
  if (fs::is_regular_file(folder / kCase)) manifest[kCaseDigest] = sha256_of_file(folder / kCase);
  write_json(file, manifest);
}

fs::path folder_of(const fs::path& path) { return path.parent_path().empty() ? fs::path(".") : path.parent_path(); }

void require_parent_folder(const fs::path& path) {
  const fs::path parent = folder_of(path);
  std::error_code error;
  if (!fs::is_directory(parent, error)) {
    throw DataError(path, "", fmt::format("no folder '{}'", parent.string()), "an existing folder to write into");
  }
}

struct Abandoned {
  fs::path path;
  TemporaryName name;
};

/// Returns the temporary files and folders that no process writes to any more. @param only  one target; empty: all
/// @param with_own  also those with this process's number, which an earlier process then left
std::vector<Abandoned> abandoned_in(const fs::path& folder, const std::string& only, bool with_own) {
  std::error_code error;
  std::vector<Abandoned> found;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::optional<TemporaryName> name = parsed(entry->path().filename().string());
    if (!name || (!only.empty() && name->of != only)) continue;
    const bool is_own = name->maker == ::getpid();
    if ((is_own ? with_own : !is_running(name->maker)) && !is_held(entry->path())) found.push_back({entry->path(), *name});
  }
  return found;
}

/// Gives an older folder its name back if no successor took it; removes everything else.
void tidy(const std::vector<Abandoned>& found, const fs::path& folder) {
  std::error_code error;
  for (const Abandoned& one : found) {
    const fs::path target = folder / one.name.of;
    if (one.name.is_older && !fs::exists(fs::symlink_status(target, error))) {
      fs::rename(one.path, target, error);
    } else {
      fs::remove_all(one.path, error);
    }
  }
}

void remove_abandoned_of(const fs::path& target) {
  tidy(abandoned_in(folder_of(target), target.filename().string(), false), folder_of(target));
}

/// Whether it is a manifest of incise: it has the keys that every version has written.
bool is_manifest(const nlohmann::ordered_json& json) {
  return json.is_object() && json.contains("version") && json.contains("commit") && json.contains("command") && json.contains("settings");
}

}  // namespace

/// Keeps a file or folder locked while it has a temporary name, so that no process takes it for an abandoned one.
/// Process numbers alone prove nothing if two machines or containers share a folder.
class HeldTemporary {
 public:
  explicit HeldTemporary(int file) : file_(file) {
    if (file_ >= 0) ::flock(file_, LOCK_EX | LOCK_NB);  // without support for locks, the process number must suffice
  }
  ~HeldTemporary() {
    if (file_ >= 0) ::close(file_);
  }
  HeldTemporary(const HeldTemporary&) = delete;
  HeldTemporary& operator=(const HeldTemporary&) = delete;

 private:
  int file_;
};

void require_writable(const fs::path& name) {
  require_parent_folder(name);
  const fs::path path = replaced_by(name);
  std::error_code error;
  if (fs::is_directory(path, error)) throw DataError(path, "", "a folder", "a file name to write to");
  if (fs::exists(path, error) && !fs::is_regular_file(path, error)) {
    throw DataError(path, "", "a device or pipe", "a file name to write to");
  }
}

void write_atomically(const fs::path& name, const std::function<void(std::ostream&)>& write) {
  require_writable(name);
  const fs::path path = replaced_by(name);
  const bool is_part_of_folder = is_in_temporary(fs::absolute(path));
  if (!is_part_of_folder) remove_abandoned_of(path);
  std::error_code error;
  const fs::path temporary = temporary_beside(path);
  constexpr mode_t kMode = 0666;
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kMode);
  if (file < 0) throw DataError(path, "", system_reason(errno), "a file that can be written");
  const HeldTemporary held(file);
  const auto require_done = [&path](const std::string& problem) {
    if (!problem.empty()) throw DataError(path, "", problem, "a file that can be written", "Is the disk full?");
  };
  try {
    std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
    if (!stream) throw DataError(path, "", system_reason(errno), "a file that can be written");
    write(stream);
    stream.close();
    if (!stream) throw DataError(path, "", "a failed write", "a complete file", "Is the disk full?");
    if (!is_part_of_folder) require_done(synced(temporary));
    fs::rename(temporary, path, error);
    if (error) throw DataError(path, "", system_reason(error), "a file that can be written");
  } catch (...) {
    fs::remove(temporary, error);
    throw;
  }
  if (!is_part_of_folder) require_done(synced(folder_of(path)));
}

void write_atomically(const fs::path& name, std::string_view content) {
  write_atomically(name, [&](std::ostream& stream) { stream << content; });
}

std::string read_text(const fs::path& path) {
  require_regular_file(path);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw DataError(path, "", system_reason(errno), "a readable file");
  std::string text;
  char block[1 << 16];
  while (stream.read(block, sizeof block) || stream.gcount() > 0) {
    text.append(block, static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) throw DataError(path, fmt::format("byte {}", text.size()), "a read error", "a readable file");
  return text;
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder, error))
    throw DataError(folder, "", error ? system_reason(error) : "something that is not a folder",
                    "a folder that can be written");
}

void require_replaceable(const fs::path& name) {
  std::error_code error;
  const fs::path folder = without_trailing_slash(name);
  remove_abandoned_of(folder);
  if (fs::is_symlink(folder, error)) {
    throw DataError(folder, "", "a link", "a free name, an empty folder, or a result to replace",
                    "Name the folder to which it points, or choose another place");
  }
  if (!fs::exists(folder, error) || !fs::is_directory(folder, error) || fs::is_empty(folder, error)) return;
  constexpr const char* kExpected = "a free name, an empty folder, or a result to replace";
  constexpr const char* kHint = "Choose another place for the output";
  if (!fs::exists(folder / kManifest, error)) {
    throw DataError(folder, "", "a folder with files of another origin (no manifest.json)", kExpected, kHint);
  }
  const nlohmann::ordered_json manifest = read_json(folder / kManifest);
  if (!is_manifest(manifest)) throw DataError(folder, "", "a folder with a manifest.json of another origin", kExpected, kHint);
  if (!manifest.contains(kFiles) || !manifest.at(kFiles).is_array()) {
    throw DataError(folder, "", "a folder whose manifest.json lists no files", kExpected, kHint);
  }
  const nlohmann::ordered_json& own = manifest.at(kFiles);
  for (const std::string& file : files_below(folder)) {
    if (std::find(own.begin(), own.end(), nlohmann::ordered_json(file)) != own.end()) continue;
    throw DataError(folder, "", fmt::format("'{}' of another origin", file), kExpected, "Move that file, or choose another place for the output");
  }
  const auto digest = manifest.find(kCaseDigest);
  if (digest != manifest.end() && fs::exists(folder / kCase, error) && *digest != sha256_of_file(folder / kCase)) {
    throw DataError(folder, "", fmt::format("'{}', changed since it was written", kCase), kExpected,
                    "Move that file, or choose another place for the output");
  }
}

void remove_replaceable(const fs::path& name) {
  require_replaceable(name);
  const fs::path folder = without_trailing_slash(name);
  std::error_code error;
  if (!fs::is_directory(folder, error)) return;
  // Under a temporary name first: if this is killed halfway, the rest does not look like a result and is removed later.
  const fs::path temporary = temporary_beside(folder);
  fs::rename(folder, temporary, error);
  if (!error) fs::remove_all(temporary, error);
  if (error) throw DataError(folder, "", system_reason(error), "a folder that can be removed");
}

void remove_abandoned_temporaries(const fs::path& folder) { tidy(abandoned_in(folder, "", true), folder); }

AtomicFolder::AtomicFolder(fs::path target) : target_(without_trailing_slash(target)) {
  require_parent_folder(target_);
  std::error_code error;
  if (fs::exists(target_, error) && !fs::is_directory(target_, error)) {
    throw DataError(target_, "", "a file", "a folder, or a name that is free");
  }
  require_replaceable(target_);
  temporary_ = temporary_beside(target_);
  fs::create_directory(temporary_, error);
  if (error) throw DataError(target_, "", system_reason(error), "a folder that can be written");
  held_ = std::make_unique<HeldTemporary>(::open(temporary_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
}

AtomicFolder::~AtomicFolder() {
  std::error_code ignored;
  if (!is_committed_) fs::remove_all(temporary_, ignored);
}

void AtomicFolder::commit() {
  INCISE_REQUIRE(!is_committed_, "expected one commit, found a second");
  list_files_in_manifest(temporary_);
  require_replaceable(target_);  // files may have been added since the constructor
  fs::path replaced;
  std::string problem = synced_tree(temporary_);
  if (problem.empty()) problem = put_in_place(temporary_, target_, temporary_beside(target_, kOlder), replaced);
  if (!problem.empty()) throw DataError(target_, "", problem, "a folder that can be replaced");
  is_committed_ = true;
  problem = synced(folder_of(target_));
  held_.reset();
  std::error_code ignored;
  if (!replaced.empty()) fs::remove_all(replaced, ignored);
  if (!problem.empty()) throw DataError(target_, "", problem, "a folder that can be flushed to disk");
}

}  // namespace incise
