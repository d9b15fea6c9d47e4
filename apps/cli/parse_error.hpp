#pragma once

#include <incise/core/error.hpp>

#include <CLI/CLI.hpp>

namespace incise::cli {

/// What is wrong with the command line, in the words of all errors: which option, what was found, what is expected.
/// @param app  as it stands after the parse that failed.
[[nodiscard]] CaseError as_case_error(const CLI::App& app, const CLI::ParseError& error);

}  // namespace incise::cli
