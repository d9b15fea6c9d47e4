#include "standard_streams.hpp"

#include <incise/core/error.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <iostream>

namespace incise::cli {
namespace {

bool is_closed(int stream) { return ::fcntl(stream, F_GETFD) == -1 && errno == EBADF; }

}  // namespace

void say(std::string_view text) { static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr)); }

void prepare_standard_streams() {
  std::signal(SIGPIPE, SIG_IGN);
  const bool has_output = !is_closed(STDOUT_FILENO);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (is_closed(stream)) static_cast<void>(::open("/dev/null", O_RDWR));  // takes the lowest free number: this one
  }
  if (!has_output)
    throw DataError("standard output", "", "a closed stream", "an open stream", "Use >/dev/null to print nothing");
}

void finish_standard_output() {
  errno = 0;
  std::cout.flush();
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return;
  if (errno == 0 && ::write(STDOUT_FILENO, "\n", 1) == 1) errno = 0;  // it failed earlier: writes again to learn why
  throw DataError("standard output", "", errno != 0 ? system_reason(errno) : "a failed write", kAllOutput,
                  "Output files are complete");
}

}  // namespace incise::cli
