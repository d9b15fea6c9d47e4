#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/manifest.hpp>
#include <incise/storage/bench_files.hpp>
#include <incise/virtual_bench/course.hpp>
#include <incise/workflow/planned_bench_cut.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace incise::cli {
namespace {

struct MakeArguments {
  std::filesystem::path specimen;
  std::filesystem::path truth;
  bool elasticity = false;
};

struct CutArguments {
  std::filesystem::path specimen;
  std::filesystem::path program;
  std::filesystem::path truth;
  double power_w = 35.0;
  double mm_per_pixel = PhotographSettings{}.mm_per_pixel;
};

struct FloorArguments {
  std::filesystem::path specimen;
  double power_w = 35.0;
  int simulations = 3;
};

/// The seed stays out of the laboratory's folder: who knows it can draw the specimen.
void write_run(const std::filesystem::path& folder, const CommonOptions& options, const std::string& command,
               const std::vector<std::filesystem::path>& inputs) {
  Manifest manifest = manifest_of(options, "{}", inputs, options.wall_s());
  manifest.command = command;
  manifest.seed = 0;
  manifest.specimen_id.clear();
  write_manifest(folder, manifest);
}

void make_parent(const std::filesystem::path& folder) {
  if (folder.empty()) return;
  const auto parent = std::filesystem::absolute(folder).parent_path();
  std::error_code error;
  std::filesystem::create_directories(parent, error);
  if (error) throw DataError(folder, "", error.message(), "a folder that can be made");
  require_replaceable(folder);
}

void require_apart(const std::filesystem::path& truth, const std::filesystem::path& output) {
  if (truth.empty() || !(is_same_or_within(truth, output) || is_same_or_within(output, truth))) return;
  throw CaseError("command line", "--truth", truth.string(), "a folder apart from the output",
                  "The truth must not lie beside what a planner reads.");
}

/// A specimen that cannot be held and stretched is a result: it is told, and there is nothing to read or to cut.
bool is_held(const BenchBody& body, Console& console) {
  if (body.inverted_tets > 0)
    console.message(Severity::Detail,
                    fmt::format("{} tets of the stretched specimen are turned inside out", body.inverted_tets));
  if (body.outcome != Outcome::NotConverged) return true;
  console.message(Severity::Warning, fmt::format("the specimen could not be stretched: {}, residual {:.2g}",
                                                 to_string(body.outcome), body.equilibrium_residual));
  return false;
}

int make(const CommonOptions& options, const MakeArguments& arguments) {
  Console console(options.level());
  const std::filesystem::path output = options.required_output("specimen7");
  refuse_input_as_output("-o", output, {arguments.specimen});
  refuse_input_as_output("--truth", arguments.truth, {arguments.specimen});
  require_apart(arguments.truth, output);
  const Specimen specimen =
      arguments.specimen.empty() ? draw_specimen(options.seed) : read_specimen(arguments.specimen);
  for (const auto& folder : {output, arguments.truth}) make_parent(folder);
  Workers workers(options.context().threads);
  const BenchBody body = make_body(specimen, {}, workers, console);
  if (!is_held(body, console)) return kNotAcceptable;
  const Readings readings = take_readings(body, arguments.elasticity, console);
  const std::string name = "VIRTUAL-" + sha256_of_text(to_json(specimen).dump()).substr(0, 8);
  AtomicFolder folder(output);
  write_readings(folder.path(), readings, name);
  write_run(folder.path(), options, "incise bench make", {});
  if (!arguments.truth.empty()) {
    AtomicFolder truth(arguments.truth);
    write_truth(truth.path(), body);
    write_run(truth.path(), options, options.command_line, {});
    truth.commit();
  }
  folder.commit();
  nlohmann::ordered_json result;
  result["specimen"] = name;
  result["folder"] = output.string();
  result["ct"] = (output / "ct").string();
  result["scan"] = (output / "scan.ply").string();
  result["scan_points"] = readings.cloud_mm.size();
  result["stretch_force_n"] = readings.stretch_force_n;
  if (!arguments.truth.empty()) result["truth"] = arguments.truth.string();
  result["virtual"] = true;
  result["wall_s"] = options.wall_s();
  print_result(options, result);
  return kDone;
}

nlohmann::ordered_json truth_of(const BenchBody& body, const BenchCut& cut) {
  nlohmann::ordered_json json;
  json["note"] = "The truth about a virtual cut, for tests: nothing of this may reach a planner.";
  json["outcome"] = to_string(cut.outcome);
  if (cut.inner_edge) {
    double mean = 0.0;
    const std::vector<double> errors = true_errors_mm(body, cut, kInnerEdgeTargetMm);
    for (const double e : errors) mean += std::abs(e) / static_cast<double>(errors.size());
    json["mean_abs_error_mm"] = mean;
    json["signed_errors_mm"] = errors;
  }
  json["bulge_mm"] = cut.bulge_mm;
  json["thermal_width_mm"] = cut.thermal_width_mm;
  json["mean_drag_force_mn"] = cut.mean_force_mn;
  json["removed_tets"] = cut.removed_tets;
  return json;
}

int cut(const CommonOptions& options, const CutArguments& arguments) {
  Console console(options.level());
  const std::filesystem::path output = options.required_output("cut7");
  refuse_input_as_output("-o", output, {arguments.specimen, arguments.program});
  refuse_input_as_output("--truth", arguments.truth, {arguments.specimen, arguments.program});
  require_apart(arguments.truth, output);
  const Specimen specimen = read_specimen(arguments.specimen);
  const WrittenProgram program = program_from_text(read_text(arguments.program), arguments.program);
  const Replay replay = play(program);
  if (replay.outcome != ReplayOutcome::Completed) {
    throw DataError(arguments.program, replay.line > 0 ? fmt::format("line {}", replay.line) : "",
                    fmt::format("a motion that ends as {}", to_string(replay.outcome)),
                    "a program that the arm can run to its end, and that ends outside the tissue",
                    "`incise replay` shows how far it gets.");
  }
  for (const auto& folder : {output, arguments.truth}) make_parent(folder);
  Workers workers(options.context().threads);
  const BenchBody body = make_body(specimen, {}, workers, console);
  if (!is_held(body, console)) return kNotAcceptable;
  const std::vector<TipPose> course =
      tip_course(asked_course(replay, program.T_flange_tool), specimen, T_robot_specimen(specimen).inverse());
  if (const auto misfit = find_misfit(body, course)) {
    throw DataError(arguments.program, "poses", *misfit, "a course in this specimen's tissue round its tumour",
                    "Is it the program of another specimen?");
  }
  const BenchCut done = cut_specimen(body, course, arguments.power_w, workers, console);
  if (done.outcome == Outcome::NotConverged) {
    console.message(Severity::Warning, "the cut did not converge: nothing to photograph");
    return kNotAcceptable;
  }
  PhotographSettings settings;
  settings.mm_per_pixel = arguments.mm_per_pixel;
  AtomicFolder folder(output);
  write_picture(folder.path() / "photo.png", photograph(body, done, settings));
  write_json(folder.path() / "photo.json", {{"note", "Virtual photograph: no real tissue."},
                                            {"mm_per_pixel", settings.mm_per_pixel},
                                            {"ruler_tick_mm", 1.0},
                                            {"red", "annotation"}});
  write_run(folder.path(), options, "incise bench cut", {arguments.program});
  if (!arguments.truth.empty()) {
    AtomicFolder truth(arguments.truth);
    write_json(truth.path() / "cut_truth.json", truth_of(body, done));
    write_run(truth.path(), options, options.command_line, {arguments.specimen, arguments.program});
    truth.commit();
  }
  folder.commit();
  nlohmann::ordered_json result;
  result["photo"] = (output / "photo.png").string();
  result["mm_per_pixel"] = settings.mm_per_pixel;
  result["virtual"] = true;
  result["wall_s"] = options.wall_s();
  print_result(options, result);
  return kDone;
}

/// What no planner can beat: what is left where the bench's physics are known, and only the arm's errors are not.
int floor_of(const CommonOptions& options, const FloorArguments& arguments) {
  Console console(options.level());
  const std::filesystem::path output = options.required_output("floor7.json");
  refuse_input_as_output("-o", output, {arguments.specimen});
  const Specimen specimen = read_specimen(arguments.specimen);
  if (std::filesystem::is_directory(output)) throw DataError(output, "", "a folder", "the name of a file to write");
  const auto parent = std::filesystem::absolute(output).parent_path();
  if (!std::filesystem::is_directory(parent)) throw DataError(parent, "", "no such folder", "a folder to write into");
  Workers workers(options.context().threads);
  const BenchBody body = make_body(specimen, {}, workers, console);
  if (!is_held(body, console)) return kNotAcceptable;
  PlanSettings plan;
  plan.power_w = arguments.power_w;
  const KnownPhysicsCut done = cut_knowing_physics(body, plan, arguments.simulations, workers, console);
  nlohmann::ordered_json result;
  result["note"] = "From the truth about a virtual specimen: nothing of this may reach a planner.";
  result["virtual"] = true;
  result["outcome"] = to_string(done.cut.outcome);
  result["compensation_outcome"] = to_string(done.correction.outcome);
  const bool is_good = done.cut.outcome == Outcome::Success;
  result["mean_abs_error_mm"] = is_good ? truth_of(body, done.cut).at("mean_abs_error_mm") : nlohmann::ordered_json();
  result["passes_mm"] = nlohmann::ordered_json::array();
  for (const CompensationPass& pass : done.correction.passes)
    result["passes_mm"].push_back(pass.mean_abs_error_mm ? nlohmann::ordered_json(*pass.mean_abs_error_mm)
                                                         : nlohmann::ordered_json());
  result["wall_s"] = options.wall_s();
  write_json(output, result);
  print_result(options, result);
  return is_good ? kDone : kNotAcceptable;
}

}  // namespace

void add_bench(Application& application) {
  CLI::App* bench =
      application.add_group("bench", "The virtual laboratory: make a specimen's readings, cut it by a robot program",
                            "incise bench make --seed 7 -o specimen7 --truth hidden7");
  auto made = std::make_shared<MakeArguments>();
  CLI::App* verb = application.add_verb_to(
      *bench, "make", "Make what a laboratory would have of a specimen: CT, cloud, RGB-D frame, pull force",
      "incise bench make --seed 7 -o specimen7 --truth hidden7",
      [made](const CommonOptions& options) { return make(options, *made); });
  verb->add_option("specimen", made->specimen, "Specimen file (incise schema bench); without it the seed draws one");
  verb->add_option("--truth", made->truth,
                   "Folder for the hidden truth; it holds the specimen.json that `bench cut` needs");
  verb->add_flag("--elasticity", made->elasticity, "Also a noisy elasticity map");

  auto run = std::make_shared<CutArguments>();
  verb = application.add_verb_to(*bench, "cut", "Cut a specimen by a robot program and photograph it",
                                 "incise bench cut hidden7/specimen.json cut.script -o cut7",
                                 [run](const CommonOptions& options) { return cut(options, *run); });
  verb->add_option("specimen", run->specimen, "The hidden specimen.json")->required();
  verb->add_option("program", run->program, "A program that `incise export` wrote: URScript, .csv or .json")
      ->required();
  verb->add_option("--power-w", run->power_w, "Of the electrosurgical generator")->check(CLI::Range(1.0, 120.0));
  verb->add_option("--mm-per-pixel", run->mm_per_pixel, "Of the photograph")->check(CLI::Range(0.01, 0.2));
  verb->add_option("--truth", run->truth, "Folder for what really happened, for tests");

  auto floor = std::make_shared<FloorArguments>();
  verb = application.add_verb_to(
      *bench, "floor", "Find the error left to a planner that knows the bench's physics, but not the arm's errors",
      "incise bench floor hidden7/specimen.json -o floor7.json",
      [floor](const CommonOptions& options) { return floor_of(options, *floor); });
  verb->add_option("specimen", floor->specimen, "The hidden specimen.json")->required();
  verb->add_option("--power-w", floor->power_w, "Of the electrosurgical generator")->check(CLI::Range(1.0, 120.0));
  verb->add_option("--simulations", floor->simulations, "Cuts of the bench that the path is corrected by")
      ->check(CLI::Range(2, 8));
}

}  // namespace incise::cli
