#include "parse_error.hpp"

#include <incise/core/nearest_name.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

namespace incise::cli {
namespace {

constexpr const char* kCommandLine = "command line";

/// Returns the verb that the parser had reached, or the application if it had reached none.
const CLI::App& verb_reached(const CLI::App& app) {
  const CLI::App* at = &app;
  while (!at->get_subcommands().empty()) at = at->get_subcommands().back();
  return *at;
}

/// "incise bench make"
std::string words_of(const CLI::App& verb) {
  return verb.get_parent() == nullptr ? verb.get_name() : words_of(*verb.get_parent()) + " " + verb.get_name();
}

std::string hint_for(const CLI::App& verb) {
  return fmt::format("See `{} --help`", words_of(verb));
}

/// Returns the option that a message of CLI11 is about ("--frames: …", "Could not convert: --frames = …", "case is
/// required").
const CLI::Option* option_named_in(const CLI::App& verb, const std::string& message) {
  for (const CLI::Option* option : verb.get_options()) {
    const std::string name = option->get_name();
    for (const std::string& start : {name + ": ", "Could not convert: " + name + " = ", name + " is required"}) {
      if (message.starts_with(start)) return option;
    }
  }
  return nullptr;
}

/// Returns a number unchanged, a word in quotes.
std::string quoted(const std::string& text) {
  char* end = nullptr;
  static_cast<void>(std::strtod(text.c_str(), &end));
  return !text.empty() && *end == '\0' ? text : "'" + text + "'";
}

std::string kind_of_value(const std::string& type) {
  if (type == "INT" || type == "UINT") return "a whole number";
  return type == "FLOAT" ? "a number" : "a word";
}

/// CLI11's "INT:INT in [1 - 500]", "TEXT:{portable,avx2}" or "UINT:NONNEGATIVE" in words.
std::string expected_by(const CLI::Option& option) {
  const std::string type_name = option.get_type_name();
  const std::size_t colon = type_name.find(':');
  const std::string type = type_name.substr(0, colon);
  if (colon == std::string::npos) return kind_of_value(type);
  std::string check = type_name.substr(colon + 1);
  if (check.starts_with('{')) {
    std::string names;
    for (const char c : check.substr(1, check.find('}') - 1)) names += c == ',' ? std::string(", ") : std::string(1, c);
    return "one of " + names;
  }
  if (check == "POSITIVE") return kind_of_value(type) + " above 0";
  if (check == "NONNEGATIVE") return kind_of_value(type) + " of at least 0";
  const std::size_t range = check.find(" in [");
  const std::size_t dash = check.find(" - ", range);
  if (range == std::string::npos || dash == std::string::npos) return check;
  return fmt::format("{} from {} to {}", kind_of_value(type), check.substr(range + 5, dash - range - 5),
                     check.substr(dash + 3, check.find(']') - dash - 3));
}

CaseError bad_value(const CLI::Option& option, const CLI::App& verb) {
  std::vector<std::string> given;
  for (const std::string& text : option.results()) given.push_back(quoted(text));
  return {kCommandLine, option.get_name(), fmt::format("{}", fmt::join(given, " ")), expected_by(option),
          hint_for(verb)};
}

CaseError wrong_count(const CLI::Option& option, const CLI::App& verb) {
  const auto values = [](std::size_t count) {
    return count == 0 ? std::string("no value") : fmt::format("{} {}", count, count == 1 ? "value" : "values");
  };
  return {kCommandLine, option.get_name(), values(option.results().size()),
          values(static_cast<std::size_t>(option.get_items_expected_min())), hint_for(verb)};
}

CaseError not_understood(const CLI::App& verb) {
  const std::vector<std::string> extras = verb.remaining(true);
  // If an option is left over, so is its value, which comes first.
  const auto unknown =
      std::find_if(extras.begin(), extras.end(), [](const std::string& word) { return word.starts_with('-'); });
  const std::string first = unknown != extras.end() ? *unknown : extras.empty() ? "" : extras.front();
  if (!first.starts_with('-')) {
    return {kCommandLine, words_of(verb), quoted(first), "no further argument", hint_for(verb)};
  }
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options()) {
    if (option->get_name().starts_with('-')) names.push_back(option->get_name());
  }
  const std::string meant = did_you_mean(first, names);
  return {kCommandLine, words_of(verb), quoted(first), "one of its options",
          fmt::format("{}{}{}", meant, meant.empty() ? "" : " ", hint_for(verb))};
}

CaseError no_verb(const CLI::App& group) {
  std::vector<std::string> verbs;
  for (const CLI::App* verb : group.get_subcommands([](const CLI::App*) { return true; }))
    verbs.push_back(verb->get_name());
  const std::vector<std::string> extras = group.remaining(true);
  return {kCommandLine, group.get_parent() == nullptr ? "verb" : words_of(group),
          extras.empty() ? "nothing" : quoted(extras.front()), fmt::format("one of {}", fmt::join(verbs, ", ")),
          hint_for(group)};
}

}  // namespace

CaseError as_case_error(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& verb = verb_reached(app);
  // Uses the exit code, because the name of an error may be the name of a verb.
  const auto kind = static_cast<CLI::ExitCodes>(error.get_exit_code());
  const std::string message = error.what();
  if (kind == CLI::ExitCodes::ExtrasError) return not_understood(verb);
  const CLI::Option* option = option_named_in(verb, message);
  if (kind == CLI::ExitCodes::RequiredError && option != nullptr) {
    return {kCommandLine, option->get_name(), "nothing", within_sentence(option->get_description()), hint_for(verb)};
  }
  if (kind == CLI::ExitCodes::RequiredError) return no_verb(verb);
  if (kind == CLI::ExitCodes::ArgumentMismatch && option != nullptr) return wrong_count(*option, verb);
  if (option != nullptr) return bad_value(*option, verb);
  return {kCommandLine, words_of(verb), message, "options that go together", hint_for(verb)};
}

}  // namespace incise::cli
