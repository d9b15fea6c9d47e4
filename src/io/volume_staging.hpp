#pragma once

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>

#include <fmt/format.h>

#include <filesystem>

namespace incise {

/// A hidden folder beside the target, removed at the end: files get their final names in it (a .mhd names its voxel
/// file) and then move out together.
class StagingFolder {
 public:
  explicit StagingFolder(const std::filesystem::path& target) : target_(target), folder_(folder_beside(target)) {}

  [[nodiscard]] std::filesystem::path file() const { return folder_.path() / target_.filename(); }

  /// Moves voxel files first, so that a header never names voxels that are not there.
  void move_out() const {
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      if (entry.path() != file()) move_one(entry.path());
    }
    move_one(file());
  }

 private:
  /// @throws DataError that names the target, not the hidden folder.
  static AtomicFolder folder_beside(const std::filesystem::path& target) {
    require_writable(target);
    try {
      return AtomicFolder(target.parent_path() / ("." + target.filename().string()));
    } catch (const DataError& error) {
      throw DataError(target, "", fmt::format("no room for a hidden folder beside it ({})", error.what()),
                      "a folder that can be written");
    }
  }
  void move_one(const std::filesystem::path& from) const {
    std::error_code error;
    std::filesystem::rename(from, target_.parent_path() / from.filename(), error);
    if (error) throw DataError(target_, "", error.message(), "a file that can be written");
  }

  std::filesystem::path target_;
  AtomicFolder folder_;  // is never put in place
};

}  // namespace incise
