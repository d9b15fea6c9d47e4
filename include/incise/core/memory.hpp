#pragma once

#include <cstdint>
#include <optional>

namespace incise {

/// Returns the memory that this process can still allocate, bytes: the least of the machine's available memory (Linux:
/// MemAvailable), the rest of its control group's limit, and the rest of its own limits (RLIMIT_AS, RLIMIT_DATA).
/// nullopt where the system reports none of these.
[[nodiscard]] std::optional<std::uint64_t> available_memory_bytes();

/// Returns the memory that this process holds now, bytes (Linux: VmRSS); nullopt where the system does not report it.
[[nodiscard]] std::optional<std::uint64_t> held_memory_bytes();

/// Returns the most memory that this process has held so far, bytes (Linux: VmHWM); nullopt where the system does not
/// report it.
[[nodiscard]] std::optional<std::uint64_t> peak_memory_bytes();

}  // namespace incise
