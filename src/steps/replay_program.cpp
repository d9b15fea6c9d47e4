#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/path_io.hpp>
#include <incise/report/replay_figure.hpp>
#include <incise/robot/program_audit.hpp>
#include <incise/steps/robot_steps.hpp>
#include <incise/storage/run_files.hpp>

#include <fmt/format.h>

namespace incise::steps {
namespace {

/// Copies what the program's own header says about its verdict.
void add_header(const ProgramHeader& header, nlohmann::ordered_json& json) {
  for (const char* key : {"verdict", "reason", "accepted", "override", "not_checked"}) {
    json[key] = nlohmann::ordered_json::array();
    for (const auto& [name, value] : header) {
      if (name == key) json[key].push_back(value);
    }
  }
}

void write_folder(const ReplayRequest& request, const StepContext& context, const Replay& replay,
                  const nlohmann::ordered_json& result) {
  require_replaceable(request.output);
  AtomicFolder target(request.output);
  write_true_path(target.path(), replay);
  write_replay_figure(target.path(), replay);
  write_json(target.path() / "replay.json", result);
  const nlohmann::ordered_json settings{{"speed_slider_percent", request.slider_percent},
                                        {"max_deviation_mm", request.max_deviation_mm}};
  write_manifest(target.path(), manifest_of(context.run, settings.dump(), {request.program, request.path},
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

/// Says how a replay ended that is not acceptable.
std::string warning_of(const Replay& replay, const std::filesystem::path& program) {
  const bool is_stopped = replay.outcome == ReplayOutcome::Unreachable || replay.outcome == ReplayOutcome::Jump ||
                          replay.outcome == ReplayOutcome::BlendsOverlap ||
                          replay.outcome == ReplayOutcome::JointLimits || replay.outcome == ReplayOutcome::TooLong;
  return fmt::format("{}{}: {}{}{}", program.string(), replay.line > 0 ? fmt::format(":{}", replay.line) : "",
                     is_stopped ? "the arm cannot continue: " : "", to_string(replay.outcome),
                     replay.reason.empty() ? "" : fmt::format(": {}", replay.reason));
}

}  // namespace

StepResult replay_program(const ReplayRequest& request, const StepContext& context) {
  if (!request.output.empty()) require_replaceable(request.output);
  const WrittenProgram program = program_from_text(read_text(request.program), request.program);
  std::optional<ToolPath> intended;
  if (!request.path.empty()) {
    intended = read_tool_path(request.path);
    require_robot_frame(*intended, request.path);
  } else if (!program.path) {
    context.monitor.message(Severity::Warning,
                            "the program does not state its path, so deviations are not computed (give --path)");
  }
  const PlayerSettings settings{.speed_slider = request.slider_percent / 100.0,
                                .max_deviation_mm = request.max_deviation_mm};
  Replay replay = played(program, settings, intended, request.path);
  const ProgramAudit audit = audit_program(program);
  judge_audit(replay, audit);
  if (audit.digest == ProgramDigest::Absent) {
    context.monitor.message(Severity::Warning,
                            "not checked: the program has no digest, so it may not be the one that was checked");
  }
  StepResult done{to_json(replay), replay.outcome == ReplayOutcome::Completed};
  nlohmann::ordered_json& result = done.json;
  result["program_audit"] = to_json(audit);
  add_header(program.header, result["program_audit"]);
  result["model"] = "incise's own kinematics and interpolation; not the maker's controller";
  result["wall_s"] = context.wall_s();
  if (!request.output.empty()) write_folder(request, context, replay, result);
  if (!done.is_acceptable) context.monitor.message(Severity::Warning, warning_of(replay, request.program));
  return done;
}

void write_replay_figure(const std::filesystem::path& folder, const Replay& replay) {
  ReplayPicture picture;
  for (const ReplaySample& s : replay.samples) {
    if (!is_cut(s.phase)) continue;
    picture.tip_mm.push_back(s.tip_mm);
    picture.time_s.push_back(s.time_s);
    picture.tip_speed_mm_s.push_back(s.tip_speed_mm_s);
    picture.deviation_mm.push_back(s.deviation_mm);
  }
  if (picture.tip_mm.size() < 2) return;
  // Leaves out the straight ways down and up, which are seen end on.
  if (replay.intended_mm.size() > 2)
    picture.intended_mm.assign(replay.intended_mm.begin() + 1, replay.intended_mm.end() - 1);
  write_atomically(folder / "replay.svg", replay_figure_svg(picture));
}

}  // namespace incise::steps
