#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace incise::io_detail {

/// What work on a file that nobody has vouched for may take.
struct ChildLimits {
  std::uint64_t memory_bytes = 0;  ///< beside what the process holds already
  unsigned processor_s = 0;        ///< of processor time, so that a busy machine does not count
};

/// Does work in a process of its own (a copy of this one) and returns the bytes that it returns there. Image libraries stop the whole process
/// on some damaged files, or never end: here that ends the copy alone.
/// @param file  named in messages.  @param what  the work's kind of file: "NRRD".
/// @throws DataError with the words of one that the work threw; and where the work threw anything else, was stopped by a signal, or took
///         more than the limits.
/// @note The copy has one thread: work may use no others.  Linux.
[[nodiscard]] std::string in_child_process(const std::filesystem::path& file, const std::string& what, const ChildLimits& limits,
                                           const std::function<std::string()>& work);

}  // namespace incise::io_detail
