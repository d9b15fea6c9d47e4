#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace incise::cli {

/// What a verb does, in the one line that `incise --help` gives it. @throws InvalidArgument for a verb without one.
[[nodiscard]] std::string line_of(const std::string& verb);

/// Lists the application's verbs in groups, those that one begins with first, one line each.
class VerbList : public CLI::Formatter {
 public:
  VerbList() { label("SUBCOMMAND", "VERB"); }
  std::string make_subcommands(const CLI::App* app, CLI::AppFormatMode mode) const override;
};

}  // namespace incise::cli
