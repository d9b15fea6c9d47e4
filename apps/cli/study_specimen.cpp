#include "study_specimen.hpp"

#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/core/verdict.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/transform_json.hpp>

#include <fmt/format.h>

#include <Eigen/LU>
#include <ostream>

namespace incise::cli {
namespace {

using StudyJson = nlohmann::ordered_json;

constexpr double kReferenceKpa = 70.0;     // at which the survey is stretched: the pull is proportional to it
constexpr double kPlatformZMm = 150.0;     // height of the virtual holder's platform in the robot's frame: known to the laboratory
constexpr double kSurveyEdgeMm = 4.0;      // of the mesh that finds the stretched shape
constexpr double kMmPerPixel = 0.03;       // of the photograph, as the paper's
constexpr double kSurfaceSpacingMm = 1.0;
constexpr double kMostHoleMm = 8.0;        // of the depth under the mark: the edge is laid onto the simulated tissue, whose heights are whole

std::string text(double number) { return fmt::format("{}", number); }

/// Pull of the suture: the largest force on a held region along the stretch (y), N.
double pull_n(const StudyJson& stretched) {
  double largest = 0.0;
  for (const StudyJson& reaction : stretched.at("reaction_mn")) largest = std::max(largest, -reaction.at(1).get<double>());
  INCISE_REQUIRE(largest > 0.0, "expected a pull on the stretched end");
  return 1e-3 * largest;
}

void write_file(const std::filesystem::path& path, const std::string& content) {
  write_atomically(path, [&content](std::ostream& out) { out << content; });
}

}  // namespace

SpecimenTrial::SpecimenTrial(TrialSetup setup, int threads, const Monitor& monitor)
    : setup_(std::move(setup)), runner_(setup_.folder, threads, monitor) {}

std::optional<StepRecord> SpecimenTrial::run(const ExperimentStep& step) {
  StepRecord record = runner_.run(step);
  if (record.status == kDone) return record;
  ended_at_ = refusal_of(step.name, record);
  return std::nullopt;
}

bool SpecimenTrial::prepare(const std::optional<ChosenTool>& tool) {
  if (!make() || !find_shape() || !find_place()) return false;
  (void)write_variant("case.yaml", tool, youngs_modulus_kpa_, CompensationMethod::Default);
  return run({"plan", {"plan", case_file().string(), "-o", at("planned").string()}, {case_file(), at("tumor.csv"), at("lab/ct")}, {planned_path()}}).has_value();
}

bool SpecimenTrial::make() {
  const std::filesystem::path lab = at("lab");
  std::vector<std::string> arguments{"bench", "make"};
  std::vector<std::filesystem::path> inputs;
  std::filesystem::create_directories(setup_.truth.parent_path());
  if (!setup_.given.empty()) {
    StudyJson specimen{{"schema", "incise.specimen/1"}, {"seed", setup_.seed}};
    for (const auto& [key, value] : setup_.given) specimen[key] = value;
    const std::filesystem::path file = setup_.truth.parent_path() / (setup_.name + ".json");
    write_json(file, specimen);
    arguments.push_back(file.string());
    inputs.push_back(file);
  }
  for (const std::string& word : {std::string("--seed"), std::to_string(setup_.seed), std::string("-o"), lab.string(), std::string("--truth"), setup_.truth.string()})
    arguments.push_back(word);
  const auto made = run({"bench_make", arguments, inputs, {lab, setup_.truth}});
  if (!made) return false;
  stretch_force_n_ = made->result.at("stretch_force_n").get<double>();
  return true;
}

bool SpecimenTrial::find_shape() {
  const std::filesystem::path labels = at("labels.nrrd"), mesh = at("survey.vtu"), survey = at("survey.yaml");
  if (!run({"segment", {"segment", at("lab/ct").string(), "-o", labels.string()}, {at("lab/ct")}, {labels}})) return false;
  if (!run({"survey_mesh", {"mesh", labels.string(), "--coarse-mm", text(kSurveyEdgeMm), "-o", mesh.string()}, {labels}, {mesh}})) return false;
  write_file(survey, fmt::format("schema: incise.case/1\nspecimen_is: virtual\nspecimen:\n  mesh: survey.vtu\n  material: {{youngs_modulus_kpa: {}}}\n", kReferenceKpa));
  const auto stretched = run({"survey_deform", {"deform", survey.string(), "-o", at("survey").string()}, {survey, mesh}, {at("survey/stretched")}});
  if (!stretched) return false;
  youngs_modulus_kpa_ = kReferenceKpa * stretch_force_n_ / pull_n(stretched->result);
  return run({"simulated_surface",
              {"surface", survey.string(), "--spacing-mm", text(kSurfaceSpacingMm), "-o", at("simulated.ply").string()},
              {survey, mesh},
              {at("simulated.ply")}})
      .has_value();
}

bool SpecimenTrial::find_place() {
  const std::string camera = at("lab/camera.json").string();
  if (!run({"track",
            {"track", at("lab/rgb.png").string(), at("lab/depth.png").string(), "--intrinsics", camera, "--max-hole-mm", text(kMostHoleMm), "-o", at("tracked").string()},
            {at("lab/rgb.png"), at("lab/depth.png"), camera},
            {at("tracked/contour.csv"), at("tracked/cloud.ply")}})) {
    return false;
  }
  const auto tissue = run({"tissue",
                           {"surface", at("tracked/cloud.ply").string(), "--planes", "1", "--voxel-mm", text(kSurfaceSpacingMm), "--approach", "0", "0",
                            "1", "--camera", camera, "--plane-z-mm", text(kPlatformZMm), "-o", at("tissue.ply").string()},
                           {at("tracked/cloud.ply"), camera},
                           {at("tissue.ply")}});
  if (!tissue) return false;
  camera_scale_ = tissue->result.at("camera_scale").get<double>();
  const auto laid = run({"register",
                         {"register", "--source", at("simulated.ply").string(), "--target", at("tissue.ply").string(), "--scale", "fixed", "-o",
                          at("registration").string()},
                         {at("simulated.ply"), at("tissue.ply")},
                         {registration()}});
  if (!laid) return false;
  registration_rmse_mm_ = laid->result.at("rmse_mm").get<double>();
  write_edge(laid->result);
  return true;
}

/// The edge that was marked on the tissue, as the simulation would have it.
void SpecimenTrial::write_edge(const StudyJson& registration) const {
  Contour edge = read_contour(at("tracked/contour.csv"));
  const Mat4 T_sim_camera = transform_in(registration, "T_target_source", this->registration()).inverse();
  for (Vec3& p : edge.points) p = (T_sim_camera * (p / camera_scale_).homogeneous()).head<3>();
  write_contour_csv(at("tumor.csv"), edge);
}

std::filesystem::path SpecimenTrial::write_variant(const std::string& name, const std::optional<ChosenTool>& tool, double youngs_modulus_kpa,
                                                   CompensationMethod method) const {
  std::string yaml = fmt::format(
      "schema: incise.case/1\nspecimen_is: virtual\nct: {{volume: lab/ct}}\nmeshing: {{tets: {}}}\nspecimen:\n  material: {{youngs_modulus_kpa: {:.4f}}}\n"
      "tumor: {{contour: tumor.csv, configuration: stretched}}\nplan: {{power_w: {}}}\n",
      setup_.tets, youngs_modulus_kpa, setup_.power_w);
  if (tool) {
    yaml += fmt::format("cut: {{speed_mm_s: {}, dullness: {}}}\n", tool->speed_mm_s, tool->dullness);
    yaml += method == CompensationMethod::Paper ? std::string("compensation: {method: paper}\n")
                                                : fmt::format("compensation: {{observable: inner_edge, bias_mm: {}}}\n", tool->bias_mm);
  }
  write_file(at(name), yaml);
  return at(name);
}

TrialCut SpecimenTrial::cut(const std::filesystem::path& path, const std::string& tag) {
  const auto named = [&](const std::string& name) { return at(tag + "_" + name); };
  const std::string camera = at("lab/camera.json").string(), truth = setup_.truth.string() + "_" + tag;
  const std::filesystem::path registration = this->registration(), specimen = setup_.truth / "specimen.json";
  const std::filesystem::path projected = named("on_tissue"), program = named("cut.script"), photo = named("cut"),
                              found = at(fmt::format("{}_{}.json", setup_.name, tag));
  std::vector<std::string> exported{"export", (projected / "path.json").string(), "--surface", (projected / "surface.ply").string(),
                                    "--registration", registration.string(), "--power-w", text(setup_.power_w), "-o", program.string()};
  // The bench's tissue is virtual, and the cut as planned is made to see how far it misses: cautions are taken. What a simulation refuses
  // is not cut here either.
  for (const VerdictRule& rule : verdict_rules()) {
    if (rule.severity == VerdictStatus::Caution) exported.insert(exported.end(), {"--accept", std::string(rule.id)});
  }
  const std::vector<ExperimentStep> steps{
      {tag + "_project",
       {"project", path.string(), "--transform", registration.string(), "--surface", at("tissue.ply").string(), "--camera", camera, "-o", projected.string()},
       {path, registration, at("tissue.ply"), camera},
       {projected}},
      {tag + "_export",
       exported,
       {projected / "path.json", projected / "surface.ply", registration},
       {program}},
      {tag + "_bench_cut",
       {"bench", "cut", specimen.string(), program.string(), "--power-w", text(setup_.power_w), "-o", photo.string(), "--truth", truth},
       {specimen, program},
       {photo / "photo.png", std::filesystem::path(truth) / "cut_truth.json"}},
      {tag + "_evaluate",
       {"evaluate", (photo / "photo.png").string(), "--mm-per-pixel", text(kMmPerPixel), "--figure", named("found.png").string(), "-o", found.string()},
       {photo / "photo.png"},
       {found}}};
  TrialCut result;
  StepRecord last;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    last = runner_.run(steps[i]);
    if (last.status != kDone) {
      result.ended_at = refusal_of(steps[i].name, last);
      return result;
    }
    result.is_made = i >= 2;  // the bench has cut
  }
  result.measured = MeasuredCut{found, std::move(last.result)};
  return result;
}

}  // namespace incise::cli
