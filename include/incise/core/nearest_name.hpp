#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// Returns the candidate that a person most likely meant: the one with the fewest insertions, deletions, replacements
/// and swaps of neighbouring characters (optimal string alignment), the first of equals. Empty if there are no
/// candidates.
[[nodiscard]] std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace incise
