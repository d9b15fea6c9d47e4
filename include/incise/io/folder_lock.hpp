#pragma once

#include <filesystem>

namespace incise {

/// Exclusive right to write into a folder: while one lock exists, no other process and no other lock in this process
/// can get it. The system releases it when the owner ends, however it ends. Locks the folder itself (flock); no lock
/// file is made.
class FolderLock {
 public:
  /// Makes the folder if it is missing, and locks it without waiting. @throws DataError if it is locked (naming the
  /// process), if it cannot be made or opened, or if its file system does not support locks.
  explicit FolderLock(std::filesystem::path folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Releases the lock early.
  void release();

 private:
  std::filesystem::path folder_;
  int file_ = -1;
};

}  // namespace incise
