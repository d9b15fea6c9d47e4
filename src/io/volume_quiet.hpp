#pragma once

namespace incise {

/// Discards all output to standard error while it exists. ITK, GDCM, MetaIO and their codecs print warnings there, some
/// without a switch; incise reports through exceptions and the monitor instead. Use it only around calls of these
/// libraries, because it affects the whole process, including progress bars and other threads.
class QuietImageLibraries {
 public:
  QuietImageLibraries();
  ~QuietImageLibraries();
  QuietImageLibraries(const QuietImageLibraries&) = delete;
  QuietImageLibraries& operator=(const QuietImageLibraries&) = delete;

 private:
  int standard_error_;  ///< copy of the descriptor of standard error; -1 if that is closed
};

}  // namespace incise
