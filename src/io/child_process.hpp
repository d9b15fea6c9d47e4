#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace incise::io_detail {

/// Limits on work with an untrusted file.
struct ChildLimits {
  std::uint64_t memory_bytes = 0;  ///< in addition to the memory that the process holds already
  unsigned processor_s = 0;        ///< processor time, s; wall time would depend on the machine's load
};

/// Runs `work` in a forked copy of this process and returns its result. Image libraries stop the whole process on some
/// damaged files, or never return: here that affects only the copy.
/// @param file  named in messages  @param what  format of the file, for messages: "NRRD"
/// @throws DataError with the message of a DataError that `work` threw; also if `work` threw anything else, was stopped
///         by a signal, or exceeded the limits.
/// @note Linux only. The copy has one thread, so `work` must use no others.
[[nodiscard]] std::string in_child_process(const std::filesystem::path& file, const std::string& what, const ChildLimits& limits,
                                           const std::function<std::string()>& work);

}  // namespace incise::io_detail
