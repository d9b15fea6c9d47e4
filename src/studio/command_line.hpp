#pragma once

#include <string>
#include <vector>

namespace incise::studio {

/// Returns the command that repeats a call, for a person to type: `incise` and these words, quoted for a POSIX shell.
[[nodiscard]] std::string command_line(const std::vector<std::string>& words);

}  // namespace incise::studio
