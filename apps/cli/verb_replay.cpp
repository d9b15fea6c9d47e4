#include "options.hpp"
#include "replay_files.hpp"

#include <incise/core/isa.hpp>
#include <incise/core/version.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/path_io.hpp>

#include <fmt/format.h>

#include <chrono>
#include <memory>

namespace incise::cli {
namespace {

struct Arguments {
  std::filesystem::path program, path;
  double slider_percent = 100.0;
};

void write_folder(const Arguments& arguments, const CommonOptions& options, const Replay& replay,
                  const nlohmann::ordered_json& result) {
  require_replaceable(options.output);
  AtomicFolder target(options.output);
  write_replay(target.path(), replay);
  write_json(target.path() / "replay.json", result);
  const RunContext context = options.context();
  Manifest manifest;
  manifest.version = version();
  manifest.commit = source_commit();
  manifest.command = context.command;
  manifest.settings_json = nlohmann::ordered_json{{"speed_slider_percent", arguments.slider_percent}}.dump();
  manifest.seed = context.seed;
  manifest.threads = context.threads;
  manifest.instruction_set = to_string(active_isa());
  manifest.inputs.push_back({arguments.program.string(), sha256_of_file(arguments.program)});
  if (!arguments.path.empty()) manifest.inputs.push_back({arguments.path.string(), sha256_of_file(arguments.path)});
  manifest.wall_s = result.at("wall_s").get<double>();
  manifest.machine = machine_description();
  write_manifest(target.path(), manifest);
  target.commit();
}

int run_replay(const Arguments& arguments, const CommonOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Console console(options.level());
  if (!options.output.empty()) require_replaceable(options.output);
  const WrittenProgram program = program_from_text(read_text(arguments.program), arguments.program);
  std::optional<ToolPath> intended;
  if (!arguments.path.empty()) {
    intended = read_tool_path(arguments.path);
    require_robot_frame(*intended, arguments.path);
  } else if (!program.path) {
    console.message(Severity::Warning,
                    "the program does not say which path it was made for: no deviations (give --path)");
  }
  const PlayerSettings settings{.speed_slider = arguments.slider_percent / 100.0};
  const Replay replay = play(program, ur10e(), settings, intended ? &*intended : nullptr);
  nlohmann::ordered_json result = to_json(replay, settings);
  result["model"] = "incise's own kinematics and interpolation; not the maker's controller";
  result["wall_s"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!options.output.empty()) write_folder(arguments, options, replay, result);
  if (replay.outcome != ReplayOutcome::Completed) {
    console.message(Severity::Warning, fmt::format("{}:{}: the arm cannot go on: {}", arguments.program.string(),
                                                   replay.line, to_string(replay.outcome)));
  }
  print_result(options, result);
  return replay.outcome == ReplayOutcome::Completed ? kDone : kNotAcceptable;
}

}  // namespace

void add_replay(Application& application) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb =
      application.add_verb("replay", "Play a program: what the tip of the tool would do",
                           "incise replay cut.script --speed-slider 50 -o replay",
                           [arguments](const CommonOptions& options) { return run_replay(*arguments, options); });
  verb->add_option("program", arguments->program, "A program that `incise export` wrote: URScript, .csv or .json")
      ->required();
  verb->add_option("--speed-slider", arguments->slider_percent, "Where the controller's speed slider stands, percent")
      ->check(CLI::Range(1.0, 100.0));
  verb->add_option("--path", arguments->path,
                   "path.json, frame robot, to hold the tip against; by default the one in the program");
}

}  // namespace incise::cli
