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
/// Used in files.
inline constexpr std::array<std::string_view, 6> kOutcomeNames{"success",       "positive_margin",  "open_loop",
                                                               "not_converged", "element_inverted", "cancelled"};
[[nodiscard]] constexpr Names names_of(Outcome) {
  return kOutcomeNames;
}

}  // namespace incise
