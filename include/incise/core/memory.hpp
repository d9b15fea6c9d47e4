#pragma once

#include <cstdint>
#include <optional>

namespace incise {

/// Memory that this process can still take, bytes: the least of what the machine has to spare (Linux: MemAvailable), what is left of the
/// limit of its control group, and what is left of its own limits (RLIMIT_AS, RLIMIT_DATA). Nothing where the system tells none of them.
[[nodiscard]] std::optional<std::uint64_t> available_memory_bytes();

/// Memory that this process holds now, bytes (Linux: VmRSS). Nothing where the system does not tell.
[[nodiscard]] std::optional<std::uint64_t> held_memory_bytes();

/// The most memory that this process has held so far, bytes (Linux: VmHWM). Nothing where the system does not tell.
[[nodiscard]] std::optional<std::uint64_t> peak_memory_bytes();

}  // namespace incise
