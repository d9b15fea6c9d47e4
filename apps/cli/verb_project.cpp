#include "option_checks.hpp"
#include "options.hpp"
#include "registration_trust.hpp"
#include "verdict_gate.hpp"

#include <incise/core/error.hpp>
#include <incise/core/problem_text.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/described_json.hpp>
#include <incise/io/input_file.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/transform_json.hpp>
#include <incise/planning/project_path.hpp>
#include <incise/robot/checks.hpp>
#include <incise/robot/program_verdict.hpp>
#include <incise/storage/registration_json.hpp>

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

namespace incise::cli {
namespace {

constexpr double kTipMm = 0.3;  // what an uncertain scale may move the tip by before a person is told; the path is
                                // worth nothing from the clinical cut-off on

struct ProjectArguments {
  std::filesystem::path path;
  std::filesystem::path transform;
  std::filesystem::path surface;
  std::filesystem::path camera;
  std::string kind = "incise";
  std::string axis = "path";
  std::string metric = "ct";
  std::vector<double> scale_center;
  double depth_mm = 0.0;
  double speed_mm_s = 0.0;
  ProjectSettings settings;
};

/// What `register` wrote. A search that did not end well is no ground for moving a robot.
RegistrationRecord trusted_registration(const std::filesystem::path& file, Console& console) {
  RegistrationRecord record = read_registration(file);
  if (!record.is_converged.value_or(false) || !record.T_target_source) {
    throw DataError(file, record.T_target_source ? "/converged" : "/T_target_source",
                    !record.T_target_source ? "null"
                    : record.is_converged   ? "false"
                                            : "nothing",
                    "a registration that converged",
                    "Register again: with more starts, or with the cloud cropped to the tissue.");
  }
  require_clouds_unchanged(record, file, console);
  const double scale = record.scale * record.camera_scale;
  const CheckSettings checks;  // what export will hold it to
  if (!(scale > checks.min_scale && scale < checks.max_scale)) {
    console.message(Severity::Warning,
                    fmt::format("{}: the scale is {:.4f}; both sensors are metric, so that {} to {} is expected",
                                file.string(), scale, checks.min_scale, checks.max_scale));
  }
  return record;
}

/// Simulation and measured tissue in the robot's frame, and what became of the scale between them.
struct Placement {
  Mat4 T_robot_sim;
  TriMesh measured;
  nlohmann::ordered_json summary;
};

void move(TriMesh& mesh, const Mat4& T) {
  for (Vec3& p : mesh.vertices) p = (T * p.homogeneous()).head<3>();
}

Vec3 middle_of(const ToolPath& path, const Mat4& T) {
  Vec3 sum = Vec3::Zero();
  for (const Waypoint& w : path.waypoints) sum += w.position_mm;
  return (T * (sum / static_cast<double>(path.waypoints.size())).homogeneous()).head<3>();
}

/// Takes the fitted scale out of the camera's lengths. What stands still is told by the user, or the camera's origin,
/// or, where no one knows it, the middle of the path.
void take_true_size(Placement& placement, const ToolPath& path, const RegistrationRecord& registration,
                    const ProjectArguments& arguments, const std::optional<Vec3>& camera_mm, Console& console) {
  const Vec3 middle = middle_of(path, placement.T_robot_sim);
  const bool is_given = !arguments.scale_center.empty();
  const Vec3 center = is_given ? Vec3(arguments.scale_center.data()) : camera_mm.value_or(middle);
  const Mat4 shrink = at_true_size(registration.scale, center);
  placement.T_robot_sim = shrink * placement.T_robot_sim;
  move(placement.measured, shrink);
  const double arm_mm = (middle - center).norm();
  const double shift_mm = ((shrink * middle.homogeneous()).head<3>() - middle).norm();
  placement.summary["scale_center_mm"] = {center.x(), center.y(), center.z()};
  placement.summary["scale_center"] = is_given ? "given" : camera_mm ? "camera" : "path";
  placement.summary["scale_shift_mm"] = shift_mm;
  placement.summary["scale_shift_sd_mm"] = nullptr;
  if (!registration.scale_sd) return;
  const double sd_mm = *registration.scale_sd * arm_mm;
  placement.summary["scale_shift_sd_mm"] = sd_mm;
  const double largest_sd_mm = CheckSettings{}.close_margin_mm;
  if (sd_mm > largest_sd_mm) {
    throw DataError(arguments.transform, "/certificate/scale_sd",
                    fmt::format("{:.4f}, which is {:.2f} mm at {:.0f} mm from where lengths are right",
                                *registration.scale_sd, sd_mm, arm_mm),
                    fmt::format("at most {} mm", largest_sd_mm),
                    "Hold the scale by a known length (register --scale K,K), or name a place near the tissue whose "
                    "position the robot has confirmed (--scale-center)");
  }
  if (sd_mm > kTipMm) {
    console.message(
        Severity::Warning,
        fmt::format("the scale of {:.4f} is uncertain by {:.4f}, which is {:.2f} mm at {:.0f} mm from where "
                    "lengths are right: hold it by a known length (register --scale K,K), or name a place "
                    "near the tissue whose position the robot has confirmed (--scale-center)",
                    registration.scale, *registration.scale_sd, sd_mm, arm_mm));
  }
}

Placement placed(const ToolPath& path, const RegistrationRecord& registration, const ProjectArguments& arguments,
                 Console& console) {
  Placement placement{*registration.T_target_source, read_cloud(arguments.surface), {}};
  std::optional<Vec3> camera_mm;
  if (!arguments.camera.empty()) {
    const Mat4 T_robot_camera = rigid_transform_in(read_json(arguments.camera), "T_robot_camera", arguments.camera);
    placement.T_robot_sim = T_robot_camera * placement.T_robot_sim;
    move(placement.measured, T_robot_camera);
    camera_mm = T_robot_camera.topRightCorner<3, 1>();
  }
  placement.summary["metric"] = arguments.metric;
  placement.summary["scale"] = registration.scale;
  placement.summary["camera_scale"] = registration.camera_scale;
  if (arguments.metric == "ct") take_true_size(placement, path, registration, arguments, camera_mm, console);
  return placement;
}

ProjectSettings settings_of(const ProjectArguments& arguments) {
  ProjectSettings settings = arguments.settings;
  settings.kind = value_named<PathKind>(arguments.kind);
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

ToolPath simulated_path(const std::filesystem::path& file, const std::filesystem::path& registration,
                        const std::filesystem::path& surface, PathKind kind) {
  ToolPath path = read_tool_path(file);
  for (const std::filesystem::path& other : {registration, surface})
    require_same_specimen(other, path.specimen_id, "the path's");
  if (path.frame != PathFrame::SimStretched) {
    throw DataError(file, "frame", std::string(to_string(path.frame)), "sim_stretched",
                    "The camera sees the stretched tissue: only a path on it can be laid down.");
  }
  require_tumor_size(path, file);
  if (kind == PathKind::Mark && path.tumor_edge.points.size() < 3) {
    throw DataError(file, "tumor_edge", fmt::format("{} points", path.tumor_edge.points.size()),
                    "the edge that is to be marked");
  }
  return path;
}

ProjectedPath laid_down(const ToolPath& path, const Placement& placement, const ProjectSettings& settings,
                        const ProjectArguments& arguments) {
  try {
    const MeasuredSurface surface(placement.measured, approach_of(path, placement.T_robot_sim));
    ProjectedPath projected = project_path(path, placement.T_robot_sim, surface, settings, arguments.surface);
    projected.path.source_sha256 = sha256_of_file(arguments.path);
    return projected;
  } catch (const InvalidArgument& error) {
    throw fault_of_file(arguments.surface, "", error, "a path, a transform and a surface that fit each other");
  }
}

/// What `export` would refuse, told where the path is made.
void warn_of_unsafe(const ToolPath& path, nlohmann::ordered_json& result, Console& console) {
  const CheckSettings limits;
  result["max_step_mm"] = nullptr;
  if (path.is_closed) {
    const WaypointGap gap = widest_gap(path, limits);
    result["max_step_mm"] = gap.longest_mm;
    if (gap.longest_mm > gap.limit_mm) {
      console.message(Severity::Warning,
                      fmt::format("the ring has a gap: {:.2f} mm from waypoint {} to the next, at most {:.2f} mm is "
                                  "expected; export will refuse it (gap)",
                                  gap.longest_mm, gap.after, gap.limit_mm));
    }
  }
  const auto steepest =
      std::ranges::max_element(path.waypoints, {}, [](const Waypoint& w) { return tilt_deg(w.axis); });
  const double steepest_deg = tilt_deg(steepest->axis);
  result["max_tilt_deg"] = steepest_deg;
  if (steepest_deg > limits.max_tilt_deg) {
    console.message(Severity::Warning,
                    fmt::format("the tool leans {:.0f} degrees from straight down at waypoint {}, at most {:.0f} are "
                                "expected: are the axes, the transform and the camera's pose right? export will refuse "
                                "it (tilt)",
                                steepest_deg, steepest - path.waypoints.begin(), limits.max_tilt_deg));
  }
}

nlohmann::ordered_json settings_json(const ProjectArguments& arguments, const ProjectSettings& s) {
  const auto if_given = [](const std::optional<double>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
  };
  return {{"kind", arguments.kind},
          {"axis", arguments.axis},
          {"metric", arguments.metric},
          {"scale_center_mm", arguments.scale_center.empty() ? nlohmann::ordered_json(nullptr)
                                                             : nlohmann::ordered_json(arguments.scale_center)},
          {"mark_depth_mm", s.mark_depth_mm},
          {"mark_speed_mm_s", s.mark_speed_mm_s},
          {"mark_waypoints", s.mark_waypoints},
          {"incise_depth_mm", if_given(s.incise_depth_mm)},
          {"incise_speed_mm_s", if_given(s.incise_speed_mm_s)},
          {"smoothing_mm", s.smoothing_mm},
          {"max_gap_mm", s.max_gap_mm},
          {"max_shift_mm", s.max_shift_mm}};
}

/// What was not simulated as it is laid down.
void hold_changes(Verdict& verdict, const RegistrationRecord& registration, const ProjectArguments& arguments,
                  const ProjectSettings& settings) {
  constexpr double kSameSize = 1e-4;  // relative: 0.01 mm of a path of 100 mm
  if (settings.incise_depth_mm || settings.incise_speed_mm_s)
    verdict.add("not_simulated", {}, "the path was projected with another depth or speed than its simulated cut had");
  if (settings.axis_mode == AxisMode::SurfaceNormal) {
    verdict.add("not_simulated", {},
                "the tool was turned to the normals of the measured surface (--axis normal): the simulated cut held it "
                "otherwise");
  }
  if (arguments.metric == "camera" && std::abs(registration.scale - 1.0) > kSameSize) {
    verdict.add("not_simulated", {},
                fmt::format("the path took the camera's size (--metric camera): its lengths are {:.4f} times those of "
                            "its simulated cut",
                            registration.scale));
  }
}

/// That of the simulated path goes with the projected one, as long as it is cut as it was simulated. A mark cuts
/// nothing: what speaks against its place remains.
Verdict verdict_of(const RegistrationRecord& registration, const ProjectArguments& arguments,
                   const ProjectSettings& settings) {
  Verdict verdict = read_path_verdict(arguments.path);
  if (settings.kind == PathKind::Incise) hold_changes(verdict, registration, arguments, settings);
  if (settings.kind == PathKind::Mark) verdict = as_verdict_of_mark(verdict);
  verdict.add(cli::verdict_of(registration, arguments.transform));
  if (!registration.target_sha256.empty() && registration.target_sha256 != sha256_of_input(arguments.surface)) {
    verdict.add(
        "registration", {},
        fmt::format("{} was found on another cloud than {}", arguments.transform.string(), arguments.surface.string()));
  }
  return verdict;
}

/// A folder with path, tissue and manifest, or the path as one file with its manifest beside it.
void write(const std::filesystem::path& output, const ProjectedPath& projected, const Verdict& verdict,
           const Placement& placement, const Manifest& manifest, nlohmann::ordered_json& result) {
  if (output.extension() == ".json") {
    write_tool_path(output, projected.path, verdict);
    write_manifest_beside(output, manifest);
    result["path"] = output.string();
    return;
  }
  AtomicFolder folder(output);
  write_tool_path(folder.path() / "path.json", projected.path, verdict);
  write_ply(folder.path() / "surface.ply", placement.measured, projected.path.specimen_id);
  write_manifest(folder.path(), manifest);
  folder.commit();
  result["path"] = (output / "path.json").string();
  result["surface"] = (output / "surface.ply").string();
}

int run(const ProjectArguments& arguments, const CommonOptions& options) {
  Console console(options.level());
  const std::filesystem::path output = options.required_output("projected");
  refuse_input_as_output("-o", output, {arguments.path, arguments.transform, arguments.surface, arguments.camera});
  OlderOutput older(output, console);
  output.extension() == ".json" ? require_writable(output) : require_replaceable(output);
  if (arguments.metric == "camera" && !arguments.scale_center.empty()) {
    throw CaseError("command line", "--scale-center", "--metric camera", "--metric ct: else nothing is scaled");
  }
  const ProjectSettings settings = settings_of(arguments);
  const ToolPath path = simulated_path(arguments.path, arguments.transform, arguments.surface, settings.kind);
  const RegistrationRecord registration = trusted_registration(arguments.transform, console);
  const Placement placement = placed(path, registration, arguments, console);
  const ProjectedPath projected = laid_down(path, placement, settings, arguments);
  nlohmann::ordered_json result;
  result["path"] = nullptr;
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
  result["shift_noise_mm"] = projected.shift_noise_mm;
  result.update(placement.summary);
  warn_of_unsafe(projected.path, result, console);
  const std::vector<std::filesystem::path> inputs{arguments.path, arguments.transform, arguments.surface,
                                                  arguments.camera};
  const double wall_s = options.wall_s();
  const Verdict verdict = verdict_of(registration, arguments, settings);
  tell(verdict, console);
  result["verdict"] = to_json(verdict);
  write(output, projected, verdict, placement,
        manifest_of(options, settings_json(arguments, settings).dump(), inputs, wall_s), result);
  older.replaced();
  result["wall_s"] = wall_s;
  print_result(options, result);
  return kDone;
}

}  // namespace

void add_project(Application& application) {
  auto [verb, a] = application.add_verb<ProjectArguments>(
      "project", "",
      "incise project scene/path.json --transform registration/registration.json --surface tissue.ply --camera "
      "scene/camera.json -o projected",
      run);
  verb->add_option("path", a.path, "path.json, frame sim_stretched")->required();
  verb->add_option("--transform", a.transform,
                   "What `incise register` wrote: T_target_source, from the simulation to the surface's frame")
      ->required();
  verb->add_option("--surface", a.surface, "The measured tissue: cloud or mesh (.ply, .vtp, .stl, .obj), mm")
      ->required();
  verb->add_option(
      "--camera", a.camera,
      "JSON with T_robot_camera, where the surface is given in a camera's frame; without it: in the robot's");
  verb->add_option("--metric", a.metric,
                   "Whose lengths are true. ct: the scale that register fitted is taken out of the cloud, so that the "
                   "simulation keeps its size; camera: the simulation takes the cloud's size")
      ->check(CLI::IsMember({"ct", "camera"}));
  verb->add_option(
          "--scale-center", a.scale_center,
          "ct: a place (mm, robot's frame) where the cloud is right; else the camera's origin (--camera), else "
          "the middle of the path")
      ->expected(3);
  verb->add_option("--kind", a.kind, "incise: the path; mark: the tumour edge, 1 mm deep at 2 mm/s")
      ->check(name_of_any<PathKind>());
  verb->add_option("--axis", a.axis,
                   "Tool axis: as the path has it, or against the measured surface's normal (a mark's: the mean axis)")
      ->check(CLI::IsMember({"path", "normal"}));
  verb->add_option("--depth-mm", a.depth_mm, "Below the surface; 0: 1 mm for a mark, as the path says for an incision")
      ->check(zero_or_more("--depth-mm"));
  verb->add_option("--speed-mm-s", a.speed_mm_s, "Of the tip; 0: 2 mm/s for a mark, as the path says for an incision")
      ->check(zero_or_more("--speed-mm-s"));
  verb->add_option("--max-gap-mm", a.settings.max_gap_mm, "Farthest from a waypoint to the nearest measured point")
      ->check(zero_or_more("--max-gap-mm"));
  verb->add_option("--smoothing-mm", a.settings.smoothing_mm,
                   "Radius over which the shift onto the surface is averaged; 0: every point by itself")
      ->check(CLI::Range(0.0, 100.0));
  verb->add_option("--max-shift-mm", a.settings.max_shift_mm, "Farthest that a point is moved onto the surface")
      ->check(zero_or_more("--max-shift-mm"));
  verb->add_option("--waypoints", a.settings.mark_waypoints, "Of a mark")->check(CLI::Range(8, 2000));
}

}  // namespace incise::cli
