#include "steps/cloud_input.hpp"

#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/core/units.hpp>
#include <incise/io/camera_scale.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/transform_json.hpp>
#include <incise/robot/checks.hpp>
#include <incise/steps/tissue_steps.hpp>
#include <incise/storage/case_run.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace incise::steps {
namespace {

constexpr std::size_t kFewestPoints = 12;

bool is_one_of(const std::filesystem::path& path, std::initializer_list<const char*> endings) {
  return std::any_of(endings.begin(), endings.end(), [&](const char* ending) { return path.extension() == ending; });
}

/// The skin of a tet mesh. `deformed.vtu` of version 0.1.0 lay at rest and said where its vertices had moved to.
TriMesh skin_of(const TetMesh& mesh, const std::filesystem::path& file) {
  TriMesh skin = boundary_surface(mesh);
  const auto moved = mesh.point_data.find("position_mm");
  if (moved == mesh.point_data.end()) return skin;
  if (moved->second.components != 3 || moved->second.values.size() != 3 * skin.vertices.size()) {
    throw DataError(file, "point array position_mm", "none that fits the mesh", "3 numbers for each vertex");
  }
  for (std::size_t i = 0; i < skin.vertices.size(); ++i)
    skin.vertices[i] = Eigen::Map<const Vec3>(moved->second.values.data() + 3 * i);
  return skin;
}

/// Returns the skin of the case's stretched specimen, made or found beside the case as for every verb. Sets `approach`
/// to the plan's.
TriMesh stretched_skin(const std::filesystem::path& case_path, const StepContext& context, Vec3& approach,
                       std::string& specimen_id) {
  CaseRun run(read_case_with_inputs(case_path), output_beside(case_path), {.until = Stage::Stretch}, context.run);
  const Study study = run.study(context.workers, context.monitor);
  if (!study.stretched || study.stretched->outcome != Outcome::Success) {
    throw DataError(case_path, "stretch", study.stretched ? explain_stretch(*study.stretched) : "none",
                    "a specimen that comes to rest");
  }
  approach = run.folder.case_file().settings.plan.approach;
  specimen_id = run.folder.specimen_id();
  TriMesh skin = boundary_surface(study.model->mesh);
  skin.vertices = study.stretched->state.positions;
  return skin;
}

/// Refuses a size that no specimen has, and a sample too dense to be intended: either would exhaust the memory.
void require_sampleable(const TriMesh& skin, double spacing_mm, const std::filesystem::path& input) {
  constexpr double kMostPoints = 5e6;
  require_body_size(bounding_box(skin.vertices), input);
  double area_mm2 = 0.0;
  for (const Triangle& triangle : skin.triangles) {
    const Vec3& p = vertex(skin.vertices, triangle[0]);
    area_mm2 += 0.5 * (vertex(skin.vertices, triangle[1]) - p).cross(vertex(skin.vertices, triangle[2]) - p).norm();
  }
  if (area_mm2 <= kMostPoints * spacing_mm * spacing_mm) return;
  throw DataError(input, "surface",
                  fmt::format("{:.3g} mm2, or {:.2g} points", area_mm2, area_mm2 / (spacing_mm * spacing_mm)),
                  fmt::format("at most {:.0e} points", kMostPoints), "A larger --spacing-mm gives fewer points");
}

nlohmann::ordered_json seen(const TriMesh& skin, const SurfaceRequest& request, const Vec3& approach, Workers& workers,
                            PointCloud& cloud) {
  require_sampleable(skin, request.view.spacing_mm, request.input);
  VisibleSurfaceSettings view = request.view;
  view.approach = approach;
  VisibleSurface surface = visible_surface(skin, view, workers);
  cloud = std::move(surface.cloud);
  return {{"points", cloud.points.size()},
          {"area_mm2", surface.area_mm2},
          {"spacing_mm", view.spacing_mm},
          {"kind", "visible_surface"}};
}

nlohmann::ordered_json cleaned(const PointCloud& raw, const SurfaceRequest& request, const Vec3& approach,
                               const StepContext& context, PointCloud& cloud) {
  CleaningSettings settings = request.cleaning;
  settings.seen_along = approach;
  Random random(context.run.seed);
  CleanedCloud result = clean_cloud(raw, settings, random, context.workers);
  cloud = std::move(result.cloud);
  nlohmann::ordered_json planes = nlohmann::ordered_json::array();
  for (const PlaneFit& plane : result.planes) {
    planes.push_back({{"normal", {plane.normal.x(), plane.normal.y(), plane.normal.z()}},
                      {"offset_mm", plane.offset_mm},
                      {"points", plane.inliers.size()}});
  }
  return {{"points", cloud.points.size()},
          {"area_mm2", sampled_area_mm2(cloud.points)},
          {"spacing_mm", spacing_mm(cloud.points)},
          {"kind", "cleaned_cloud"},
          {"points_read", raw.points.size()},
          {"cropped", result.cropped},
          {"planes", planes},
          {"beneath_planes", result.beneath_planes},
          {"outliers", result.outliers}};
}

/// Removes a camera's scale from its cloud, by a plane whose height in the robot's frame is known: all lengths from the
/// camera's origin, including the distance to the plane, are too long by the same factor.
nlohmann::ordered_json take_plane_scale(PointCloud& cloud, const nlohmann::ordered_json& planes,
                                        const SurfaceRequest& request, Monitor& monitor) {
  constexpr double kLargestTiltDeg = 3.0;
  const Mat4 T = rigid_transform_in(read_json(request.camera), "T_robot_camera", request.camera);
  if (planes.empty()) {
    throw DataError(request.input, "planes", "none", "the plane whose height --plane-z-mm gives",
                    "Is it within the box, and is --planes at least 1?");
  }
  const nlohmann::ordered_json& plane = planes.front();
  const Vec3 normal(plane["normal"][0].get<double>(), plane["normal"][1].get<double>(),
                    plane["normal"][2].get<double>());
  const double tilt_deg =
      units::deg_from_rad(std::acos(std::min(1.0, std::abs((T.topLeftCorner<3, 3>() * normal).z()))));
  const double found_mm = std::abs(plane["offset_mm"].get<double>());
  const double true_mm = std::abs(T(2, 3) - *request.plane_z_mm);
  const double scale = found_mm / true_mm;
  if (!(scale > kLeastCameraScale && scale < kMostCameraScale) || tilt_deg > kLargestTiltDeg) {
    throw DataError(request.input, "the largest plane",
                    fmt::format("{:.2f} mm from the camera and {:.2f} degrees from level", found_mm, tilt_deg),
                    fmt::format("{:.2f} mm and level, as T_robot_camera and --plane-z-mm say", true_mm),
                    "Another plane may be larger, or the camera's pose may be wrong.");
  }
  const CheckSettings checks;  // limits that export will apply
  if (!(scale > checks.min_scale && scale < checks.max_scale)) {
    monitor.message(Severity::Warning,
                    fmt::format("the camera's scale is {:.4f}, expected {} to {}: the camera is metric. Check "
                                "--plane-z-mm; export will refuse a path based on this scale (registration_scale)",
                                scale, checks.min_scale, checks.max_scale));
  }
  for (Vec3& p : cloud.points) p /= scale;
  return {{"camera_scale", scale}, {"plane_tilt_deg", tilt_deg}};
}

/// Makes the cloud of any kind of input. @returns its summary.
nlohmann::ordered_json cloud_of_input(const SurfaceRequest& request, const StepContext& context, PointCloud& cloud,
                                      std::string& specimen_id, bool& is_virtual) {
  const std::filesystem::path& input = request.input;
  const Vec3 approach = request.approach.value_or(-Vec3::UnitZ());
  if (std::filesystem::is_directory(input) || is_one_of(input, {".yaml", ".yml", ".json"})) {
    Vec3 of_case;
    const TriMesh skin = stretched_skin(input, context, of_case, specimen_id);
    return seen(skin, request, request.approach.value_or(of_case), context.workers, cloud);
  }
  if (is_one_of(input, {".vtu", ".vtk", ".msh", ".node", ".ele"}))
    return seen(skin_of(read_tet_mesh(input, context.monitor), input), request, approach, context.workers, cloud);
  const TriMesh read = read_cloud(input);
  is_virtual = is_marked_virtual(read);
  require_surface(read.vertices, input);
  nlohmann::ordered_json result = read.triangles.empty() ? cleaned(cloud_of(read), request, approach, context, cloud)
                                                         : seen(read, request, approach, context.workers, cloud);
  if (!request.plane_z_mm) return result;
  if (!read.triangles.empty())
    throw CaseError("command line", "--plane-z-mm", "a surface with triangles", "a camera's cloud");
  result.update(take_plane_scale(cloud, result["planes"], request, context.monitor));
  result["area_mm2"] = sampled_area_mm2(cloud.points);
  result["spacing_mm"] = spacing_mm(cloud.points);
  return result;
}

}  // namespace

StepResult see_surface(const SurfaceRequest& request, const StepContext& context) {
  PointCloud cloud;
  std::string specimen_id = specimen_id_of(request.input);
  bool is_virtual = false;
  StepResult result{cloud_of_input(request, context, cloud, specimen_id, is_virtual)};
  if (cloud.points.size() < kFewestPoints) {
    throw DataError(request.input, "surface", fmt::format("{} points left", cloud.points.size()),
                    fmt::format("at least {}", kFewestPoints), "Check the approach, the box and the planes");
  }
  require_surface(cloud.points, request.input);
  TriMesh made = mesh_of(cloud);
  if (is_virtual) made.point_data[kVirtualMark] = {1, std::vector<double>(made.vertices.size(), 1.0)};
  if (request.output.extension() == ".vtp") {
    write_vtp(request.output, made);
  } else if (request.plane_z_mm) {
    write_ply_at_true_size(request.output, made, result.json["camera_scale"].get<double>(), specimen_id);
  } else {
    write_ply(request.output, made, specimen_id);
  }
  result.json["specimen_id"] =
      specimen_id.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(specimen_id);
  result.json["surface"] = request.output.string();
  return result;
}

}  // namespace incise::steps
