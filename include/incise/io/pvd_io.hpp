#pragma once

#include <filesystem>
#include <vector>

namespace incise {

/// One moment of a ParaView time series.
struct PvdFrame {
  double time_s = 0.0;
  std::filesystem::path file;  ///< a .vtu or .vtp, relative to the folder of the .pvd
};

/// Writes a ParaView collection (`.pvd`), all or nothing.
/// @pre at least one frame, finite and strictly increasing times, relative file names (InvalidArgument).
/// @throws DataError if the file cannot be written.
void write_pvd(const std::filesystem::path& path, const std::vector<PvdFrame>& frames);

/// Reads a ParaView collection and sorts its frames by time. @throws DataError if it is missing, damaged or empty.
[[nodiscard]] std::vector<PvdFrame> read_pvd(const std::filesystem::path& path);

}  // namespace incise
