#pragma once

#include <incise/core/error.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

namespace incise {

/// A hidden folder beside the target. Files are written there under their final names, because a .mhd names its voxel
/// file, and then move out together.
class StagingFolder {
 public:
  explicit StagingFolder(const std::filesystem::path& target) : target_(target) {
    const std::filesystem::path parent =
        target.parent_path().empty() ? std::filesystem::path(".") : target.parent_path();
    std::error_code error;
    if (!std::filesystem::is_directory(parent, error)) {
      throw DataError(target, "", fmt::format("no folder '{}'", parent.string()), "an existing folder to write into");
    }
    if (std::filesystem::is_directory(target, error))
      throw DataError(target, "", "a folder", "a file name to write to");
    folder_ = parent / fmt::format(".{}.{}.part", target.filename().string(), ::getpid());
    std::filesystem::create_directory(folder_, error);
    if (error) throw DataError(target, "", error.message(), "a folder that can be written");
  }
  ~StagingFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  StagingFolder(const StagingFolder&) = delete;
  StagingFolder& operator=(const StagingFolder&) = delete;

  [[nodiscard]] std::filesystem::path file() const { return folder_ / target_.filename(); }

  /// Moves the files to their final place, voxels first, so that a header never names missing voxels.
  void move_out() const {
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      if (entry.path() != file()) move_one(entry.path());
    }
    move_one(file());
  }

 private:
  void move_one(const std::filesystem::path& from) const {
    std::error_code error;
    std::filesystem::rename(from, target_.parent_path() / from.filename(), error);
    if (error) throw DataError(target_, "", error.message(), "a file that can be written");
  }

  std::filesystem::path target_;
  std::filesystem::path folder_;
};

}  // namespace incise
