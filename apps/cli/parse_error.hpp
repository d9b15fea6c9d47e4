#pragma once

#include <incise/core/error.hpp>

#include <CLI/CLI.hpp>

namespace incise::cli {

/// Returns the parser's error in the form of all other errors: which option, what was found, what is expected.
/// @param app  in its state after the failed parse.
[[nodiscard]] CaseError as_case_error(const CLI::App& app, const CLI::ParseError& error);

}  // namespace incise::cli
