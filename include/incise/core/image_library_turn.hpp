#pragma once

#include <mutex>

namespace incise {

/// The right to call the image libraries (ITK, GDCM) and to fork, for one thread at a time. ITK ends the threads of its
/// pool whenever the process is forked, as it is for every file that is decoded in a process of its own, whatever they
/// are doing; and standard error, which is closed while these libraries run, belongs to the whole process.
/// Keep it around such calls only. Not for nested use, and not in the forked process, where nobody would give it back.
class [[nodiscard]] ImageLibraryTurn {
 public:
  ImageLibraryTurn();

 private:
  std::lock_guard<std::mutex> turn_;
};

}  // namespace incise
