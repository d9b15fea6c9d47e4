#pragma once

#include <incise/core/names.hpp>

namespace incise {

/// How an incision, or a search for equilibrium, ended. A failed incision is a result, never an exception.
enum class Outcome {
  Success,          ///< Closed ring (or complete open cut) with a negative margin; equilibrium found.
  PositiveMargin,   ///< The cut touches or enters the tumour edge.
  OpenLoop,         ///< The ring does not close.
  NotConverged,     ///< A solver reached its iteration limit.
  ElementInverted,  ///< An element turned inside out and could not be recovered.
  Cancelled,        ///< Stopped on request; a checkpoint holds the state.
};
/// Names in files.
inline constexpr std::array<std::string_view, 6> kOutcomeNames{"success",       "positive_margin",  "open_loop",
                                                               "not_converged", "element_inverted", "cancelled"};
[[nodiscard]] constexpr Names names_of(Outcome) {
  return kOutcomeNames;
}

/// Returns the outcome in words for a person: the rest of a sentence that begins with "the cut".
[[nodiscard]] constexpr std::string_view in_words(Outcome outcome) {
  constexpr std::array<std::string_view, 6> kWords{
      "was simulated to its end",
      "was simulated to its end, and touches or enters the tumour's edge",
      "was simulated to its end, and stays open: its ring does not close, or a line is not cut from end to end",
      "did not converge: its equations were not solved well enough to be a result",
      "did not converge: somewhere the tissue was turned inside out",
      "was stopped before its end"};
  return kWords[static_cast<std::size_t>(outcome)];
}

}  // namespace incise
