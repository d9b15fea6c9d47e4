#pragma once

#include "console.hpp"

#include <incise/core/error.hpp>
#include <incise/steps/step.hpp>
#include <incise/storage/case_run.hpp>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace incise::cli {

// Exit statuses of the command.
inline constexpr int kDone = 0;
inline constexpr int kOwnFault = 1;
inline constexpr int kBadCase = 2;
inline constexpr int kBadData = 3;
inline constexpr int kNotAcceptable = 4;
inline constexpr int kInterrupted = 130;

/// Whether a path is a folder, or lies anywhere within it. Links are followed; neither has to exist.
[[nodiscard]] bool is_same_or_within(const std::filesystem::path& inner, const std::filesystem::path& outer);

/// Refuses (status 2) an output that is an input, that is a folder with an input in it (its whole content would be
/// replaced), or that lies in a folder that is an input. Empty names are skipped.
void refuse_input_as_output(const std::string& option, const std::filesystem::path& output,
                            const std::vector<std::filesystem::path>& inputs);

/// Refuses (status 2) two outputs of the same name: the second would replace the first. Empty names are skipped.
void refuse_same_output(const std::string& option, const std::filesystem::path& output, const std::string& other_option,
                        const std::filesystem::path& other);

/// Options of every verb.
struct CommonOptions {
  std::filesystem::path output;
  bool json = false;
  bool quiet = false;
  bool verbose = false;
  int threads = 0;
  std::uint64_t seed = 1;
  std::string isa;
  std::string command_line;
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();

  [[nodiscard]] Console::Level level() const {
    return quiet ? Console::Level::Quiet : verbose ? Console::Level::Verbose : Console::Level::Normal;
  }
  [[nodiscard]] RunContext context() const;
  /// Returns the output. @throws CaseError if none was given. @param example  for the message.
  [[nodiscard]] std::filesystem::path required_output(const char* example) const;
};

/// Watches over an output of an earlier run. If this run writes none, a message says so at its end, however it ends, so
/// nobody takes the old output for the new one.
class OlderOutput {
 public:
  OlderOutput(std::filesystem::path output, Console& console);
  ~OlderOutput();
  OlderOutput(const OlderOutput&) = delete;
  OlderOutput& operator=(const OlderOutput&) = delete;
  /// The output has been written.
  void replaced() { is_there_ = false; }
  /// Returns its name, or null if there is none: the key `stale_output` of a refusal.
  [[nodiscard]] nlohmann::ordered_json json() const;

 private:
  std::filesystem::path output_;
  Console& console_;
  bool is_there_ = false;
};

/// Adds verbs to the application, each with a function that does its work and returns the exit status.
class Application {
 public:
  Application(CLI::App& app, std::string command_line) : app_(app), command_line_(std::move(command_line)) {}

  /// @param what  shown in --help if the line in the list of verbs (verb_list.cpp) does not say all; else "".
  /// @param example  shown at the end of --help.
  /// @param run  takes the verb's own options, then the common ones.
  /// @param group  of verbs to add it to (add_group); null: the command itself.
  template <typename Arguments, typename Run>
  std::pair<CLI::App*, Arguments&> add_verb(const std::string& name, const std::string& what,
                                            const std::string& example, Run run, CLI::App* group = nullptr) {
    auto arguments = std::make_shared<Arguments>();
    const auto run_with = [=](const CommonOptions& options) { return run(*arguments, options); };
    return {add_verb_to(group != nullptr ? *group : app_, name, what, example, run_with), *arguments};
  }
  /// Adds a verb of several words: `group` holds the verbs that follow it, of which one must be given.
  CLI::App* add_group(const std::string& group, const std::string& what, const std::string& example);
  [[nodiscard]] int status() const { return status_; }

 private:
  CLI::App* add_verb_to(CLI::App& group, const std::string& name, const std::string& what, const std::string& example,
                        std::function<int(const CommonOptions&)> run);

  CLI::App& app_;
  std::string command_line_;
  int status_ = kDone;
};

/// Says in a verb's help what happens without -o. Unless a verb says so, -o is required (required_output).
void describe_output(CLI::App& verb, const std::string& without);
inline constexpr const char* kNothingByDefault = "by default nothing is written";

/// Prints the result: with --json the one object on standard output, else a short table.
void print_result(const CommonOptions& options, const nlohmann::ordered_json& result);
/// Runs a step of the library with the command's console and threads, and prints its result.
/// @param print  another summary than print_result's for a person. @returns the exit status.
int run_step(const CommonOptions& options, const std::function<steps::StepResult(const steps::StepContext&)>& step,
             const std::function<void(const nlohmann::ordered_json&)>& print = {});
/// Prints the result of `simulate` for a person: the main measures of the cut, its verdict and its folder.
void print_cut(const nlohmann::ordered_json& result);
/// Prints a whole loop for a person: the main measures of the two cuts side by side.
void print_study(const nlohmann::ordered_json& result);

void add_forecast(Application& application);
void add_assess(Application& application);
void add_bench(Application& application);  ///< bench make, bench cut, bench floor, and those of add_bench_series
void add_bench_series(Application& application, CLI::App* bench);  ///< bench accept, bench factors, bench pool
void add_calibrate(Application& application);
void add_demo(Application& application);
void add_run(Application& application);
void add_phantom(Application& application);
void add_segment(Application& application);
void add_mesh(Application& application);
void add_stages(Application& application);  ///< deform, plan, simulate
void add_compensate(Application& application);
void add_surface(Application& application);
void add_register(Application& application);
void add_track(Application& application);
void add_power(Application& application);  ///< lowest power that fits, on the virtual bench
void add_project(Application& application);
void add_export(Application& application);
void add_replay(Application& application);
void add_interchange(Application& application);
void add_evaluate(Application& application);
void add_compare(Application& application);
void add_audit(Application& application);
void add_report(Application& application);
void add_verify(Application& application);
void add_schema(Application& application);
void add_studio(Application& application);
void add_experiment(Application& application);

}  // namespace incise::cli
