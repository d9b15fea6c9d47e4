#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// Returns the candidate that a person most likely meant: the one with the fewest insertions, deletions, replacements
/// and swaps of neighbouring characters (optimal string alignment), the first of equals. Empty if none is near: if each
/// needs more such edits than a third of the longer word's length (always 1 is allowed) and contains the word nowhere.
[[nodiscard]] std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates);

/// Returns the hint "Did you mean 'NAME'?", or nothing if no candidate is near.
[[nodiscard]] std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace incise
