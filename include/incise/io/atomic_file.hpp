#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>

namespace incise {

/// Writes a file all or nothing: `write` fills a stream to a temporary name beside `path`, which then takes the place
/// of `path`. Binary mode; no folder is made. Whatever an exception of `write` says reaches the caller, after the
/// temporary file is gone.
/// @throws DataError if the folder is missing, or the file cannot be written completely; an older file then stays as it
/// was.
void write_atomically(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// Looks before a long computation whether write_atomically may write a file of this name. @throws DataError as it would.
void require_writable(const std::filesystem::path& path);

/// The whole content of a file, byte for byte.
/// @throws DataError if it is missing, is a folder, or cannot be read.
[[nodiscard]] std::string read_text(const std::filesystem::path& path);

/// Refuses a folder that results must not replace: one that holds any file that its manifest.json does not list as
/// written with it. A folder that is missing or empty passes.
/// @throws DataError naming the first such file
void require_replaceable(const std::filesystem::path& folder);

/// A folder that appears all or nothing: fill `path()`, then `commit()`.
/// Without commit the destructor removes what was written and an older folder of that name stays as it was.
class AtomicFolder {
 public:
  /// Makes an empty folder with a temporary name beside `target`. @throws DataError if the parent folder is missing or
  /// read-only.
  explicit AtomicFolder(std::filesystem::path target);
  ~AtomicFolder();
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  /// Where to write until commit.
  [[nodiscard]] const std::filesystem::path& path() const { return temporary_; }

  /// Renames the folder to its target; a folder that is there is replaced, and only removed once the new one is in
  /// place. Where there is a manifest.json, it first gets the key `files`: every file of the folder, relative and sorted.
  /// @throws DataError if that cannot be done; then the older folder stays. @pre called once.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  bool is_committed_ = false;
};

}  // namespace incise
