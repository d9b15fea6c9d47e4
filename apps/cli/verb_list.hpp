#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace incise::cli {

/// Returns what a verb does, as the one line in `incise --help`. @throws InvalidArgument for a verb without one.
[[nodiscard]] std::string line_of(const std::string& verb);

/// Lists the application's verbs in groups, one line each; the verbs to begin with come first.
class VerbList : public CLI::Formatter {
 public:
  VerbList() { label("SUBCOMMAND", "VERB"); }
  std::string make_subcommands(const CLI::App* app, CLI::AppFormatMode mode) const override;
};

}  // namespace incise::cli
