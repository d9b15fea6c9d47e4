#pragma once

#include <fmt/format.h>

#include <string>

namespace incise {

/// Returns why a pose is ambiguous, for a person. @param rival_score  of the rival.  @param score  of the pose, >= 0.
[[nodiscard]] inline std::string rival_reason(double rival_score, double score) {
  if (score == 0.0)
    return fmt::format("another pose fits better: its score is {:.3f}, that of the pose found is 0", rival_score);
  return fmt::format("another pose fits about as well: its score is {:.0f} % of the score of the pose found",
                     100.0 * rival_score / score);
}

}  // namespace incise
