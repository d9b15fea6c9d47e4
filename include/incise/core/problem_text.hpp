#pragma once

#include <incise/core/error.hpp>

#include <string>

namespace incise {

/// What a broken precondition says without the name of the function that found it, for passing it on to a person whose
/// file or case broke it.
[[nodiscard]] std::string without_function_name(const InvalidArgument& problem);

/// As above, as a sentence of its own: for the hint of another error.
[[nodiscard]] std::string as_sentence(const InvalidArgument& problem);

}  // namespace incise
