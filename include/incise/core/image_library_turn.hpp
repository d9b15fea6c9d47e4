#pragma once

#include <mutex>

namespace incise {

/// A process-wide lock that lets one thread at a time call the image libraries (ITK, GDCM) or fork. At each fork, ITK
/// ends the threads of its pool, whatever they are doing, and incise forks to decode each file in a separate process.
/// Standard error, which is closed while these libraries run, also belongs to the whole process.
/// Hold the lock only during such calls. Not for nested use, and not in the forked process, where it is never released.
class [[nodiscard]] ImageLibraryTurn {
 public:
  ImageLibraryTurn();

 private:
  std::lock_guard<std::mutex> turn_;
};

}  // namespace incise
