#include "options.hpp"
#include "parse_error.hpp"
#include "standard_streams.hpp"
#include "verb_list.hpp"

#include <incise/core/error.hpp>
#include <incise/core/nearest_name.hpp>
#include <incise/core/utf8.hpp>
#include <incise/core/version.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <system_error>
#include <vector>

namespace {

using namespace incise;
using namespace incise::cli;

std::string joined(int argc, char** argv) {
  std::string line;
  for (int i = 0; i < argc; ++i) line += (i == 0 ? "" : " ") + std::string(argv[i]);
  return line;
}

/// Refuses an unknown verb by its name; CLI11 would only say that a verb is required.
void refuse_unknown_verb(const CLI::App& app, const std::string& word) {
  std::vector<std::string> verbs;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (verb->check_name(word)) return;
    verbs.push_back(verb->get_name());
  }
  throw CaseError("command line", "verb", fmt::format("'{}'", word), fmt::format("one of {}", fmt::join(verbs, ", ")),
                  did_you_mean(word, verbs));
}

/// strtod and CLI11 accept "nan" and "inf" as numbers, and no range check stops a NaN.
void refuse_numbers_that_are_not_finite(int argc, char** argv) {
  for (int i = 2; i < argc; ++i) {
    std::string word = argv[i], name = argv[i];  // name: the option of the number, if there is one
    const std::size_t equals = word.find('=');
    if (word.rfind("--", 0) == 0 && equals != std::string::npos) {
      name = word.substr(0, equals);
      word = word.substr(equals + 1);
    } else if (std::string(argv[i - 1]).rfind("--", 0) == 0) {
      name = argv[i - 1];
    }
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (end != word.c_str() && *end == '\0' && !std::isfinite(value)) {
      throw CaseError("command line", name, word, "a finite number", "For a file of that name, write ./" + word);
    }
  }
}

/// Returns text that any terminal can show: '?' for every byte that is not ASCII.
std::string printable(std::string text) {
  std::ranges::replace_if(text, [](char c) { return static_cast<unsigned char>(c) >= 0x80 || static_cast<unsigned char>(c) < 0x20; }, '?');
  return text;
}

/// Names are written into JSON files (manifests, results), which must be UTF-8; at that point an error would be too
/// late.
void refuse_names_that_are_not_utf8(int argc, char** argv) {
  constexpr const char* kExpected = "UTF-8";
  constexpr const char* kHint = "Rename that file or folder";
  for (int i = 1; i < argc; ++i) {
    if (const auto at = first_not_utf8(argv[i])) throw CaseError("command line", fmt::format("word {}", i + 1), fmt::format("'{}' with a byte 0x{:02X}", printable(argv[i]), static_cast<unsigned char>(argv[i][*at])), kExpected, kHint);
  }
  std::error_code absent;
  const std::string here = std::filesystem::current_path(absent).string();
  if (first_not_utf8(here)) throw CaseError("command line", "working folder", fmt::format("'{}'", printable(here)), kExpected, kHint);
}

/// Turns `incise help VERB` into `incise VERB --help`, and `incise` alone into `incise --help`.
std::vector<char*> without_help_verb(int argc, char** argv) {
  static char help[] = "--help";
  std::vector<char*> words(argv, argv + argc);
  if (argc > 1 && std::string(argv[1]) != "help") return words;
  if (argc > 1) words.erase(words.begin() + 1);
  words.push_back(help);
  return words;
}

int run(int argc, char** argv) {
  CLI::App app("Plans robotic soft-tissue incisions by simulating them first.", "incise");
  app.set_version_flag("--version", fmt::format("incise {} ({})", version(), source_commit()));
  app.require_subcommand(1);
  app.formatter(std::make_shared<VerbList>());
  app.option_defaults()->always_capture_default();
  app.footer("\n`incise help VERB` and `incise VERB --help` explain a verb and end with an example.\n");
  Application application(app, joined(argc, argv));
  add_bench(application);
  add_demo(application);
  add_run(application);
  add_phantom(application);
  add_segment(application);
  add_mesh(application);
  add_stages(application);
  add_compensate(application);
  add_forecast(application);
  add_assess(application);
  add_interchange(application);
  add_evaluate(application);
  add_calibrate(application);
  add_surface(application);
  add_register(application);
  add_track(application);
  add_power(application);
  add_project(application);
  add_compare(application);
  add_audit(application);
  add_export(application);
  add_replay(application);
  add_report(application);
  add_verify(application);
  add_schema(application);
  add_experiment(application);
  add_studio(application);
  if (argc > 1 && argv[1][0] != '-') refuse_unknown_verb(app, argv[1]);
  refuse_numbers_that_are_not_finite(argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) throw as_case_error(app, error);
    app.exit(error);  // --help, --version
    return kDone;
  }
  return application.status();
}

}  // namespace

int main(int argc, char** argv) {
  const auto ended = [](int status, const std::string& why) {
    say(fmt::format("incise: {}\n", why));
    return status;
  };
  try {
    prepare_standard_streams();
    refuse_names_that_are_not_utf8(argc, argv);
    std::vector<char*> words = without_help_verb(argc, argv);
    const int status = run(static_cast<int>(words.size()), words.data());
    finish_standard_output();
    return argc < 2 ? kBadCase : status;  // no verb was given
  } catch (const CaseError& error) {
    return ended(kBadCase, error.what());
  } catch (const DataError& error) {
    return ended(kBadData, error.what());
  } catch (const StagesKept& error) {
    return ended(kInterrupted, error.what());
  } catch (const Cancelled& error) {
    return ended(kInterrupted, fmt::format("{}; nothing was written", error.what()));
  } catch (const std::filesystem::filesystem_error& error) {
    return ended(kBadData, DataError(error.path1(), "", system_reason(error.code()), "a path that can be used").what());
  } catch (const std::system_error& error) {  // from fmt, if standard output accepts no more
    return ended(kBadData, DataError("standard output", "", system_reason(error.code()), kAllOutput).what());
  } catch (const nlohmann::json::exception& error) {
    return ended(kBadData,
                 DataError("a JSON file that was read", "", error.what(), "content as incise writes it").what());
  } catch (const std::bad_alloc&) {
    say("incise: out of memory\n");
    return kBadData;
  } catch (const std::exception& error) {
    return ended(kOwnFault, fmt::format("internal error: {}", error.what()));
  }
}
