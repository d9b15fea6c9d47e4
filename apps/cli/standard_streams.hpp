#pragma once

#include <string_view>

namespace incise::cli {

/// What is expected of standard output, for messages.
inline constexpr const char* kAllOutput = "a stream that accepts all output";

/// Writes to standard error. A failure is ignored: the results are in files, on standard output, and in the exit
/// status.
void say(std::string_view text);

/// Makes the three standard streams usable before any file is opened. A file would otherwise take the place of a closed
/// stream and receive what is printed. Writing to a closed pipe then fails instead of ending the process.
/// @throws DataError if standard output is closed.
void prepare_standard_streams();

/// Flushes standard output. @throws DataError if it did not accept everything.
void finish_standard_output();

}  // namespace incise::cli
