#include "camera_options.hpp"
#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/core/problem_text.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/planning/project_path.hpp>

#include <fmt/format.h>

#include <memory>

namespace incise::cli {
namespace {

constexpr double kLowScale = 0.95;  // both sensors are metric
constexpr double kHighScale = 1.05;

struct ProjectArguments {
  std::filesystem::path path;
  std::filesystem::path transform;
  std::filesystem::path surface;
  std::filesystem::path camera;
  std::string kind = "incise";
  std::string axis = "path";
  double depth_mm = 0.0;
  double speed_mm_s = 0.0;
  ProjectSettings settings;
};

/// What `register` wrote. A search that did not end well is no ground for moving a robot.
Mat4 registration(const std::filesystem::path& file, Console& console) {
  const nlohmann::ordered_json document = read_json(file);
  if (const auto converged = document.find("converged");
      converged != document.end() && converged->is_boolean() && !converged->get<bool>()) {
    throw DataError(file, "/converged", "false", "a registration that converged",
                    "Register again: with more starts, or with the cloud cropped to the tissue.");
  }
  const Mat4 T = transform_in(document, "T_target_source", file);
  const double scale = std::cbrt(T.topLeftCorner<3, 3>().determinant());
  if (scale < kLowScale || scale > kHighScale) {
    console.message(Severity::Warning,
                    fmt::format("{}: the scale is {:.4f}; both sensors are metric, so that {} to {} is expected",
                                file.string(), scale, kLowScale, kHighScale));
  }
  return T;
}

ProjectSettings settings_of(const ProjectArguments& arguments) {
  ProjectSettings settings = arguments.settings;
  settings.kind = arguments.kind == "mark" ? PathKind::Mark : PathKind::Incise;
  settings.axis_mode = arguments.axis == "normal" ? AxisMode::SurfaceNormal : AxisMode::Approach;
  if (settings.kind == PathKind::Mark) {
    if (arguments.depth_mm > 0.0) settings.mark_depth_mm = arguments.depth_mm;
    if (arguments.speed_mm_s > 0.0) settings.mark_speed_mm_s = arguments.speed_mm_s;
  } else {
    if (arguments.depth_mm > 0.0) settings.incise_depth_mm = arguments.depth_mm;
    if (arguments.speed_mm_s > 0.0) settings.incise_speed_mm_s = arguments.speed_mm_s;
  }
  return settings;
}

ToolPath simulated_path(const std::filesystem::path& file, PathKind kind) {
  ToolPath path = read_tool_path(file);
  if (path.frame != PathFrame::SimStretched) {
    throw DataError(file, "frame", std::string(to_string(path.frame)), "sim_stretched",
                    "The camera sees the stretched tissue: only a path on it can be laid down.");
  }
  if (kind == PathKind::Mark && path.tumor_edge.points.size() < 3) {
    throw DataError(file, "tumor_edge", fmt::format("{} points", path.tumor_edge.points.size()),
                    "the edge that is to be marked");
  }
  return path;
}

int run(const ProjectArguments& arguments, const CommonOptions& options) {
  Console console(options.level());
  const std::filesystem::path output = options.required_output("robot_path.json");
  const ProjectSettings settings = settings_of(arguments);
  const ToolPath path = simulated_path(arguments.path, settings.kind);
  Mat4 T_robot_sim = registration(arguments.transform, console);
  TriMesh measured = read_cloud(arguments.surface);
  if (!arguments.camera.empty()) {
    const Mat4 T_robot_camera = rigid_transform_in(read_json(arguments.camera), "T_robot_camera", arguments.camera);
    T_robot_sim = T_robot_camera * T_robot_sim;
    for (Vec3& p : measured.vertices) p = (T_robot_camera * p.homogeneous()).head<3>();
  }
  ProjectedPath projected;
  try {
    const MeasuredSurface surface(measured, approach_of(path, T_robot_sim));
    projected = project_path(path, T_robot_sim, surface, settings, arguments.surface);
  } catch (const InvalidArgument& error) {
    throw DataError(arguments.surface, "", without_function_name(error),
                    "a path, a transform and a surface that fit each other");
  }
  projected.path.source_sha256 = sha256_of_file(arguments.path);
  write_tool_path(output, projected.path);
  nlohmann::ordered_json result;
  result["path"] = output.string();
  result["frame"] = to_string(projected.path.frame);
  result["kind"] = to_string(projected.path.kind);
  result["closed"] = projected.path.is_closed;
  result["waypoints"] = projected.path.waypoints.size();
  result["length_mm"] = length_mm(entry_contour(projected.path));
  result["duration_s"] = duration_s(projected.path);
  result["max_gap_mm"] = projected.max_gap_mm;
  result["bridged_points"] = projected.bridged;
  result["max_shift_mm"] = projected.max_shift_mm;
  result["mean_shift_mm"] = projected.mean_shift_mm;
  result["scale"] = std::cbrt(T_robot_sim.topLeftCorner<3, 3>().determinant());
  print_result(options, result);
  return kDone;
}

}  // namespace

void add_project(Application& application) {
  auto arguments = std::make_shared<ProjectArguments>();
  CLI::App* verb = application.add_verb(
      "project", "Lay a simulated path and tumour edge onto the measured tissue, in the robot's frame",
      "incise project out/after/path.json --transform registration.json --surface cloud.ply --kind incise -o "
      "robot_path.json",
      [arguments](const CommonOptions& options) { return run(*arguments, options); });
  verb->add_option("path", arguments->path, "path.json, frame sim_stretched")->required();
  verb->add_option("--transform", arguments->transform,
                   "What `incise register` wrote: T_target_source, from the simulation to the surface's frame")
      ->required();
  verb->add_option("--surface", arguments->surface, "The measured tissue: cloud or mesh (.ply, .vtp, .stl, .obj), mm")
      ->required();
  verb->add_option(
      "--camera", arguments->camera,
      "JSON with T_robot_camera, where the surface is given in a camera's frame; without it: in the robot's");
  verb->add_option("--kind", arguments->kind, "incise: the path; mark: the tumour edge, 1 mm deep at 2 mm/s")
      ->check(CLI::IsMember({"incise", "mark"}));
  verb->add_option("--axis", arguments->axis,
                   "Tool axis: as the path has it, or against the measured surface's normal (a mark's: the mean axis)")
      ->check(CLI::IsMember({"path", "normal"}));
  verb->add_option("--depth-mm", arguments->depth_mm,
                   "Below the surface; 0: 1 mm for a mark, as the path says for an incision")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--speed-mm-s", arguments->speed_mm_s,
                   "Of the tip; 0: 2 mm/s for a mark, as the path says for an incision")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--max-gap-mm", arguments->settings.max_gap_mm,
                   "Farthest from a waypoint to the nearest measured point")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--max-shift-mm", arguments->settings.max_shift_mm,
                   "Farthest that a point is moved onto the surface")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--waypoints", arguments->settings.mark_waypoints, "Of a mark")->check(CLI::Range(8, 100000));
}

}  // namespace incise::cli
