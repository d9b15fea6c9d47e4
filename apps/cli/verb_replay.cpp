#include "option_checks.hpp"
#include "options.hpp"
#include "replay_files.hpp"

#include <incise/core/described_json.hpp>
#include <incise/core/isa.hpp>
#include <incise/core/version.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/path_io.hpp>
#include <incise/robot/program_audit.hpp>
#include <incise/storage/run_files.hpp>

#include <fmt/format.h>

namespace incise::cli {
namespace {

struct ReplayArguments {
  std::filesystem::path program, path;
  double slider_percent = 100.0;
  double max_deviation_mm = PlayerSettings{}.max_deviation_mm;
};

void write_folder(const ReplayArguments& arguments, const CommonOptions& options, const Replay& replay,
                  const nlohmann::ordered_json& result) {
  require_replaceable(options.output);
  AtomicFolder target(options.output);
  write_true_path(target.path(), replay);
  write_replay_figure(target.path(), replay);
  write_json(target.path() / "replay.json", result);
  const nlohmann::ordered_json settings{{"speed_slider_percent", arguments.slider_percent},
                                        {"max_deviation_mm", arguments.max_deviation_mm}};
  write_manifest(target.path(),
                 laboratory::manifest_of(options.context(), settings.dump(), {arguments.program, arguments.path},
                                         result.at("wall_s").get<double>()));
  target.commit();
}

Replay played(const WrittenProgram& program, const PlayerSettings& settings, const std::optional<ToolPath>& intended,
              const std::filesystem::path& path) {
  if (!intended) return play(program, ur10e(), settings);
  try {
    return play(program, ur10e(), settings, &*intended);
  } catch (const InvalidArgument& error) {
    throw DataError(path, "waypoints", error);
  }
}

/// How it ended, where that is not well.
std::string warning_of(const Replay& replay, const std::filesystem::path& program) {
  const bool is_stopped = replay.outcome == ReplayOutcome::Unreachable || replay.outcome == ReplayOutcome::Jump ||
                          replay.outcome == ReplayOutcome::BlendsOverlap ||
                          replay.outcome == ReplayOutcome::JointLimits || replay.outcome == ReplayOutcome::TooLong;
  return fmt::format("{}{}: {}{}{}", program.string(), replay.line > 0 ? fmt::format(":{}", replay.line) : "",
                     is_stopped ? "the arm cannot go on: " : "", to_string(replay.outcome),
                     replay.reason.empty() ? "" : fmt::format(": {}", replay.reason));
}

int run_replay(const ReplayArguments& arguments, const CommonOptions& options) {
  Console console(options.level());
  refuse_input_as_output("-o", options.output, {arguments.program, arguments.path});
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
  const PlayerSettings settings{.speed_slider = arguments.slider_percent / 100.0,
                                .max_deviation_mm = arguments.max_deviation_mm};
  Replay replay = played(program, settings, intended, arguments.path);
  const ProgramAudit audit = audit_program(program);
  judge_audit(replay, audit);
  if (audit.digest == ProgramDigest::Absent)
    console.message(
        Severity::Warning,
        "not checked: the program has no digest, so it may not be the one that was checked");
  nlohmann::ordered_json result = to_json(replay);
  result["program_audit"] = audit_json(audit, program.header);
  result["model"] = "incise's own kinematics and interpolation; not the maker's controller";
  result["wall_s"] = options.wall_s();
  if (!options.output.empty()) write_folder(arguments, options, replay, result);
  if (replay.outcome != ReplayOutcome::Completed) {
    console.message(Severity::Warning, warning_of(replay, arguments.program));
  }
  print_result(options, result);
  return replay.outcome == ReplayOutcome::Completed ? kDone : kNotAcceptable;
}

}  // namespace

void add_replay(Application& application) {
  auto [verb, a] = application.add_verb<ReplayArguments>(
      "replay",
      "Play a program: what the tip of the tool would do. Exit status 4 when it cannot be run, or leaves its path",
      "incise replay cut.script --speed-slider 50 -o replay", run_replay);
  verb->add_option("program", a.program, "A program that `incise export` wrote: URScript, .csv or .json")->required();
  verb->add_option("--speed-slider", a.slider_percent, "Setting of the controller's speed slider, percent")
      ->check(CLI::Range(1.0, 100.0));
  verb->add_option("--max-deviation-mm", a.max_deviation_mm,
                   "Greatest allowed deviation of the tip from the path in the cut; beyond it the exit status is 4")
      ->check(above_zero("--max-deviation-mm"));
  verb->add_option("--path", a.path,
                   "path.json, frame robot, to compare the tip with; by default the one in the program");
}

}  // namespace incise::cli
