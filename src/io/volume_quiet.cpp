#include "io/volume_quiet.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>

namespace incise {

QuietImageLibraries::QuietImageLibraries() : standard_error_(::dup(STDERR_FILENO)) {
  std::cerr.flush();
  std::fflush(stderr);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere < 0) return;
  if (standard_error_ >= 0) ::dup2(nowhere, STDERR_FILENO);
  ::close(nowhere);
}

QuietImageLibraries::~QuietImageLibraries() {
  if (standard_error_ < 0) return;
  std::cerr.flush();
  std::fflush(stderr);
  ::dup2(standard_error_, STDERR_FILENO);
  ::close(standard_error_);
}

}  // namespace incise
