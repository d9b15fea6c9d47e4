#include <incise/core/memory.hpp>

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace incise {
namespace {

using Bytes = std::optional<std::uint64_t>;

/// Returns the number after `name` in a file of lines "name 123" or "name: 123 kB".
Bytes number_in(const char* file, const std::string& name) {
  std::ifstream stream(file);
  for (std::string word; stream >> word; stream.ignore(std::numeric_limits<std::streamsize>::max(), '\n')) {
    if (std::uint64_t number = 0; word == name && stream >> number) return number;
  }
  return std::nullopt;
}

Bytes kilobytes_in(const char* file, const std::string& name) {
  const Bytes kilobytes = number_in(file, name + ":");
  return kilobytes ? Bytes(1024 * *kilobytes) : std::nullopt;
}

/// Returns the one number in a file; nullopt for "max".
Bytes number_in(const char* file) {
  std::ifstream stream(file);
  if (std::uint64_t number = 0; stream >> number) return number;
  return std::nullopt;
}

Bytes left_of(const Bytes& limit, const Bytes& used) {
  if (!limit || !used) return std::nullopt;
  return *limit > *used ? *limit - *used : 0;
}

Bytes own_limit(decltype(RLIMIT_AS) which) {
  rlimit limit{};
  if (getrlimit(which, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return std::nullopt;
  return limit.rlim_cur;
}

/// Returns the rest of the limit of the control group (version 2) that the process sees as the root, as in a container.
/// Cached files count as free, because they give way.
Bytes left_in_control_group() {
  const Bytes used = number_in("/sys/fs/cgroup/memory.current");
  const std::uint64_t cached = number_in("/sys/fs/cgroup/memory.stat", "inactive_file").value_or(0) +
                               number_in("/sys/fs/cgroup/memory.stat", "active_file").value_or(0);
  return left_of(number_in("/sys/fs/cgroup/memory.max"), left_of(used, cached));
}

constexpr const char* kStatus = "/proc/self/status";

}  // namespace

std::optional<std::uint64_t> available_memory_bytes() {
  Bytes least;
  for (const Bytes& left : {kilobytes_in("/proc/meminfo", "MemAvailable"), left_in_control_group(),
                            left_of(own_limit(RLIMIT_AS), kilobytes_in(kStatus, "VmSize")),
                            left_of(own_limit(RLIMIT_DATA), kilobytes_in(kStatus, "VmData"))}) {
    if (left) least = std::min(least.value_or(*left), *left);
  }
  return least;
}

std::optional<std::uint64_t> held_memory_bytes() { return kilobytes_in(kStatus, "VmRSS"); }

std::optional<std::uint64_t> peak_memory_bytes() { return kilobytes_in(kStatus, "VmHWM"); }

}  // namespace incise
