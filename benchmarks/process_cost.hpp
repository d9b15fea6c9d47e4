#pragma once

#include <sys/resource.h>

#include <cstdlib>
#include <ctime>

namespace incise::bench {

inline double seconds_of(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Of all threads of this process.
inline double processor_seconds() {
  return seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}
inline double wall_seconds() {
  return seconds_of(CLOCK_MONOTONIC);
}

/// Most memory that this process has held so far.
inline double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// Mean number of busy processes in the last minute, this one included; negative: unknown.
inline double load_average() {
  double loads[1] = {0.0};
  return getloadavg(loads, 1) == 1 ? loads[0] : -1.0;
}

}  // namespace incise::bench
