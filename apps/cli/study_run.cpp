#include "study_run.hpp"

#include "compensation_figures.hpp"
#include "own_files.hpp"
#include "replay_files.hpp"
#include "study_report.hpp"
#include "verdict_gate.hpp"

#include <incise/core/error.hpp>
#include <incise/core/problem_text.hpp>
#include <incise/core/version.hpp>
#include <incise/cutting/path_heat.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/described_json.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/robot/program_text.hpp>
#include <incise/storage/result_json.hpp>
#include <incise/workflow/robot_frame.hpp>

#include <fmt/format.h>

#include <chrono>
#include <ostream>

namespace incise::cli {
namespace {

constexpr int kMostFrames = 500;               // as in the case file
constexpr double kLongestCheckpointS = 86400;  // a day

/// Takes an output folder once the case is known to be sound, and refuses one whose own names belong to something else.
CaseFile with_folder_locked(CaseFile file, const std::filesystem::path& output, std::optional<FolderLock>& lock) {
  require_own_files(output);
  lock.emplace(output);
  return file;
}

}  // namespace

std::filesystem::path output_of(const std::filesystem::path& case_path, const CommonOptions& options) {
  if (!options.output.empty()) return options.output;
  return (std::filesystem::is_directory(case_path) ? case_path : case_path.parent_path()) / "out";
}

CaseFile case_with_inputs(const std::filesystem::path& case_path) {
  CaseFile file = read_case(case_path);
  require_input_files(file);
  return file;
}

void add_cut_options(CLI::App& verb, CutOptions& options) {
  verb.add_option("--frames", options.frames, "Moments of the cut to keep for pictures, in place of the case's cut.frames")
      ->check(CLI::Range(1, kMostFrames));
  verb.add_flag("--resume", options.must_resume,
                "Go on from the checkpoint of an interrupted cut, or refuse. Without it the cut goes on, too, where there is one that fits");
  verb.add_option("--checkpoint-s", options.checkpoint_s, "Seconds between two checkpoints of a cut; Ctrl-C always writes one")
      ->check(CLI::Range(0.0, kLongestCheckpointS));
}

CaseFile case_as_asked(const std::filesystem::path& case_path, const CutOptions& cut) {
  CaseFile file = case_with_inputs(case_path);
  if (cut.frames) file.settings.frames = *cut.frames;
  if (cut.method) file.settings.compensation.method = *cut.method;
  return file;
}

StudyRun::StudyRun(const std::filesystem::path& case_path, const std::filesystem::path& output, Stage until,
                   const CommonOptions& options, const CutOptions& cut)
    : is_new_folder(!std::filesystem::exists(output)),
      folder(with_folder_locked(case_as_asked(case_path, cut), output, lock_), output, options.context()),
      options_{until, cut.must_resume, cut.checkpoint_s} {
  // Kept apart from the products: which case they are of, for `incise report`.
  const auto relative =
      std::filesystem::absolute(folder.case_file().file).lexically_proximate(std::filesystem::absolute(output));
  const std::filesystem::path record = output / "study.json";
  if (std::filesystem::exists(record)) {
    const nlohmann::ordered_json older = read_json(record);
    if (older.is_object() && older.contains("case_file") && older.at("case_file") == relative.string()) return;
  }
  write_json(record, {{"case_file", relative.string()}});
}

namespace {

ArmSetup arm_setup_of(const Case& settings) {
  ArmSetup setup;
  if (settings.T_flange_tool) setup.T_flange_tool = *settings.T_flange_tool;
  return setup;
}

/// What a case that asks for a program has to hold, told before anything long has run.
void require_a_place_for_the_arm(const Case& settings) {
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

}  // namespace

Study StudyRun::run(const CommonOptions& options, Monitor& monitor) {
  Workers workers(options.threads);
  const CaseFile& file = folder.case_file();
  try {
    if (options_.until >= Stage::Plan || file.inputs.specimen_mesh.empty()) require_plan_inputs(file);
    if (options_.until >= Stage::Verify) require_a_place_for_the_arm(file.settings);
    folder.remove_what_is_out_of_date(monitor);
    return run_study(file.settings, folder, folder.cache(), options_, workers, monitor, folder);
  } catch (const CaseError& error) {
    remove_if_nothing_was_made();
    throw error.in_file(file.file.string());
  } catch (const CutInterrupted& error) {
    throw StagesKept(error.what(),
                     fmt::format("its checkpoint {} is kept", folder.cache().place_of(error.slot()).string()));
  } catch (const Cancelled& error) {
    remove_if_nothing_was_made();
    if (folder.has_products()) throw StagesKept(error.what());
    throw;
  } catch (...) {
    remove_if_nothing_was_made();
    throw;
  }
}

void StudyRun::remove_if_nothing_was_made() const {
  std::error_code ignored;
  if (!is_new_folder) return;
  for (const auto& entry : std::filesystem::directory_iterator(folder.root(), ignored)) {
    if (entry.path().filename() != "study.json") return;
  }
  std::filesystem::remove(folder.root() / "study.json", ignored);
  std::filesystem::remove(folder.root(), ignored);
}

namespace {

void warn_of_looser_limits(const Case& settings, Monitor& monitor) {
  const double usual_mm = CheckSettings{}.close_margin_mm;
  if (!settings.T_robot_sim || settings.close_margin_mm >= usual_mm) return;
  monitor.message(Severity::Warning, fmt::format("a looser check: plan.close_margin_mm is {:g} mm, by default {:g} mm",
                                                 settings.close_margin_mm, usual_mm));
}

/// What keeps a case from having a program at all; empty: nothing.
std::string without_program(const Case& settings) {
  if (!settings.T_robot_sim) return "robot.T_robot_sim is not given";
  if (half_width_mm(settings.tool) > 0.0) return fmt::format("a program does not turn a {} into its direction of travel", kind_of(settings.tool));
  return {};
}

/// A program for the path that the verdict is about, and what its checks found.
struct CheckedProgram {
  ToolPath path;
  RobotProgram program;
  ProgramChecks checks;
};

/// Speeds and places of a given path come from a person.
RobotProgram program_of(const CaseFile& file, const ToolPath& path, const ProgramSettings& motion) {
  try {
    return make_program(path, motion, arm_setup_of(file.settings));
  } catch (const InvalidArgument& error) {
    const std::filesystem::path& of = file.inputs.tool_path.empty() ? file.file : file.inputs.tool_path;
    throw fault_of_file(of, "waypoints", error, "a path that a tool can follow");
  }
}

CheckedProgram checked_program(const CaseFile& file, const Study& done) {
  const Case& settings = file.settings;
  CheckedProgram made;
  made.path = in_robot_frame(done.is_accepted ? done.correction->moves.path : *done.followed, *settings.T_robot_sim);
  const ToolPath intended = in_robot_frame(*done.plan, *settings.T_robot_sim);
  ProgramSettings motion;
  motion.overlap_mm = settings.cut.overlap_mm;
  made.program = program_of(file, made.path, motion);
  CheckSettings limits;
  limits.must_be_ring = settings.plan.kind == PlanKind::Ring;
  limits.planned_depth_mm = settings.plan.depth_mm;
  limits.close_margin_mm = settings.close_margin_mm;
  CheckInputs inputs;
  inputs.intended = &intended;
  inputs.power_w = settings.plan.power_w;
  inputs.heat_half_width_mm = widest_heat(settings.thermal, settings.plan.power_w, made.path, settings.tool).half_width_mm;
  made.checks = check_program(made.program, made.path, limits, inputs);
  return made;
}

void write_program_files(StudyRun& study, const CheckedProgram& made, const Verdict& verdict, const VerdictGate& gate,
                         nlohmann::ordered_json& json) {
  const Case& settings = study.folder.case_file().settings;
  ProgramHeader provenance{{"made_by", fmt::format("incise {} ({})", version(), source_commit())}, {"title", settings.title}};
  provenance.emplace_back("specimen_id", study.folder.specimen_id());
  if (settings.is_virtual) provenance.emplace_back("specimen", kVirtualSpecimen);
  for (const auto& line : verdict_header(verdict, gate)) provenance.push_back(line);
  const ProgramHeader header = program_header(made.program, made.path, made.checks, provenance);
  AtomicFolder target(study.folder.root() / "program");
  ToolPath path = made.path;
  path.specimen_id = study.folder.specimen_id();
  path.is_virtual = settings.is_virtual;
  write_tool_path(target.path() / "path.json", path, verdict);
  const std::string script = to_urscript(made.program, header);
  write_atomically(target.path() / "program.json", [&](std::ostream& out) { out << to_json(made.program, &made.checks, header); });
  write_atomically(target.path() / "program.script", [&](std::ostream& out) { out << script; });
  const PlayerSettings player;
  const Replay replay = incise::play(program_from_text(script, "program.script"), made.program.setup.arm, player);
  write_replay(target.path(), replay);
  json["replay"] = to_json(replay, player);
  study.folder.write_manifest_to(target.path(), 0.0, &verdict);
  target.commit();
}

/// The program for the path whose cut the verdict is about, if the checks and the verdict let it pass. Failed checks join the verdict.
nlohmann::ordered_json write_program(StudyRun& study, const Study& done, const std::vector<std::string>& accepted, Verdict& verdict,
                                     Monitor& monitor) {
  const Case& settings = study.folder.case_file().settings;
  const std::filesystem::path folder = study.folder.root() / "program";
  remove_replaceable(folder);
  nlohmann::ordered_json json;
  if (const std::string reason = without_program(settings); !reason.empty()) {
    monitor.message(Severity::Warning, "no program: " + reason);
    json["written"] = false;
    json["reason"] = reason;
    return json;
  }
  if (!done.followed) {
    json["written"] = false;
    json["reason"] = "nothing was cut";
    return json;
  }
  const CheckedProgram made = checked_program(study.folder.case_file(), done);
  add_failed_checks(made.checks, verdict);
  const VerdictGate gate = gate_of(verdict, accepted);
  report_gate(verdict, gate, monitor);
  json = nlohmann::ordered_json::parse(to_json(made.program, &made.checks));
  json.erase("poses");
  json["motion"].erase("samples");
  json["follows"] = done.is_accepted ? "corrected path" : "uncorrected path";
  json["gate"] = to_json(gate);
  json["written"] = gate.is_open;
  if (gate.is_open) write_program_files(study, made, verdict, gate, json);
  return json;
}

nlohmann::ordered_json headline(const nlohmann::ordered_json& cut) {
  nlohmann::ordered_json json = cut;
  for (const char* key : {"removals", "removal_columns", "removal_causes"}) json.erase(key);
  return json;
}

}  // namespace

int status_of(const Study& study) {
  return study.verdict.status() == VerdictStatus::Refused && study.outcome != Outcome::Cancelled ? kNotAcceptable : status_of(study.outcome);
}

int run_whole_loop(StudyRun& study, const CommonOptions& options, const std::vector<std::string>& accepted, Monitor& monitor,
                   nlohmann::ordered_json& result) {
  const auto start = std::chrono::steady_clock::now();
  warn_of_looser_limits(study.folder.case_file().settings, monitor);
  Study done = study.run(options, monitor);
  const std::filesystem::path root = study.folder.root();
  const Case& settings = study.folder.case_file().settings;
  study.folder.add_advice_to(done.verdict, done.is_accepted);
  result["stages"] = to_json(done.stages);
  result["verdict"] = nullptr;  // once the program's checks have joined it
  result["outcome"] = to_string(done.outcome);
  result["before"] = done.as_planned ? headline(to_json(*done.as_planned)) : nlohmann::ordered_json(nullptr);
  result["after"] = done.corrected ? headline(to_json(*done.corrected)) : nlohmann::ordered_json(nullptr);
  result["accepted"] = done.is_accepted;
  result["correction"] = done.correction ? correction_summary_json(*done.correction) : nlohmann::ordered_json(nullptr);
  result["specimen_is"] = settings.is_virtual ? "virtual" : "real";
  result["specimen_id"] = study.folder.specimen_id();
  bool has_program = true;
  if (done.plan) {
    result["program"] = write_program(study, done, accepted, done.verdict, monitor);
    has_program = !settings.T_robot_sim || result["program"]["written"].get<bool>();
  }
  result["verdict"] = to_json(done.verdict);
  const auto elapsed = [&start] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  result["wall_s"] = elapsed();
  nlohmann::ordered_json record = result;
  record["case_file"] = read_json(root / "study.json").at("case_file");
  write_json(root / "study.json", record);
  study.folder.write_manifest_to(root, elapsed(), &done.verdict);
  monitor.message(Severity::Notice, "report: drawing");
  try {
    write_report_and_figures(study_report(root, monitor), root / "report.html");
    write_compensation_figures(root, root / "figures");
  } catch (const Cancelled& error) {
    throw StagesKept(error.what());
  }
  result["report"] = (root / "report.html").string();
  result["wall_s"] = elapsed();
  return has_program ? status_of(done) : kNotAcceptable;
}

}  // namespace incise::cli
