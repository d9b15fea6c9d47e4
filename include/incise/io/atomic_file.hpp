#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <string_view>

namespace incise {

class HeldTemporary;

/// Writes a file all or nothing: `write` fills a stream to a temporary name beside `path`, which then takes the place
/// of `path`. Binary mode; no folder is made. Whatever an exception of `write` says reaches the caller, after the
/// temporary file is gone. The file and its name are on the disk when it returns (fsync), but in a folder that AtomicFolder
/// fills, which gets there as a whole. A temporary file that a killed process left for this very name is removed.
/// @throws DataError if the folder is missing, or the file cannot be written completely; an older file then stays as it
/// was.
void write_atomically(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);
/// As above, of a content that is there already.
void write_atomically(const std::filesystem::path& path, std::string_view content);

/// Looks before a long computation whether write_atomically may write a file of this name. @throws DataError as it would.
void require_writable(const std::filesystem::path& path);

/// The whole content of a file, byte for byte.
/// @throws DataError if it is missing, is a folder, or cannot be read.
[[nodiscard]] std::string read_text(const std::filesystem::path& path);

/// Refuses a folder that results must not replace: one that holds any file that its manifest.json does not list as
/// written with it, whose manifest.json is not of incise, or to which the name is a link. A folder that is missing or empty
/// passes. What a killed process left of this folder is put right first.
/// @throws DataError naming the first such file
void require_replaceable(const std::filesystem::path& folder);

/// Removes a result folder, if there is one. @throws DataError as require_replaceable, or where it cannot be removed.
void remove_replaceable(const std::filesystem::path& folder);

/// A folder that appears all or nothing: fill `path()`, then `commit()`.
/// Without commit the destructor removes what was written and an older folder of that name stays as it was.
class AtomicFolder {
 public:
  /// Makes an empty folder with a temporary name beside `target`. @throws DataError if the parent folder is missing or
  /// read-only, or as require_replaceable.
  explicit AtomicFolder(std::filesystem::path target);
  ~AtomicFolder();
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  /// Where to write until commit.
  [[nodiscard]] const std::filesystem::path& path() const { return temporary_; }

  /// Brings the folder to the disk and renames it to its target; an older result there changes places with it in one step and
  /// is then removed. Killed at any moment, this leaves the older or the new one whole, at the latest when incise next
  /// writes there. Where there is a manifest.json, it first gets the key `files`: every file of the folder, relative and sorted.
  /// @throws DataError if that cannot be done or as require_replaceable; then the older folder stays. @pre called once.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  std::unique_ptr<HeldTemporary> held_;
  bool is_committed_ = false;
};

}  // namespace incise
