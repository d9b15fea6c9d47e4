#include "laboratory/experiment_tables.hpp"
#include "laboratory/specimen_trial.hpp"

#include <incise/core/defaults.hpp>
#include <incise/core/error.hpp>
#include <incise/core/verdict.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/transform_json.hpp>
#include <incise/planning/robust_compensation.hpp>
#include <incise/steps/camera_steps.hpp>
#include <incise/steps/cut_steps.hpp>
#include <incise/steps/robot_steps.hpp>
#include <incise/steps/tissue_steps.hpp>
#include <incise/storage/run_folder.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>

namespace incise::laboratory {
namespace {

using StudyJson = nlohmann::ordered_json;

constexpr double kReferenceKpa = 70.0;  // Young's modulus for the survey's stretch: the pull is proportional to it
constexpr double kPlatformZMm =
    150.0;  // height of the virtual holder's platform in the robot's frame: known to the laboratory
constexpr double kSurveyEdgeMm = 4.0;  // of the mesh that finds the stretched shape
constexpr double kMmPerPixel = 0.03;   // of the photograph, as in the paper
constexpr double kSurfaceSpacingMm = 1.0;
constexpr double kMostHoleMm =
    8.0;  // of the depth beneath the mark: the edge is laid onto the simulated tissue, whose heights have no holes

std::string text(double number) {
  return fmt::format("{}", number);
}

/// Pull of the suture: the largest force on a held region along the stretch (y), N.
double pull_n(const StudyJson& stretched) {
  double largest = 0.0;
  for (const StudyJson& reaction : stretched.at("reaction_mn"))
    largest = std::max(largest, -reaction.at(1).get<double>());
  INCISE_REQUIRE(largest > 0.0, "expected a pull on the stretched end");
  return 1e-3 * largest;
}

/// The fields that each method reads of a choice, as in a case file.
std::vector<std::string> fields_of(const CompensationChoice& choice) {
  std::vector<std::string> fields;
  if (choice.method != CompensationMethod::Default)
    fields.push_back(fmt::format("method: {}", to_string(choice.method)));
  if (choice.method == CompensationMethod::Default) {
    fields.push_back(fmt::format("observable: {}", to_string(choice.observable)));
    fields.push_back(fmt::format("bias_mm: {}", choice.bias_mm));
  }
  if (choice.simulated_share != 1.0) fields.push_back(fmt::format("simulated_share: {}", choice.simulated_share));
  for (const auto& [field, list] :
       {std::pair{"residual_mm", &choice.residual_mm}, std::pair{"photographed_mm", &choice.photographed_mm}}) {
    if (!list->empty()) fields.push_back(fmt::format("{}: [{}]", field, fmt::join(*list, ", ")));
  }
  return fields;
}

/// Whether a correction produced a path.
bool has_path(const StudyJson& compensation) {
  return compensation.is_object() && compensation.contains("path") && compensation.at("path").is_string();
}

}  // namespace

CompensationChoice calibrated_choice(const ChosenTool& tool) {
  return {.observable = ContourKind::InnerEdge, .bias_mm = tool.bias_mm};
}

std::optional<StudyJson> SpecimenTrial::run(const ExperimentStep& step) {
  StepAnswer answer = steps_.run(step);
  if (answer.end == StepEnd::Done) return std::move(answer.result);
  ended_at_ = refusal_of(step.name, answer);
  return std::nullopt;
}

bool SpecimenTrial::prepare(const std::optional<ChosenTool>& tool) {
  if (!read() || !find_shape() || !find_place()) return false;
  const std::filesystem::path file = write_variant(
      "case.yaml", {tool, youngs_modulus_kpa_, tool ? std::optional(calibrated_choice(*tool)) : std::nullopt});
  const std::filesystem::path output = at("planned");
  return run({"plan",
              {"plan", file.string(), "-o", output.string()},
              {file, at("tumor.csv"), at("lab/ct")},
              {planned_path()},
              [=](const steps::StepContext& context) {
                return steps::run_stages({read_case_with_inputs(file), output, {.until = Stage::Plan}}, context);
              }})
      .has_value();
}

bool SpecimenTrial::read() {
  const StepAnswer readings = laboratory_.take_readings(at("lab"));
  if (readings.end != StepEnd::Done) {
    ended_at_ = refusal_of("bench_make", readings);
    return false;
  }
  stretch_force_n_ = readings.result.at("stretch_force_n").get<double>();
  const auto asked = readings.result.find("prescription");
  if (asked != readings.result.end()) {
    prescription_ = *asked;
    if (setup_.given_power_w) prescription_["power_w"] = *setup_.given_power_w;
    setup_.power_w = prescription_.at("power_w").get<double>();
  }
  return true;
}

bool SpecimenTrial::find_shape() {
  const std::filesystem::path ct = at("lab/ct"), labels = at("labels.nrrd"), mesh = at("survey.vtu"),
                              survey = at("survey.yaml");
  if (!run({"segment",
            {"segment", ct.string(), "-o", labels.string()},
            {ct},
            {labels},
            [=](const steps::StepContext& context) {
              return steps::segment_scan({.ct = ct, .output = labels}, context);
            }}))
    return false;
  const steps::MeshRequest meshing{.input = labels, .coarse_mm = kSurveyEdgeMm, .output = mesh};
  if (!run({"survey_mesh",
            {"mesh", labels.string(), "--coarse-mm", text(kSurveyEdgeMm), "-o", mesh.string()},
            {labels},
            {mesh},
            [=](const steps::StepContext& context) { return steps::mesh_body(meshing, context); }}))
    return false;
  write_atomically(survey, fmt::format("schema: incise.case/1\nspecimen_is: virtual\nspecimen:\n  mesh: survey.vtu\n  "
                                       "material: {{youngs_modulus_kpa: {}}}\n",
                                       kReferenceKpa));
  const std::filesystem::path output = at("survey"), simulated = at("simulated.ply");
  const auto stretched =
      run({"survey_deform",
           {"deform", survey.string(), "-o", output.string()},
           {survey, mesh},
           {at("survey/stretched")},
           [=](const steps::StepContext& context) {
             return steps::run_stages({read_case_with_inputs(survey), output, {.until = Stage::Stretch}}, context);
           }});
  if (!stretched) return false;
  youngs_modulus_kpa_ = kReferenceKpa * stretch_force_n_ / pull_n(*stretched);
  steps::SurfaceRequest seen{.input = survey, .output = simulated};
  seen.view.spacing_mm = kSurfaceSpacingMm;
  return run({"simulated_surface",
              {"surface", survey.string(), "--spacing-mm", text(kSurfaceSpacingMm), "-o", simulated.string()},
              {survey, mesh},
              {simulated},
              [=](const steps::StepContext& context) { return steps::see_surface(seen, context); }})
      .has_value();
}

bool SpecimenTrial::find_place() {
  const std::filesystem::path camera = at("lab/camera.json"), cloud = at("tracked/cloud.ply"),
                              tissue = at("tissue.ply");
  steps::TrackRequest tracking{.color = at("lab/rgb.png"), .depth = at("lab/depth.png"), .intrinsics = camera};
  tracking.lift.max_hole_mm = kMostHoleMm;
  tracking.output = at("tracked");
  if (!run({"track",
            {"track", tracking.color.string(), tracking.depth.string(), "--intrinsics", camera.string(),
             "--max-hole-mm", text(kMostHoleMm), "-o", tracking.output.string()},
            {tracking.color, tracking.depth, camera},
            {at("tracked/contour.csv"), cloud},
            [=](const steps::StepContext& context) { return steps::track_mark(tracking, context); }}))
    return false;
  steps::SurfaceRequest cleaning{
      .input = cloud, .approach = Vec3(Vec3::UnitZ()), .camera = camera, .plane_z_mm = kPlatformZMm, .output = tissue};
  cleaning.cleaning.planes = 1;
  cleaning.cleaning.voxel_mm = kSurfaceSpacingMm;
  const auto cleaned =
      run({"tissue",
           {"surface", cloud.string(), "--planes", "1", "--voxel-mm", text(kSurfaceSpacingMm), "--approach", "0", "0",
            "1", "--camera", camera.string(), "--plane-z-mm", text(kPlatformZMm), "-o", tissue.string()},
           {cloud, camera},
           {tissue},
           [=](const steps::StepContext& context) { return steps::see_surface(cleaning, context); }});
  if (!cleaned) return false;
  camera_scale_ = cleaned->at("camera_scale").get<double>();
  steps::RegisterRequest laying{.source = at("simulated.ply"), .target = tissue, .output = at("registration")};
  laying.settings.scale = ScaleRange::fixed();
  const auto laid = run({"register",
                         {"register", "--source", laying.source.string(), "--target", tissue.string(), "--scale",
                          "fixed", "-o", laying.output.string()},
                         {laying.source, tissue},
                         {registration()},
                         [=](const steps::StepContext& context) { return steps::lay_clouds(laying, context); }});
  if (!laid) return false;
  registration_rmse_mm_ = laid->at("rmse_mm").get<double>();
  write_edge(*laid);
  return true;
}

/// Writes the edge that was marked on the tissue, in the simulation's frame.
void SpecimenTrial::write_edge(const StudyJson& registration) const {
  Contour edge = read_contour(at("tracked/contour.csv"));
  const Mat4 T_sim_camera = transform_in(registration, "T_target_source", this->registration()).inverse();
  for (Vec3& p : edge.points) p = (T_sim_camera * (p / camera_scale_).homogeneous()).head<3>();
  write_contour_csv(at("tumor.csv"), edge);
}

std::filesystem::path SpecimenTrial::write_variant(const std::string& name, const CaseVariant& variant) const {
  std::vector<std::string> plan{fmt::format("power_w: {}", setup_.power_w)};
  for (const char* field : {"lateral_margin_mm", "depth_mm", "speed_mm_s", "start_direction"})
    if (prescription_.is_object()) plan.push_back(fmt::format("{}: {}", field, prescription_.at(field).dump()));
  std::string yaml = fmt::format(
      "schema: incise.case/1\nspecimen_is: virtual\nct: {{volume: lab/ct}}\nmeshing: {{tets: {}}}\nspecimen:\n  "
      "material: {{youngs_modulus_kpa: {:.4f}}}\n"
      "tumor: {{contour: tumor.csv, configuration: stretched}}\nplan: {{{}}}\n",
      setup_.tets, variant.youngs_modulus_kpa, fmt::join(plan, ", "));
  std::vector<std::string> cut;
  if (setup_.rule != CutRule::Tets) cut.push_back(fmt::format("rule: {}", to_string(setup_.rule)));
  if (variant.tool) {
    cut.push_back(fmt::format("speed_mm_s: {}", variant.tool->speed_mm_s));
    cut.push_back(fmt::format("dullness: {}", variant.tool->dullness));
  }
  if (!cut.empty()) yaml += fmt::format("cut: {{{}}}\n", fmt::join(cut, ", "));
  if (variant.compensation)
    yaml += fmt::format("compensation: {{{}}}\n", fmt::join(fields_of(*variant.compensation), ", "));
  write_atomically(at(name), yaml);
  return at(name);
}

TrialCut SpecimenTrial::cut(const std::filesystem::path& path, const std::string& tag) {
  const auto named = [&](const std::string& name) { return at(tag + "_" + name); };
  const std::filesystem::path camera = at("lab/camera.json"), registration = this->registration(), photo = named("cut"),
                              found = at(fmt::format("{}_{}.json", setup_.name, tag));
  steps::ProjectRequest projecting{.path = path,
                                   .transform = registration,
                                   .surface = at("tissue.ply"),
                                   .camera = camera,
                                   .output = named("on_tissue")};
  steps::ExportRequest exporting{.path = projecting.output / "path.json",
                                 .surface = projecting.output / "surface.ply",
                                 .registration = registration,
                                 .power_w = setup_.power_w,
                                 .output = named("cut.script")};
  std::vector<std::string> exported{"export",
                                    exporting.path.string(),
                                    "--surface",
                                    exporting.surface.string(),
                                    "--registration",
                                    registration.string(),
                                    "--power-w",
                                    text(setup_.power_w),
                                    "-o",
                                    exporting.output.string()};
  if (prescription_.is_object()) {
    exporting.checks.planned_depth_mm = prescription_.at("depth_mm").get<double>();
    exported.insert(exported.end(), {"--depth-mm", text(exporting.checks.planned_depth_mm)});
  }
  exporting.overrides = setup_.overrides;
  for (const std::string& check : setup_.overrides) exported.insert(exported.end(), {"--override", check});
  // The bench's tissue is virtual, and the purpose of the cut as planned is to see how far it misses, so cautions are
  // accepted. What a simulation refuses is not cut here either.
  for (const VerdictRule& rule : verdict_rules()) {
    if (rule.severity != VerdictStatus::Caution) continue;
    exporting.accepted.emplace_back(rule.id);
    exported.insert(exported.end(), {"--accept", std::string(rule.id)});
  }
  steps::EvaluateRequest evaluating{.photo = photo / "photo.png", .figure = named("found.png"), .output = found};
  evaluating.scale.mm_per_pixel = kMmPerPixel;
  std::vector<std::string> evaluated{"evaluate",
                                     evaluating.photo.string(),
                                     "--mm-per-pixel",
                                     text(kMmPerPixel),
                                     "--figure",
                                     evaluating.figure.string(),
                                     "-o",
                                     found.string()};
  if (prescription_.is_object()) {
    evaluating.settings.target_mm = prescription_.at("lateral_margin_mm").get<double>() - kElectrodeRadiusMm;
    evaluated.insert(evaluated.end(), {"--target-mm", text(*evaluating.settings.target_mm)});
  }
  const ExperimentStep project{
      tag + "_project",
      {"project", path.string(), "--transform", registration.string(), "--surface", projecting.surface.string(),
       "--camera", camera.string(), "-o", projecting.output.string()},
      {path, registration, projecting.surface, camera},
      {projecting.output},
      [=](const steps::StepContext& context) { return steps::project_onto_tissue(projecting, context); }};
  const ExperimentStep make_program{
      tag + "_export",
      exported,
      {exporting.path, exporting.surface, registration},
      {exporting.output},
      [=](const steps::StepContext& context) { return steps::export_program(exporting, context); }};
  const ExperimentStep evaluate{
      tag + "_evaluate", evaluated, {evaluating.photo}, {found}, [=](const steps::StepContext& context) {
        return steps::evaluate_cut(evaluating, context);
      }};
  TrialCut result;
  const auto goes_on = [&result](const std::string& step, const StepAnswer& answer) {
    if (answer.end == StepEnd::Done) return true;
    result.ended_at = refusal_of(step, answer);
    return false;
  };
  for (const ExperimentStep* step : {&project, &make_program})
    if (!goes_on(step->name, steps_.run(*step))) return result;
  if (!goes_on(tag + "_bench_cut", laboratory_.cut(exporting.output, setup_.power_w, photo, tag))) return result;
  result.is_made = true;
  StepAnswer measured = steps_.run(evaluate);
  if (goes_on(evaluate.name, measured)) result.measured = MeasuredCut{found, std::move(measured.result)};
  return result;
}

void SpecimenTrial::begin_run(const std::filesystem::path& folder, Stage until) const {
  const std::filesystem::path corrected = at("compensated");
  take_products(folder != corrected && std::filesystem::exists(corrected) ? corrected : at("planned"), folder, until);
}

SecondCut SpecimenTrial::cut_again(const std::filesystem::path& file, const std::filesystem::path& folder,
                                   const std::string& tag, bool is_simulated) {
  const std::filesystem::path path = folder / "correction/path.json";
  std::vector<std::string> words{"compensate", file.string()};
  if (!is_simulated) words.emplace_back("--no-verify");
  words.insert(words.end(), {"-o", folder.string()});
  const StepAnswer corrected =
      steps_.run({tag + "_compensate",
                  words,
                  {file, at("tumor.csv"), at("lab/ct")},
                  {path},
                  [=, this](const steps::StepContext& context) {
                    begin_run(folder, is_simulated ? Stage::Simulate : Stage::Plan);
                    const CaseFile of = read_case_with_inputs(file);
                    return is_simulated ? steps::compensate_case({of, folder, {}}, std::nullopt, context)
                                        : steps::run_stages({of, folder, {.until = Stage::Compensate}}, context);
                  }});
  if (corrected.end == StepEnd::Done || (corrected.end == StepEnd::NotAcceptable && has_path(corrected.result)))
    return {corrected.result, cut(path, tag)};
  return {corrected.result, {.ended_at = refusal_of(tag + "_compensate", corrected)}};
}

TrialCut SpecimenTrial::cut_robustly(const std::filesystem::path& file, const steps::CalibratedRequest& known,
                                     const std::filesystem::path& folder, const std::string& tag) {
  const std::filesystem::path path = folder / "robust/path.json";
  std::vector<std::string> words{"compensate", file.string(), "--robust", "--calibration", known.calibration.string()};
  if (known.stretch_force_n) words.insert(words.end(), {"--stretch-force-n", text(*known.stretch_force_n)});
  words.insert(words.end(), {"-o", folder.string()});
  const StepAnswer found =
      steps_.run({tag + "_compensate",
                  words,
                  {file, at("tumor.csv"), at("lab/ct"), known.calibration},
                  {path},
                  [=, this](const steps::StepContext& context) {
                    begin_run(folder, Stage::Verify);
                    return steps::compensate_case(
                        {read_case_with_inputs(file), folder, {}},
                        steps::RobustRequest{.calibration = steps::read_calibration_input(known)}, context);
                  }});
  // The default correction of the same run may be refused, and this path may still be sound.
  const StudyJson robust = json_part(found.result, "/robust");
  if (robust.is_object() && robust.at("outcome") == to_string(RobustOutcome::Met)) return cut(path, tag);
  const std::string step = tag + "_compensate";
  return {.ended_at = found.end == StepEnd::Done ? step + ": not found" : refusal_of(step, found)};
}

}  // namespace incise::laboratory
