#include "described_options.hpp"
#include "option_checks.hpp"
#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/steps/camera_steps.hpp>

namespace incise::cli {
namespace {

struct ProjectArguments : steps::ProjectRequest {
  std::string axis = "path";
  std::string metric = "ct";
  std::vector<double> scale_center;
  double depth_mm = 0.0;
  double speed_mm_s = 0.0;
};

ProjectSettings settings_of(const ProjectArguments& arguments) {
  ProjectSettings settings = arguments.settings;
  if (arguments.axis == "normal") settings.axis_mode = AxisMode::SurfaceNormal;
  if (settings.kind == PathKind::Mark) {
    if (arguments.depth_mm > 0.0) settings.mark_depth_mm = arguments.depth_mm;
    if (arguments.speed_mm_s > 0.0) settings.mark_speed_mm_s = arguments.speed_mm_s;
  } else {
    if (arguments.depth_mm > 0.0) settings.incise_depth_mm = arguments.depth_mm;
    if (arguments.speed_mm_s > 0.0) settings.incise_speed_mm_s = arguments.speed_mm_s;
  }
  return settings;
}

int run_project(const ProjectArguments& arguments, const CommonOptions& options) {
  steps::ProjectRequest request = arguments;
  request.output = options.required_output("projected");
  refuse_input_as_output("-o", request.output, {request.path, request.transform, request.surface, request.camera});
  Console console(options.level());
  OlderOutput older(request.output, console);
  request.output.extension() == ".json" ? require_writable(request.output) : require_replaceable(request.output);
  request.takes_camera_size = arguments.metric == "camera";
  if (request.takes_camera_size && !arguments.scale_center.empty()) {
    throw CaseError("command line", "--scale-center", "--metric camera", "--metric ct: otherwise nothing is scaled");
  }
  if (!arguments.scale_center.empty()) request.scale_center_mm = Vec3(arguments.scale_center.data());
  request.settings = settings_of(arguments);
  return run_step(options, [&](const auto& context) {
    steps::StepResult done = steps::project_onto_tissue(request, context);
    older.replaced();
    return done;
  });
}

}  // namespace

void add_project(Application& application) {
  auto [verb, a] = application.add_verb<ProjectArguments>(
      "project", "",
      "incise project scene/path.json --transform registration/registration.json --surface tissue.ply --camera "
      "scene/camera.json -o projected",
      run_project);
  verb->add_option("path", a.path, "path.json, frame sim_stretched")->required();
  verb->add_option("--transform", a.transform,
                   "What `incise register` wrote: T_target_source, from the simulation to the surface's frame")
      ->required();
  verb->add_option("--surface", a.surface, "The measured tissue: cloud or mesh (.ply, .vtp, .stl, .obj), mm")
      ->required();
  verb->add_option(
      "--camera", a.camera,
      "JSON with T_robot_camera, if the surface is in a camera's frame; without it, the surface is in the robot's");
  verb->add_option("--metric", a.metric,
                   "Whose lengths to trust. ct: the scale that register fitted is removed from the cloud, so that the "
                   "simulation keeps its size; camera: the simulation takes the cloud's size")
      ->check(CLI::IsMember({"ct", "camera"}));
  verb->add_option(
          "--scale-center", a.scale_center,
          "With ct: a place (mm, robot's frame) where the cloud is right; by default the camera's origin (--camera), "
          "or without a camera the middle of the path")
      ->expected(3);
  add_choice(*verb, "--kind", a.settings.kind, "incise: the path; mark: the tumour edge, 1 mm deep at 2 mm/s");
  verb->add_option("--axis", a.axis,
                   "Tool axis: as in the path, or against the measured surface's normal (a mark's: the mean axis)")
      ->check(CLI::IsMember({"path", "normal"}));
  verb->add_option("--depth-mm", a.depth_mm,
                   "Depth below the surface; 0: 1 mm for a mark, that of the path for an incision")
      ->check(between("--depth-mm", 0.0, kLaidDepthMm.most));
  verb->add_option("--speed-mm-s", a.speed_mm_s,
                   "Speed of the tip; 0: 2 mm/s for a mark, that of the path for an incision")
      ->check(between("--speed-mm-s", 0.0, kLaidSpeedMmS.most));
  add_options_of(*verb, a.settings, "max_gap_mm", "smoothing_mm", "max_shift_mm");
  verb->add_option("--waypoints", a.settings.mark_waypoints, "Number of waypoints of a mark")
      ->check(whole_between("--waypoints", 8, 2000));
}

}  // namespace incise::cli
