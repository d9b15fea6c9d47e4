#pragma once

namespace incise {

/// While it lives, nothing that is printed to standard error is seen. ITK, GDCM, MetaIO and the codecs under them print
/// warnings there, each in its own way and some without a switch; the library speaks through exceptions and the monitor
/// instead. Keep it around calls of these libraries only: it acts on the whole process, progress bars and other threads
/// included.
class QuietImageLibraries {
 public:
  QuietImageLibraries();
  ~QuietImageLibraries();
  QuietImageLibraries(const QuietImageLibraries&) = delete;
  QuietImageLibraries& operator=(const QuietImageLibraries&) = delete;

 private:
  int standard_error_;  ///< a copy of its descriptor, or -1 if it is closed anyway
};

}  // namespace incise
