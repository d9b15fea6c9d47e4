#pragma once

#include <incise/core/monitor.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace incise::cli {

/// A verb of this very program, run as a process of its own: it knows what its arguments name, and nothing else.
struct OwnProcess {
  std::vector<std::string> arguments;  ///< of the verb, its name first
  std::filesystem::path output;        ///< receives its standard output
  std::filesystem::path log;           ///< its messages are added here
};

/// Runs it to its end. When the monitor asks to stop, the process is asked to stop as by Ctrl-C, and waited for.
/// @returns its exit status; 128 + n where signal n ended it.
/// @throws Cancelled when the monitor asked to stop; DataError where the process cannot be started or a file not written.
int run_process(const OwnProcess& process, const Monitor& monitor);

/// A command as a shell would be given it.
[[nodiscard]] std::string shell_line(const std::vector<std::string>& arguments);

}  // namespace incise::cli
