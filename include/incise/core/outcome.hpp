#pragma once

#include <optional>
#include <string_view>

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

/// The name used in files: success, positive_margin, open_loop, not_converged, element_inverted, cancelled.
[[nodiscard]] constexpr std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::Success: return "success";
    case Outcome::PositiveMargin: return "positive_margin";
    case Outcome::OpenLoop: return "open_loop";
    case Outcome::NotConverged: return "not_converged";
    case Outcome::ElementInverted: return "element_inverted";
    case Outcome::Cancelled: return "cancelled";
  }
  return "unknown";
}

/// The outcome of that name; nullopt for any other.
[[nodiscard]] constexpr std::optional<Outcome> parse_outcome(std::string_view name) {
  for (const Outcome outcome : {Outcome::Success, Outcome::PositiveMargin, Outcome::OpenLoop, Outcome::NotConverged,
                                Outcome::ElementInverted, Outcome::Cancelled}) {
    if (name == to_string(outcome)) return outcome;
  }
  return std::nullopt;
}

}  // namespace incise
