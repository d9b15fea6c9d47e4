#include <incise/core/error.hpp>
#include <incise/io/abandoned_files.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/input_file.hpp>
#include <incise/io/json_text.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <optional>
#include <regex>
#include <set>
#include <vector>

namespace incise {
namespace {

namespace fs = std::filesystem;

/// A name beside `path` that no other thread or process uses, hidden from listings.
fs::path temporary_beside(const fs::path& path) {
  static std::atomic<unsigned> count = 0;  // only makes names differ; never part of a result
  return path.parent_path() / fmt::format(".{}.{}.{}.part", path.filename().string(), ::getpid(), count++);
}

/// The process that made a temporary name as above; nothing for other names.
std::optional<pid_t> maker_of(const std::string& name) {
  static const std::regex kTemporary(R"(\..+\.([0-9]{1,9})\.[0-9]+\.part)");
  std::smatch match;
  if (!std::regex_match(name, match, kTemporary)) return std::nullopt;
  return static_cast<pid_t>(std::stol(match[1]));
}

/// Also true where nobody may ask.
bool is_running(pid_t process) { return ::kill(process, 0) == 0 || errno != ESRCH; }

/// "out/" means the folder "out".
fs::path without_trailing_slash(const fs::path& path) {
  return path.has_filename() ? path : path.parent_path();
}

/// What a link points to is replaced, not the link; a device or a pipe must never be replaced by a file.
fs::path replaced_by(const fs::path& name) {
  std::error_code error;
  return fs::is_symlink(name, error) && fs::exists(name, error) ? fs::canonical(name) : name;
}

constexpr const char* kManifest = "manifest.json";
constexpr const char* kFiles = "files";

/// Everything below a folder that is not a folder, links and hidden files too, relative to it.
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
  write_json(file, manifest);
}

void require_parent_folder(const fs::path& path) {
  const fs::path parent = path.parent_path().empty() ? fs::path(".") : path.parent_path();
  std::error_code error;
  if (!fs::is_directory(parent, error)) {
    throw DataError(path, "", fmt::format("no folder '{}'", parent.string()), "an existing folder to write into");
  }
}

}  // namespace

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
  std::error_code error;
  const fs::path temporary = temporary_beside(path);
  try {
    std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
    if (!stream) throw DataError(path, "", std::strerror(errno), "a file that can be written");
    write(stream);
    stream.close();
    if (!stream) throw DataError(path, "", "a failed write", "a complete file", "Is the disk full?");
    fs::rename(temporary, path, error);
    if (error) throw DataError(path, "", error.message(), "a file that can be written");
  } catch (...) {
    fs::remove(temporary, error);
    throw;
  }
}

std::string read_text(const fs::path& path) {
  require_regular_file(path);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw DataError(path, "", std::strerror(errno), "a readable file");
  std::string text;
  char block[1 << 16];
  while (stream.read(block, sizeof block) || stream.gcount() > 0) {
    text.append(block, static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) throw DataError(path, fmt::format("byte {}", text.size()), "a read error", "a readable file");
  return text;
}

void require_replaceable(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error) || !fs::is_directory(folder, error) || fs::is_empty(folder, error)) return;
  constexpr const char* kExpected = "a free name, an empty folder, or a result to replace";
  constexpr const char* kHint = "Choose another place for the output";
  if (!fs::exists(folder / kManifest, error)) {
    throw DataError(folder, "", "a folder with files of another origin (no manifest.json)", kExpected, kHint);
  }
  const nlohmann::ordered_json manifest = read_json(folder / kManifest);
  if (!manifest.is_object() || !manifest.contains(kFiles) || !manifest.at(kFiles).is_array()) {
    throw DataError(folder, "", "a folder whose manifest.json lists no files", kExpected, kHint);
  }
  const nlohmann::ordered_json& own = manifest.at(kFiles);
  for (const std::string& file : files_below(folder)) {
    if (std::find(own.begin(), own.end(), nlohmann::ordered_json(file)) != own.end()) continue;
    throw DataError(folder, "", fmt::format("'{}' of another origin", file), kExpected, "Move that file, or choose another place for the output");
  }
}

void remove_abandoned_temporaries(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> abandoned;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::optional<pid_t> maker = maker_of(entry->path().filename().string());
    if (maker && (*maker == ::getpid() || !is_running(*maker))) abandoned.push_back(entry->path());
  }
  for (const fs::path& path : abandoned) fs::remove_all(path, error);
}

AtomicFolder::AtomicFolder(fs::path target)
    : target_(without_trailing_slash(target)), temporary_(temporary_beside(target_)) {
  require_parent_folder(target_);
  std::error_code error;
  if (fs::exists(target_, error) && !fs::is_directory(target_, error)) {
    throw DataError(target_, "", "a file", "a folder, or a name that is free");
  }
  fs::create_directory(temporary_, error);
  if (error) throw DataError(target_, "", error.message(), "a folder that can be written");
}

AtomicFolder::~AtomicFolder() {
  std::error_code ignored;
  if (!is_committed_) fs::remove_all(temporary_, ignored);
}

void AtomicFolder::commit() {
  INCISE_REQUIRE(!is_committed_, "expected one commit, found a second");
  list_files_in_manifest(temporary_);
  std::error_code error;
  const fs::path older = temporary_beside(target_);
  const bool replaces = fs::exists(target_, error);
  if (replaces) fs::rename(target_, older, error);
  if (!error) {
    fs::rename(temporary_, target_, error);
    std::error_code ignored;
    if (error && replaces) fs::rename(older, target_, ignored);
  }
  if (error) throw DataError(target_, "", error.message(), "a folder that can be replaced");
  is_committed_ = true;
  if (replaces) fs::remove_all(older, error);
}

}  // namespace incise
