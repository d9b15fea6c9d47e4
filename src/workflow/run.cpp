#include <incise/core/version.hpp>
#include <incise/cutting/path_heat.hpp>
#include <incise/robot/program_verdict.hpp>
#include <incise/workflow/robot_frame.hpp>
#include <incise/workflow/run.hpp>

#include <fmt/format.h>

namespace incise {
namespace {

ArmSetup arm_setup_of(const Case& settings) {
  ArmSetup setup;
  take_arm(settings, setup);
  return setup;
}

void warn_of_looser_limits(const Case& settings, Monitor& monitor) {
  const double usual_mm = CheckSettings{}.close_margin_mm;
  if (!settings.T_robot_sim || settings.close_margin_mm >= usual_mm) return;
  monitor.message(Severity::Warning, fmt::format("a looser check: plan.close_margin_mm is {:g} mm, by default {:g} mm",
                                                 settings.close_margin_mm, usual_mm));
}

/// Returns why a case cannot have a program at all; empty: it can.
std::string without_program(const Case& settings) {
  if (!settings.T_robot_sim) return "robot.T_robot_sim is not given";
  if (half_width_mm(settings.tool) > 0.0) {
    return fmt::format("a program does not turn a {} into its direction of travel", kind_of(settings.tool));
  }
  return {};
}

/// Makes the program. Speeds and places of a given path come from a person, so the path may be unsuitable.
RobotProgram program_along(const ToolPath& path, const Case& settings, const Inputs& inputs) {
  try {
    return make_program(path, {.overlap_mm = settings.cut.overlap_mm}, arm_setup_of(settings));
  } catch (const InvalidArgument& error) {
    throw DataError(inputs.path_name(), "waypoints", error);
  }
}

CheckedProgram checked_program(const Case& settings, Inputs& inputs, const Study& study) {
  CheckedProgram made;
  const ToolPath& chosen = study.is_accepted ? study.correction->moves.path : *study.followed;
  made.path = in_robot_frame(chosen, *settings.T_robot_sim);
  const ToolPath intended = in_robot_frame(*study.plan, *settings.T_robot_sim);
  made.program = program_along(made.path, settings, inputs);
  CheckInputs known;
  known.intended = &intended;
  known.power_w = settings.plan.power_w;
  known.heat_half_width_mm =
      widest_heat(settings.thermal, settings.plan.power_w, made.path, settings.tool).half_width_mm;
  CheckSettings limits;
  take_limits(settings, limits);
  made.checks = check_program(made.program, made.path, limits, known);
  return made;
}

ProgramHeader header_of(const CheckedProgram& made, const Case& settings, const std::string& specimen_id,
                        const Run& run) {
  ProgramHeader provenance{{"made_by", fmt::format("incise {} ({})", version(), source_commit())},
                           {"title", settings.title},
                           {"specimen_id", specimen_id}};
  if (settings.is_virtual) provenance.emplace_back("specimen", kVirtualSpecimen);
  for (const auto& line : verdict_header(run.verdict, run.gate)) provenance.push_back(line);
  return program_header(made.program, made.path, made.checks, provenance);
}

void add_program(const Case& settings, Inputs& inputs, std::span<const std::string> accepted, Monitor& monitor,
                 Run& run) {
  if (!run.study.plan) {
    run.why_without_program = "nothing was planned";
    return;
  }
  run.why_without_program = without_program(settings);
  if (!run.why_without_program.empty()) {
    monitor.message(Severity::Warning, "no program: " + run.why_without_program);
    return;
  }
  if (!run.study.followed) {
    run.why_without_program = "nothing was cut";
    return;
  }
  CheckedProgram& made = run.program.emplace(checked_program(settings, inputs, run.study));
  add_failed_checks(made.checks, run.verdict);
  run.gate = gate_of(run.verdict, accepted);
  const std::string specimen_id = inputs.specimen_id();
  made.header = header_of(made, settings, specimen_id, run);
  made.path.specimen_id = specimen_id;
  made.path.is_virtual = settings.is_virtual;
  if (!run.gate.is_open) return;
  const WrittenProgram script = program_from_text(to_urscript(made.program, made.header), "program.script");
  made.replay = play(script, made.program.setup.arm);
  add_failed_replay(*made.replay, run.verdict);
  run.gate = gate_of(run.verdict, accepted);
  made.header = header_of(made, settings, specimen_id, run);
}

}  // namespace

void take_arm(const Case& settings, ArmSetup& setup) {
  if (settings.T_flange_tool) setup.T_flange_tool = *settings.T_flange_tool;
}

void take_limits(const Case& settings, CheckSettings& limits) {
  limits.must_be_ring = settings.plan.kind == PlanKind::Ring;
  limits.planned_depth_mm = settings.plan.depth_mm;
  limits.close_margin_mm = settings.close_margin_mm;
}

void require_round_tool(const Case& settings) {
  if (half_width_mm(settings.tool) > 0.0)
    throw CaseError("case", "tool.kind", std::string(kind_of(settings.tool)),
                    "a round tool: a program does not turn another into its direction of travel");
}

void require_place_for_arm(const Case& settings) {
  constexpr double kFarthestMm = 1e4;  // many times an arm's reach
  if (!settings.T_robot_sim) return;
  const Vec3 place = settings.T_robot_sim->topRightCorner<3, 1>();
  if (place.norm() > kFarthestMm) {
    throw CaseError("case", "robot.T_robot_sim", fmt::format("a place {:.4g} mm from the arm's base", place.norm()),
                    fmt::format("at most {} mm", kFarthestMm), "Lengths are in mm");
  }
  const double length_mm = arm_setup_of(settings).T_flange_tool.topRightCorner<3, 1>().norm();
  const double needle_mm = CheckSettings{}.needle_length_mm;
  if (length_mm < needle_mm || length_mm > kFarthestMm) {
    throw CaseError("case", "robot.T_flange_tool", fmt::format("a tip {:.4g} mm from the flange", length_mm),
                    fmt::format("at least the needle's length of {} mm, at most {} mm", needle_mm, kFarthestMm),
                    "Lengths are in mm");
  }
}

Run run(const Case& settings, Inputs& inputs, Cache& cache, const RunOptions& options,
        std::span<const std::string> accepted, Workers& workers, Monitor& monitor, ProductSink& sink) {
  require_place_for_arm(settings);
  warn_of_looser_limits(settings, monitor);
  RunOptions whole = options;
  whole.until = Stage::Verify;
  Run run;
  run.study = run_study(settings, inputs, cache, whole, workers, monitor, sink);
  run.verdict = run.study.verdict;
  run.verdict.add(inputs.advice_against(run.study.is_accepted));
  add_program(settings, inputs, accepted, monitor, run);
  return run;
}

Run run(const Case& settings, Inputs& inputs, Cache& cache, std::span<const std::string> accepted) {
  Workers all(0);
  Monitor quiet;
  ProductSink nobody;
  return run(settings, inputs, cache, RunOptions{}, accepted, all, quiet, nobody);
}

}  // namespace incise
