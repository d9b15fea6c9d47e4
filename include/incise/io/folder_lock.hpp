#pragma once

#include <filesystem>

namespace incise {

/// The right to write into a folder, held by one owner at a time: while one holds it, no other process and no other lock of this process gets it.
/// The system gives it back when the owner ends, however it ends. No file is made: the folder itself is locked (flock).
class FolderLock {
 public:
  /// Makes the folder where it is missing. @throws DataError naming the folder and the process that holds it; where the folder cannot be made or
  /// opened; where its file system knows no locks.
  explicit FolderLock(std::filesystem::path folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Gives the folder back early.
  void release();

 private:
  std::filesystem::path folder_;
  int file_ = -1;
};

}  // namespace incise
