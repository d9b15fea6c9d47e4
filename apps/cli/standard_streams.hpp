#pragma once

#include <string_view>

namespace incise::cli {

/// Writes to standard error. Where nobody can read that, the work goes on: what counts is in files, on standard output, and in the exit status.
void say(std::string_view text);

/// Makes the three standard streams usable before any file is opened, which would else take the place of a closed one and receive what is
/// printed. A closed pipe becomes a failed write in place of the end of the process.
/// @throws DataError where standard output is closed.
void prepare_standard_streams();

/// Brings what was printed to its place. @throws DataError where standard output could not take all of it.
void finish_standard_output();

}  // namespace incise::cli
