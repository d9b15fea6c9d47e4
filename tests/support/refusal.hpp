#pragma once

#include <optional>
#include <string>

namespace incise::testing {

/// Returns the error of type ErrorType that the action throws; nothing if it throws none. Errors of other types
/// propagate.
template <class ErrorType, class Action>
[[nodiscard]] std::optional<ErrorType> error_of(const Action& action) {
  try {
    static_cast<void>(action());
  } catch (const ErrorType& error) {
    return error;
  }
  return std::nullopt;
}

/// Returns the message of that error, or "accepted".
template <class ErrorType, class Action>
[[nodiscard]] std::string refusal_of(const Action& action) {
  const std::optional<ErrorType> error = error_of<ErrorType>(action);
  return error ? error->what() : "accepted";
}

}  // namespace incise::testing
