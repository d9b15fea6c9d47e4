#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/geometry/point_cloud.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/input_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/transform_json.hpp>
#include <incise/robot/checks.hpp>
#include <incise/robot/program_verdict.hpp>
#include <incise/steps/camera_steps.hpp>
#include <incise/steps/registration_trust.hpp>

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace incise::steps {
namespace {

// Largest shift of the tip by an uncertain scale without a warning; above the clinical cut-off the path is refused.
constexpr double kTipMm = 0.3;

/// Reads a registration by which a robot may be moved: one that converged.
RegistrationRecord trusted_registration(const std::filesystem::path& file, Monitor& monitor) {
  RegistrationRecord record = read_registration(file);
  if (!record.is_converged.value_or(false) || !record.T_target_source) {
    throw DataError(file, record.T_target_source ? "/converged" : "/T_target_source",
                    !record.T_target_source ? "null"
                    : record.is_converged   ? "false"
                                            : "nothing",
                    "a registration that converged",
                    "Register again: with more starts, or with the cloud cropped to the tissue.");
  }
  require_clouds_unchanged(record, file, monitor);
  const double scale = record.scale * record.camera_scale;
  const CheckSettings checks;  // limits that export will apply
  if (!(scale > checks.min_scale && scale < checks.max_scale)) {
    monitor.message(Severity::Warning,
                    fmt::format("{}: the scale is {:.4f}, expected {} to {}: both sensors are metric", file.string(),
                                scale, checks.min_scale, checks.max_scale));
  }
  return record;
}

const char* metric_of(const ProjectRequest& request) {
  return request.takes_camera_size ? "camera" : "ct";
}

/// Simulation and measured tissue in the robot's frame, and a summary of the scale between them.
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

/// Removes the fitted scale from the camera's lengths. The fixed point is the user's, else the camera's origin, else
/// the middle of the path.
void take_true_size(Placement& placement, const ToolPath& path, const RegistrationRecord& registration,
                    const ProjectRequest& request, const std::optional<Vec3>& camera_mm, Monitor& monitor) {
  const Vec3 middle = middle_of(path, placement.T_robot_sim);
  const bool is_given = request.scale_center_mm.has_value();
  const Vec3 center = request.scale_center_mm.value_or(camera_mm.value_or(middle));
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
    throw DataError(request.transform, "/certificate/scale_sd",
                    fmt::format("{:.4f}, which is {:.2f} mm at {:.0f} mm from where lengths are right",
                                *registration.scale_sd, sd_mm, arm_mm),
                    fmt::format("at most {} mm", largest_sd_mm),
                    "Fix the scale by a known length (register --scale K,K), or name a place near the tissue whose "
                    "position the robot has confirmed (--scale-center)");
  }
  if (sd_mm > kTipMm) {
    monitor.message(
        Severity::Warning,
        fmt::format("the scale of {:.4f} is uncertain by {:.4f}, which is {:.2f} mm at {:.0f} mm from where "
                    "lengths are right: fix it by a known length (register --scale K,K), or name a place "
                    "near the tissue whose position the robot has confirmed (--scale-center)",
                    registration.scale, *registration.scale_sd, sd_mm, arm_mm));
  }
}

Placement placed(const ToolPath& path, const RegistrationRecord& registration, const ProjectRequest& request,
                 Monitor& monitor) {
  Placement placement{*registration.T_target_source, read_cloud(request.surface), {}};
  std::optional<Vec3> camera_mm;
  if (!request.camera.empty()) {
    const Mat4 T_robot_camera = rigid_transform_in(read_json(request.camera), "T_robot_camera", request.camera);
    placement.T_robot_sim = T_robot_camera * placement.T_robot_sim;
    move(placement.measured, T_robot_camera);
    camera_mm = T_robot_camera.topRightCorner<3, 1>();
  }
  placement.summary["metric"] = metric_of(request);
  placement.summary["scale"] = registration.scale;
  placement.summary["camera_scale"] = registration.camera_scale;
  if (!request.takes_camera_size) take_true_size(placement, path, registration, request, camera_mm, monitor);
  return placement;
}

ToolPath simulated_path(const std::filesystem::path& file, const std::filesystem::path& registration,
                        const std::filesystem::path& surface, PathKind kind) {
  ToolPath path = read_tool_path(file);
  for (const std::filesystem::path& other : {registration, surface})
    require_same_specimen(other, path.specimen_id, "the path's");
  if (path.frame != PathFrame::SimStretched) {
    throw DataError(file, "frame", std::string(to_string(path.frame)), "sim_stretched",
                    "The camera sees the stretched tissue: only a path on it can be projected.");
  }
  require_tumor_size(path, file);
  if (kind == PathKind::Mark && path.tumor_edge.points.size() < 3) {
    throw DataError(file, "tumor_edge", fmt::format("{} points", path.tumor_edge.points.size()),
                    "the points of the edge to be marked");
  }
  return path;
}

ProjectedPath laid_down(const ToolPath& path, const Placement& placement, const ProjectRequest& request) {
  try {
    const MeasuredSurface surface(placement.measured, approach_of(path, placement.T_robot_sim));
    ProjectedPath projected = project_path(path, placement.T_robot_sim, surface, request.settings, request.surface);
    projected.path.source_sha256 = sha256_of_file(request.path);
    projected.path.specimen_id = path.specimen_id;
    projected.path.is_virtual = path.is_virtual || is_marked_virtual(placement.measured);
    return projected;
  } catch (const InvalidArgument& error) {
    throw DataError(request.surface, "", error);
  }
}

/// Warns, where the path is made, of what `export` would refuse.
void warn_of_unsafe(const ToolPath& path, nlohmann::ordered_json& result, Monitor& monitor) {
  const CheckSettings limits;
  result["max_step_mm"] = nullptr;
  if (path.is_closed) {
    const WaypointGap gap = widest_gap(path, limits);
    result["max_step_mm"] = gap.longest_mm;
    if (gap.longest_mm > gap.limit_mm) {
      monitor.message(Severity::Warning,
                      fmt::format("the ring has a gap: {:.2f} mm from waypoint {} to the next, at most {:.2f} mm is "
                                  "expected; export will refuse the path (gap)",
                                  gap.longest_mm, gap.after, gap.limit_mm));
    }
  }
  const auto steepest =
      std::ranges::max_element(path.waypoints, {}, [](const Waypoint& w) { return tilt_deg(w.axis); });
  const double steepest_deg = tilt_deg(steepest->axis);
  result["max_tilt_deg"] = steepest_deg;
  if (steepest_deg > limits.max_tilt_deg) {
    monitor.message(Severity::Warning,
                    fmt::format("the tool leans {:.0f} degrees from straight down at waypoint {}, at most {:.0f} are "
                                "expected: check the axes, the transform and the camera's pose. export will refuse the "
                                "path (tilt)",
                                steepest_deg, steepest - path.waypoints.begin(), limits.max_tilt_deg));
  }
}

nlohmann::ordered_json settings_json(const ProjectRequest& request) {
  const ProjectSettings& s = request.settings;
  const auto if_given = [](const std::optional<double>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
  };
  nlohmann::ordered_json center;
  if (const auto& given = request.scale_center_mm) center = {given->x(), given->y(), given->z()};
  return {{"kind", to_string(s.kind)},
          {"axis", s.axis_mode == AxisMode::SurfaceNormal ? "normal" : "path"},
          {"metric", metric_of(request)},
          {"scale_center_mm", center},
          {"mark_depth_mm", s.mark_depth_mm},
          {"mark_speed_mm_s", s.mark_speed_mm_s},
          {"mark_waypoints", s.mark_waypoints},
          {"incise_depth_mm", if_given(s.incise_depth_mm)},
          {"incise_speed_mm_s", if_given(s.incise_speed_mm_s)},
          {"smoothing_mm", s.smoothing_mm},
          {"max_gap_mm", s.max_gap_mm},
          {"max_shift_mm", s.max_shift_mm}};
}

/// Adds a caution for each difference between the projected path and its simulated cut.
void hold_changes(Verdict& verdict, const RegistrationRecord& registration, const ProjectRequest& request,
                  const ProjectSettings& settings) {
  constexpr double kSameSize = 1e-4;  // relative: 0.01 mm of a path of 100 mm
  if (settings.incise_depth_mm || settings.incise_speed_mm_s)
    verdict.add("not_simulated", {},
                "the path was projected with a depth or speed other than that of its simulated cut");
  if (settings.axis_mode == AxisMode::SurfaceNormal) {
    verdict.add("not_simulated", {},
                "the tool was turned to the normals of the measured surface (--axis normal): the simulated cut held it "
                "differently");
  }
  if (request.takes_camera_size && std::abs(registration.scale - 1.0) > kSameSize) {
    verdict.add("not_simulated", {},
                fmt::format("the path was scaled to the camera's size (--metric camera): its lengths are {:.4f} times "
                            "those of its simulated cut",
                            registration.scale));
  }
}

/// The projected path keeps the verdict of the simulated one as long as it is cut as it was simulated. A mark cuts
/// nothing, so it keeps only the reasons against its position.
Verdict verdict_along(const RegistrationRecord& registration, const ProjectRequest& request) {
  const ProjectSettings& settings = request.settings;
  Verdict verdict = read_path_verdict(request.path);
  if (settings.kind == PathKind::Incise) hold_changes(verdict, registration, request, settings);
  if (settings.kind == PathKind::Mark) verdict = as_verdict_of_mark(verdict);
  verdict.add(verdict_of(registration, request.transform));
  if (!registration.target_sha256.empty() && registration.target_sha256 != sha256_of_input(request.surface)) {
    verdict.add(
        "registration", {},
        fmt::format("{} was found on another cloud, not on {}", request.transform.string(), request.surface.string()));
  }
  return verdict;
}

/// Writes a folder with path, tissue and manifest, or the path as one file with its manifest beside it.
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

}  // namespace

StepResult project_onto_tissue(const ProjectRequest& request, const StepContext& context) {
  const ToolPath path = simulated_path(request.path, request.transform, request.surface, request.settings.kind);
  const RegistrationRecord registration = trusted_registration(request.transform, context.monitor);
  const Placement placement = placed(path, registration, request, context.monitor);
  const ProjectedPath projected = laid_down(path, placement, request);
  StepResult done;
  nlohmann::ordered_json& result = done.json;
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
  warn_of_unsafe(projected.path, result, context.monitor);
  const std::vector<std::filesystem::path> inputs{request.path, request.transform, request.surface, request.camera};
  const double wall_s = context.wall_s();
  const Verdict verdict = verdict_along(registration, request);
  report_reasons(verdict, context.monitor);
  result["verdict"] = to_json(verdict);
  write(request.output, projected, verdict, placement,
        manifest_of(context.run, settings_json(request).dump(), inputs, wall_s), result);
  result["wall_s"] = wall_s;
  return done;
}

}  // namespace incise::steps
