#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <string_view>

namespace incise {

class HeldTemporary;

/// Writes a file all or nothing: `write` fills a temporary file beside `path` (binary mode), which then replaces
/// `path`. If `path` is a link, replaces the file that it points to. Makes no folder. When the call returns, the file
/// and its name are on the disk (fsync), except inside an unfinished AtomicFolder, whose commit syncs everything.
/// Removes temporary files that killed processes left for the same name.
/// @throws DataError if the folder is missing or the file cannot be written completely. Exceptions of `write` reach
///         the caller. In both cases the temporary file is removed and an older file stays unchanged, unless only the
///         final sync of the folder fails.
void write_atomically(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);
/// Writes `content` in the same way.
void write_atomically(const std::filesystem::path& path, std::string_view content);

/// Checks, before a long computation, that `path` is a name that write_atomically accepts: its folder exists, and it is
/// no folder, device or pipe. Does not check permissions. @throws DataError otherwise.
void require_writable(const std::filesystem::path& path);

/// Returns the whole content of a file, byte for byte.
/// @throws DataError if it is missing, no regular file, larger than kLargestInputBytes, or unreadable.
[[nodiscard]] std::string read_text(const std::filesystem::path& path);

/// Makes a folder, and those above it, unless it exists. @throws DataError if that fails.
void make_folder(const std::filesystem::path& folder);

/// Checks that results may replace `folder`: it is missing or empty, or every file in it is listed in the
/// manifest.json that incise wrote there. First tidies up after killed processes that were writing this folder.
/// @throws DataError if the name is a link, if manifest.json is missing, from another program or without a list of
///         files, or for the first file that it does not list.
void require_replaceable(const std::filesystem::path& folder);

/// Removes a result folder if it exists. @throws DataError as require_replaceable, or if it cannot be removed.
void remove_replaceable(const std::filesystem::path& folder);

/// A folder that appears all or nothing: fill `path()`, then `commit()`.
/// Without commit, the destructor removes everything written, and an older folder of that name stays unchanged.
class AtomicFolder {
 public:
  /// Makes an empty folder with a temporary name beside `target`. @throws DataError if the parent folder is missing or
  /// read-only, if `target` is a file, or as require_replaceable.
  explicit AtomicFolder(std::filesystem::path target);
  ~AtomicFolder();
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  /// Where to write until commit.
  [[nodiscard]] const std::filesystem::path& path() const { return temporary_; }

  /// Syncs the folder to the disk and renames it to its target. An older result there is swapped out and removed.
  /// If the process is killed at any moment, either the older or the new folder is whole, at the latest when incise
  /// next writes there. If the folder has a manifest.json, commit first adds the key `files` to it: the relative paths
  /// of all files in the folder, sorted.
  /// @pre called once (InvalidArgument).
  /// @throws DataError if the folder cannot be put in place, or as require_replaceable; the older folder then stays.
  ///         Also if only the final sync fails; the new folder is then in place.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  std::unique_ptr<HeldTemporary> held_;
  bool is_committed_ = false;
};

}  // namespace incise
