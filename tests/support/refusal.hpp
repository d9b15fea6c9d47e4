#pragma once

#include <optional>
#include <string>

namespace incise::testing {

/// The error of that type that `action` ends in; nothing where it ends well. An error of another type goes on.
template <class ErrorType, class Action>
std::optional<ErrorType> error_of(const Action& action) {
  try {
    static_cast<void>(action());
  } catch (const ErrorType& error) {
    return error;
  }
  return std::nullopt;
}

/// The message of that error, or "accepted".
template <class ErrorType, class Action>
std::string refusal_of(const Action& action) {
  const std::optional<ErrorType> error = error_of<ErrorType>(action);
  return error ? error->what() : "accepted";
}

}  // namespace incise::testing
