#include "study_run.hpp"

#include "compensation_figures.hpp"
#include "replay_files.hpp"
#include "study_report.hpp"

#include <incise/core/error.hpp>
#include <incise/core/version.hpp>
#include <incise/cutting/path_heat.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/path_io.hpp>
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
      store(case_as_asked(case_path, cut), output, options.context(), cut.checkpoint_s),
      until_(until) {
  if (cut.must_resume) require_checkpoint();
  // Kept apart from the products: which case they are of, for `incise report`.
  const auto relative = std::filesystem::absolute(store.case_file().file).lexically_proximate(std::filesystem::absolute(output));
  const std::filesystem::path record = output / "study.json";
  if (std::filesystem::exists(record)) {
    const nlohmann::ordered_json older = read_json(record);
    if (older.is_object() && older.contains("case_file") && older.at("case_file") == relative.string()) return;
  }
  write_json(record, {{"case_file", relative.string()}});
}

CutRole StudyRun::next_cut() {
  if (!store.is_current(Product::AsPlanned) || until_ < Stage::Verify) return CutRole::AsPlanned;
  const bool is_paper = store.case_file().settings.compensation.method == CompensationMethod::Paper;
  if (is_paper || store.is_current(Product::Correction)) return CutRole::Corrected;
  int pass = 1;
  while (pass < kMostPasses && store.is_current(product_of(role_of_pass(pass)))) ++pass;
  return role_of_pass(pass);
}

void StudyRun::require_checkpoint() {
  // The one cut that comes next: a checkpoint of another would leave this one to start from the beginning.
  const bool is_first_made = store.is_current(Product::AsPlanned);
  const CutRole next = next_cut();
  if (std::filesystem::exists(store.checkpoint(next))) {
    store.require_fitting_checkpoint(next);
    return;
  }
  remove_if_nothing_was_made();
  const std::string name = store.checkpoint(next).filename().string();
  if (is_first_made && next == CutRole::AsPlanned) {
    throw CaseError("command line", "--resume", fmt::format("the cut as planned finished in {}", store.root().string()),
                    fmt::format("{}, which an interrupted cut leaves", name), "Without --resume it is read from there");
  }
  throw CaseError("command line", "--resume", fmt::format("no checkpoint {} in {}", name, store.root().string()),
                  fmt::format("what the cut {} leaves when it is interrupted", store.folder(product_of(next)).filename().string()),
                  "Without --resume the cut starts from the beginning");
}

Study StudyRun::run(const CommonOptions& options, Monitor& monitor) {
  Workers workers(options.threads);
  const CaseFile& file = store.case_file();
  try {
    if (until_ >= Stage::Plan || file.inputs.specimen_mesh.empty()) require_plan_inputs(file);
    return run_study(file.settings, store, until_, workers, monitor);
  } catch (const CaseError& error) {
    remove_if_nothing_was_made();
    throw error.in_file(file.file.string());
  } catch (const Cancelled& error) {
    remove_if_nothing_was_made();
    if (!store.last_checkpoint().empty()) {
      throw StagesKept(error.what(), fmt::format("its checkpoint {} is kept", store.last_checkpoint().string()));
    }
    if (has_products()) throw StagesKept(error.what());
    throw;
  } catch (...) {
    remove_if_nothing_was_made();
    throw;
  }
}

bool StudyRun::has_products() const {
  for (int product = 0; product <= static_cast<int>(Product::Corrected); ++product) {
    if (std::filesystem::exists(store.folder(static_cast<Product>(product)))) return true;
  }
  return false;
}

void StudyRun::remove_if_nothing_was_made() const {
  std::error_code ignored;
  if (!is_new_folder) return;
  for (const auto& entry : std::filesystem::directory_iterator(store.root(), ignored)) {
    if (entry.path().filename() != "study.json") return;
  }
  std::filesystem::remove_all(store.root(), ignored);
}

namespace {

ArmSetup arm_setup_of(const Case& settings) {
  ArmSetup setup;
  if (settings.T_flange_tool) setup.T_flange_tool = *settings.T_flange_tool;
  return setup;
}

/// The program for the corrected path (or the planned one, where nothing was corrected), if it passes the checks.
nlohmann::ordered_json write_program(StudyRun& study, const Study& done, Monitor& monitor) {
  const CaseFile& file = study.store.case_file();
  const std::filesystem::path folder = study.store.root() / "program";
  nlohmann::ordered_json json;
  require_replaceable(folder);
  std::filesystem::remove_all(folder);
  if (!file.settings.T_robot_sim) {
    monitor.message(Severity::Warning, "no program: the case does not say where the specimen lies (robot.T_robot_sim)");
    json["written"] = false;
    json["reason"] = "robot.T_robot_sim is not given";
    return json;
  }
  if (half_width_mm(file.settings.tool) > 0.0) {
    const std::string reason = fmt::format("a program does not turn a {} into its direction of travel", kind_of(file.settings.tool));
    monitor.message(Severity::Warning, "no program: " + reason);
    json["written"] = false;
    json["reason"] = reason;
    return json;
  }
  // A program is made of the path whose simulated cut was good: the corrected one where the correction is accepted, else the first.
  const bool is_first_good = done.as_planned && done.as_planned->outcome == Outcome::Success;
  if (!done.is_accepted && !is_first_good) {
    json["written"] = false;
    json["reason"] = "no simulated cut of this study ended in success";
    monitor.message(Severity::Warning, "no program: no simulated cut of this study ended in success");
    return json;
  }
  if (!done.is_accepted) monitor.message(Severity::Warning, "the correction is not accepted: the program follows the uncorrected path");
  const ToolPath path = in_robot_frame(done.is_accepted ? done.correction->moves.path : *done.followed, *file.settings.T_robot_sim);
  const ToolPath intended = in_robot_frame(*done.plan, *file.settings.T_robot_sim);
  ProgramSettings motion;
  motion.overlap_mm = file.settings.cut.overlap_mm;
  const RobotProgram program = make_program(path, motion, arm_setup_of(file.settings));
  CheckSettings settings;
  settings.must_be_ring = file.settings.plan.kind == PlanKind::Ring;
  settings.planned_depth_mm = file.settings.plan.depth_mm;
  settings.close_margin_mm = file.settings.close_margin_mm;
  CheckInputs inputs;
  inputs.intended = &intended;
  inputs.power_w = file.settings.plan.power_w;
  inputs.heat_half_width_mm = widest_heat(file.settings.thermal, file.settings.plan.power_w, path, file.settings.tool).half_width_mm;
  const ProgramChecks checks = check_program(program, path, settings, inputs);
  json = nlohmann::ordered_json::parse(to_json(program, &checks));
  json.erase("poses");
  json["motion"].erase("samples");
  json["follows"] = done.is_accepted ? "corrected path" : "uncorrected path";
  json["written"] = checks.all_passed();
  if (!checks.all_passed()) {
    for (const ProgramCheck& check : checks.checks) {
      if (!check.passed) monitor.message(Severity::Warning, "no program: " + check.message());
    }
    return json;
  }
  ProgramHeader provenance{{"made_by", fmt::format("incise {} ({})", version(), source_commit())}, {"title", file.settings.title}};
  if (file.settings.is_virtual) provenance.emplace_back("specimen", "VIRTUAL SPECIMEN: made for a synthetic body, not for a patient.");
  const ProgramHeader header = program_header(program, path, checks, provenance);
  AtomicFolder target(folder);
  write_tool_path(target.path() / "path.json", path);
  const std::string script = to_urscript(program, header);
  write_atomically(target.path() / "program.json", [&](std::ostream& out) { out << to_json(program, &checks, header); });
  write_atomically(target.path() / "program.script", [&](std::ostream& out) { out << script; });
  const PlayerSettings player;
  const Replay replay = incise::play(program_from_text(script, "program.script"), program.setup.arm, player);
  write_replay(target.path(), replay);
  json["replay"] = to_json(replay, player);
  study.store.write_manifest_to(target.path(), 0.0);
  target.commit();
  return json;
}

nlohmann::ordered_json headline(const nlohmann::ordered_json& cut) {
  nlohmann::ordered_json json = cut;
  for (const char* key : {"removals", "removal_columns", "removal_causes"}) json.erase(key);
  return json;
}

}  // namespace

int run_whole_loop(StudyRun& study, const CommonOptions& options, Monitor& monitor, nlohmann::ordered_json& result) {
  const auto start = std::chrono::steady_clock::now();
  const Study done = study.run(options, monitor);
  const std::filesystem::path root = study.store.root();
  result["stages"] = to_json(done.stages);
  result["outcome"] = to_string(done.outcome);
  result["before"] = done.as_planned ? headline(to_json(*done.as_planned)) : nlohmann::ordered_json(nullptr);
  result["after"] = done.corrected ? headline(to_json(*done.corrected)) : nlohmann::ordered_json(nullptr);
  result["accepted"] = done.is_accepted;
  result["correction"] = done.correction ? correction_summary_json(*done.correction) : nlohmann::ordered_json(nullptr);
  result["specimen_is"] = study.store.case_file().settings.is_virtual ? "virtual" : "real";
  if (done.corrected && done.corrected->outcome == Outcome::Success && done.corrected->inner_edge.outcome == Outcome::PositiveMargin) {
    monitor.message(Severity::Warning, "the kerf's mid-line keeps its distance, but its inner edge reaches the tumour edge once the tool is out");
  }
  bool has_program = true;
  if (done.plan) {
    result["program"] = write_program(study, done, monitor);
    has_program = !study.store.case_file().settings.T_robot_sim || result["program"]["written"].get<bool>();
  }
  const auto elapsed = [&start] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  result["wall_s"] = elapsed();
  nlohmann::ordered_json record = result;
  record["case_file"] = read_json(root / "study.json").at("case_file");
  write_json(root / "study.json", record);
  study.store.write_manifest_to(root, elapsed());
  monitor.message(Severity::Notice, "report: drawing");
  try {
    write_report_and_figures(study_report(root, monitor), root / "report.html");
    write_compensation_figures(root, root / "figures");
  } catch (const Cancelled& error) {
    throw StagesKept(error.what());
  }
  result["report"] = (root / "report.html").string();
  result["wall_s"] = elapsed();
  return has_program ? status_of(done.outcome) : kNotAcceptable;
}

}  // namespace incise::cli
