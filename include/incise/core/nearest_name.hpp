#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// The valid name that a person most likely meant: fewest insertions, deletions, replacements and swaps of neighbours
/// (optimal string alignment), the first of equals. Empty when there are no candidates.
[[nodiscard]] std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace incise
