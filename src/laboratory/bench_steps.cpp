#include "laboratory/virtual_specimen.hpp"

#include <incise/bench_studies/planned_bench_cut.hpp>
#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/laboratory/bench_files.hpp>
#include <incise/laboratory/bench_steps.hpp>

#include <fmt/format.h>

namespace incise::laboratory {
namespace {

/// The laboratory's folder does not state the seed, from which anyone can draw the specimen.
void write_run(const std::filesystem::path& folder, const steps::StepContext& context, const std::string& command,
               const std::vector<std::filesystem::path>& inputs) {
  Manifest manifest = steps::manifest_of(context.run, "{}", inputs, context.wall_s());
  manifest.command = command;
  manifest.seed = 0;
  manifest.specimen_id.clear();
  write_manifest(folder, manifest);
}

}  // namespace

steps::StepResult make_specimen(const MakeSpecimenRequest& request, const steps::StepContext& context) {
  for (const auto& folder : {request.output, request.truth}) steps::make_parent(folder);
  const std::unique_ptr<const VirtualSpecimen> specimen = specimen_of(request, context);
  if (!specimen->is_held(context.monitor)) return {nullptr, false};
  const Readings readings = specimen->readings(request.has_elasticity, context.monitor);
  const std::string name = "VIRTUAL-" + sha256_of_text(specimen->file().dump()).substr(0, 8);
  AtomicFolder folder(request.output);
  write_readings(folder.path(), readings, name, specimen->prescription());
  write_run(folder.path(), context, "incise bench make", {});
  if (!request.truth.empty()) {
    AtomicFolder truth(request.truth);
    specimen->write_truth(truth.path());
    write_run(truth.path(), context, context.run.command, {});
    truth.commit();
  }
  folder.commit();
  steps::StepResult done;
  nlohmann::ordered_json& result = done.json;
  result["specimen"] = name;
  result["folder"] = request.output.string();
  result["ct"] = (request.output / "ct").string();
  result["scan"] = (request.output / "scan.ply").string();
  result["scan_points"] = readings.cloud_mm.size();
  result["stretch_force_n"] = readings.stretch_force_n;
  if (const auto asked = specimen->prescription(); !asked.is_null()) result["prescription"] = asked;
  if (!request.truth.empty()) result["truth"] = request.truth.string();
  result["virtual"] = true;
  result["wall_s"] = context.wall_s();
  return done;
}

steps::StepResult cut_specimen_by(const CutSpecimenRequest& request, const steps::StepContext& context) {
  const WrittenProgram program = program_from_text(read_text(request.program), request.program);
  const Replay replay = play(program);
  if (replay.outcome != ReplayOutcome::Completed) {
    throw DataError(request.program, replay.line > 0 ? fmt::format("line {}", replay.line) : "",
                    fmt::format("a motion that ends as {}", to_string(replay.outcome)),
                    "a program that the arm can complete and that ends outside the tissue",
                    "`incise replay` shows how far it gets.");
  }
  for (const auto& folder : {request.output, request.truth}) steps::make_parent(folder);
  const std::unique_ptr<const VirtualSpecimen> specimen = specimen_of(request.specimen, context);
  if (!specimen->is_held(context.monitor)) return {nullptr, false};
  const std::vector<TipPose> course = specimen->course(asked_course(replay, program.T_flange_tool));
  if (const auto misfit = specimen->misfit(course)) {
    throw DataError(request.program, "poses", *misfit, "a course in this specimen's tissue that goes round its tumour",
                    "Is it the program of another specimen?");
  }
  const PhotographSettings settings{.mm_per_pixel = request.mm_per_pixel};
  const auto made = specimen->cut(course, request.power_w, settings, context.workers, context.monitor);
  if (!made) {
    context.monitor.message(Severity::Warning, "the cut did not converge, so it has no photograph");
    return {nullptr, false};
  }
  AtomicFolder folder(request.output);
  write_picture(folder.path() / "photo.png", made->photograph);
  write_json(folder.path() / "photo.json", {{"note", "Virtual photograph: no real tissue."},
                                            {"mm_per_pixel", settings.mm_per_pixel},
                                            {"ruler_tick_mm", 1.0},
                                            {"red", "annotation"}});
  write_run(folder.path(), context, "incise bench cut", {request.program});
  if (!request.truth.empty()) {
    AtomicFolder truth(request.truth);
    write_json(truth.path() / "cut_truth.json", made->truth);
    write_run(truth.path(), context, context.run.command, {request.specimen, request.program});
    truth.commit();
  }
  folder.commit();
  steps::StepResult done;
  nlohmann::ordered_json& result = done.json;
  result["photo"] = (request.output / "photo.png").string();
  result["mm_per_pixel"] = settings.mm_per_pixel;
  result["virtual"] = true;
  result["wall_s"] = context.wall_s();
  return done;
}

steps::StepResult cut_by_known_physics(const KnownPhysicsRequest& request, const steps::StepContext& context) {
  const Specimen specimen = read_specimen(request.specimen);
  if (std::filesystem::is_directory(request.output))
    throw DataError(request.output, "", "a folder", "the name of a file to write");
  const auto parent = std::filesystem::absolute(request.output).parent_path();
  if (!std::filesystem::is_directory(parent)) throw DataError(parent, "", "no such folder", "a folder to write into");
  const BenchBody body = make_body(specimen, {}, context.workers, context.monitor);
  if (!is_stretched(body, context.monitor)) return {nullptr, false};
  const PlanSettings plan{.power_w = request.power_w};
  const KnownPhysicsCut made = cut_knowing_physics(body, plan, request.simulations, context.workers, context.monitor);
  steps::StepResult result_of;
  nlohmann::ordered_json& result = result_of.json;
  result["note"] = "From the truth about a virtual specimen. No part of it may reach a planner.";
  result["virtual"] = true;
  result["outcome"] = to_string(made.cut.outcome);
  result["compensation_outcome"] = to_string(made.correction.outcome);
  const bool is_good = made.cut.outcome == Outcome::Success;
  result["mean_abs_error_mm"] = is_good ? truth_of(body, made.cut).at("mean_abs_error_mm") : nlohmann::ordered_json();
  result["passes_mm"] = nlohmann::ordered_json::array();
  for (const CompensationPass& pass : made.correction.passes)
    result["passes_mm"].push_back(to_json(pass.mean_abs_error_mm));
  result["wall_s"] = context.wall_s();
  write_json(request.output, result);
  result_of.is_acceptable = is_good;
  return result_of;
}

}  // namespace incise::laboratory
