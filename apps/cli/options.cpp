#include "options.hpp"

#include "option_checks.hpp"
#include "verb_list.hpp"

#include <incise/core/error.hpp>
#include <incise/core/isa.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <thread>

namespace incise::cli {
namespace {

constexpr std::uint64_t kGreatestSeed = 1'000'000'000'000'000;  // a run counts on from it; exact in JSON

void choose_isa(const std::string& name) {
  const Isa isa = value_named<Isa>(name);
  if (!is_supported(isa)) {
    throw CaseError("command line", "--isa", name,
                    fmt::format("an instruction set that this machine has: at best {}", to_string(best_isa())));
  }
  set_isa(isa);
}

}  // namespace

RunContext CommonOptions::context() const {
  const int all = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  return {command_line, seed, threads > 0 ? threads : all};
}

void refuse_input_as_output(const std::string& option, const std::filesystem::path& output,
                            const std::vector<std::filesystem::path>& inputs) {
  for (const std::filesystem::path& input : inputs) {
    std::error_code absent;
    if (output.empty() || input.empty() || !std::filesystem::exists(input, absent)) continue;
    const auto refuse = [&](const std::string& what, const char* expected) {
      throw CaseError("command line", option, output.string() + what, expected);
    };
    if (std::filesystem::equivalent(input, output, absent))
      refuse(", which is an input", "another file: the input would be lost");
    if (is_same_or_within(input, output))
      refuse(fmt::format(", which holds the input {}", input.string()), "another place: the input would be lost");
    if (std::filesystem::is_directory(input, absent) && is_same_or_within(output, input))
      refuse(fmt::format(", which is inside the input {}", input.string()),
             "another place: the input would be changed");
  }
}

bool is_same_or_within(const std::filesystem::path& inner, const std::filesystem::path& outer) {
  // For a name that does not exist yet, only an absolute path is resolved. "a/", "a/." and "a" are the same.
  const auto plain = [](const std::filesystem::path& path) {
    const auto resolved = std::filesystem::weakly_canonical(std::filesystem::absolute(path));
    return (resolved.lexically_normal() / "").parent_path();
  };
  const auto a = plain(inner), b = plain(outer);
  return std::mismatch(b.begin(), b.end(), a.begin(), a.end()).first == b.end();
}

void refuse_same_output(const std::string& option, const std::filesystem::path& output, const std::string& other_option,
                        const std::filesystem::path& other) {
  if (output.empty() || other.empty()) return;
  if (!is_same_or_within(output, other) && !is_same_or_within(other, output)) return;
  throw CaseError("command line", other_option, other.string(),
                  fmt::format("a file other than {} {}: one output would replace the other", option, output.string()));
}

OlderOutput::OlderOutput(std::filesystem::path output, Console& console)
    : output_(std::move(output)), console_(console) {
  std::error_code absent;
  // A device or a pipe does not belong to a run.
  is_there_ = std::filesystem::is_regular_file(output_, absent) || std::filesystem::is_directory(output_, absent);
}

OlderOutput::~OlderOutput() {
  if (!is_there_) return;
  try {
    console_.message(Severity::Warning, fmt::format("{} is from an earlier run and was not changed", output_.string()));
  } catch (...) {  // a message that cannot be shown does not end the program
  }
}

nlohmann::ordered_json OlderOutput::json() const {
  return is_there_ ? nlohmann::ordered_json(output_.string()) : nlohmann::ordered_json(nullptr);
}

std::filesystem::path CommonOptions::required_output(const char* example) const {
  if (output.empty())
    throw CaseError("command line", "-o", "nothing", "where to write", fmt::format("For example: -o {}", example));
  return output;
}

CLI::App* Application::add_group(const std::string& group, const std::string& what, const std::string& example) {
  CLI::App* verbs = app_.add_subcommand(group, what);
  verbs->require_subcommand(1);
  verbs->footer("\nExample:\n  " + example + "\n");
  return verbs;
}

CLI::App* Application::add_verb_to(CLI::App& group, const std::string& name, const std::string& what,
                                   const std::string& example, std::function<int(const CommonOptions&)> run) {
  auto options = std::make_shared<CommonOptions>();
  options->command_line = command_line_;
  CLI::App* verb = group.add_subcommand(name, what.empty() ? line_of(name) : what);
  verb->footer("\nExample:\n  " + example + "\n");
  const CLI::Option* given = verb->add_option("-o,--output", options->output, "File or folder to write (required)");
  verb->add_flag("--json", options->json, "Print one JSON object on standard output");
  verb->add_flag("--quiet", options->quiet, "Print warnings only");
  verb->add_flag("--verbose", options->verbose, "Print more detail");
  verb->add_option("--threads", options->threads, "Threads to use; 0: all")->check(whole_between("--threads", 0, 1024));
  verb->add_option("--seed", options->seed, "Seed of all random numbers")
      ->check(whole_between("--seed", 0, kGreatestSeed));
  verb->add_option("--isa", options->isa,
                   "Instruction set of the vectorised kernels; by default the best that this machine has")
      ->check(name_of_any<Isa>());
  verb->callback([this, options, given, run = std::move(run)] {
    if (!options->isa.empty()) choose_isa(options->isa);
    if (given->count() > 0 && options->output.empty())
      throw CaseError("command line", "-o", "an empty name", "the file or folder to write");
    status_ = run(*options);
  });
  return verb;
}

void describe_output(CLI::App& verb, const std::string& without) {
  verb.get_option("--output")->description("File or folder to write; " + without);
}

int run_step(const CommonOptions& options, const std::function<steps::StepResult(const steps::StepContext&)>& step,
             const std::function<void(const nlohmann::ordered_json&)>& print) {
  Console console(options.level());
  Workers workers(options.threads);
  const steps::StepResult found = step({options.context(), workers, console, options.start});
  if (!found.json.is_null()) options.json || !print ? print_result(options, found.json) : print(found.json);
  return found.is_acceptable ? kDone : kNotAcceptable;
}

}  // namespace incise::cli
