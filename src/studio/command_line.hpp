#pragma once

#include <string>
#include <vector>

namespace incise::studio {

/// The command that repeats a call, as a person types it: `incise` and these words, quoted for a POSIX shell.
[[nodiscard]] std::string command_line(const std::vector<std::string>& words);

}  // namespace incise::studio
