#include "cloud_input.hpp"
#include "option_checks.hpp"
#include "study_run.hpp"

#include <incise/core/units.hpp>
#include <incise/geometry/visible_surface.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/camera_scale.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/transform_json.hpp>
#include <incise/robot/checks.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>

namespace incise::cli {
namespace {

struct SurfaceArguments {
  std::filesystem::path input;
  std::vector<double> approach;
  VisibleSurfaceSettings view;
  CleaningSettings cleaning;
  std::vector<double> box;
  std::filesystem::path camera;
  std::optional<double> plane_z_mm;  // of the largest plane, in the robot's frame
};

constexpr std::size_t kFewestPoints = 12;

bool is_one_of(const std::filesystem::path& path, std::initializer_list<const char*> endings) {
  return std::any_of(endings.begin(), endings.end(), [&](const char* ending) { return path.extension() == ending; });
}

/// The skin of a tet mesh: where its file says that the vertices have moved to, or at rest.
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

/// The skin of the case's stretched specimen, made or found beside the case as every verb does; the approach is the
/// plan's.
TriMesh stretched_skin(const std::filesystem::path& case_path, const CommonOptions& options, Monitor& monitor,
                       Vec3& approach, std::string& specimen_id) {
  CommonOptions of_study = options;
  of_study.output.clear();
  StudyRun run(case_path, output_of(case_path, of_study), Stage::Stretch, of_study);
  const Study study = run.study(monitor);
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

/// Refuses what no specimen is, and a sample so dense that nobody can want it: both would take all memory there is.
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
                  fmt::format("{:.3g} mm2, which are {:.2g} points", area_mm2, area_mm2 / (spacing_mm * spacing_mm)),
                  fmt::format("at most {:.0e} points", kMostPoints), "A larger --spacing-mm makes fewer");
}

nlohmann::ordered_json seen(const TriMesh& skin, const SurfaceArguments& arguments, const Vec3& approach,
                            Workers& workers, PointCloud& cloud) {
  require_sampleable(skin, arguments.view.spacing_mm, arguments.input);
  VisibleSurfaceSettings view = arguments.view;
  view.approach = approach;
  VisibleSurface surface = visible_surface(skin, view, workers);
  cloud = std::move(surface.cloud);
  return {{"points", cloud.points.size()},
          {"area_mm2", surface.area_mm2},
          {"spacing_mm", view.spacing_mm},
          {"kind", "visible_surface"}};
}

nlohmann::ordered_json cleaned(const PointCloud& raw, const SurfaceArguments& arguments, const Vec3& approach,
                               const CommonOptions& options, Workers& workers, PointCloud& cloud) {
  CleaningSettings settings = arguments.cleaning;
  settings.seen_along = approach;
  if (!arguments.box.empty()) settings.box = Box3(Vec3(arguments.box.data()), Vec3(arguments.box.data() + 3));
  require_valid(validate(settings));
  Random random(options.seed);
  CleanedCloud result = clean_cloud(raw, settings, random, workers);
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

/// A camera's scale, from a plane whose height in the robot's frame is known, is taken out of its cloud: all lengths
/// from the camera's origin, that to the plane too, are too long by the same factor.
nlohmann::ordered_json take_plane_scale(PointCloud& cloud, const nlohmann::ordered_json& planes,
                                        const SurfaceArguments& arguments, Console& console) {
  constexpr double kLargestTiltDeg = 3.0;
  const Mat4 T = rigid_transform_in(read_json(arguments.camera), "T_robot_camera", arguments.camera);
  if (planes.empty()) {
    throw DataError(arguments.input, "planes", "none", "the plane that --plane-z-mm gives the height of",
                    "Is it within the box, and is --planes at least 1?");
  }
  const nlohmann::ordered_json& plane = planes.front();
  const Vec3 normal(plane["normal"][0].get<double>(), plane["normal"][1].get<double>(),
                    plane["normal"][2].get<double>());
  const double tilt_deg =
      units::deg_from_rad(std::acos(std::min(1.0, std::abs((T.topLeftCorner<3, 3>() * normal).z()))));
  const double found_mm = std::abs(plane["offset_mm"].get<double>());
  const double true_mm = std::abs(T(2, 3) - *arguments.plane_z_mm);
  const double scale = found_mm / true_mm;
  if (!(scale > kLeastCameraScale && scale < kMostCameraScale) || tilt_deg > kLargestTiltDeg) {
    throw DataError(arguments.input, "the largest plane",
                    fmt::format("{:.2f} mm from the camera and {:.2f} degrees from level", found_mm, tilt_deg),
                    fmt::format("{:.2f} mm and level, as T_robot_camera and --plane-z-mm say", true_mm),
                    "Another plane may be larger, or the camera's pose is not this one.");
  }
  const CheckSettings checks;  // what export will hold it to
  if (!(scale > checks.min_scale && scale < checks.max_scale)) {
    console.message(Severity::Warning,
                    fmt::format("the camera's scale is {:.4f}; the camera is metric, so that {} to {} is expected: is "
                                "--plane-z-mm right? export will refuse what follows from it (registration_scale)",
                                scale, checks.min_scale, checks.max_scale));
  }
  for (Vec3& p : cloud.points) p /= scale;
  return {{"camera_scale", scale}, {"plane_tilt_deg", tilt_deg}};
}

int make_surface(const SurfaceArguments& arguments, const CommonOptions& options) {
  Console console(options.level());
  const std::filesystem::path output = options.required_output("surface.ply");
  if (arguments.plane_z_mm.has_value() != !arguments.camera.empty()) {
    throw CaseError("command line", arguments.plane_z_mm ? "--camera" : "--plane-z-mm", "nothing",
                    "both --camera and --plane-z-mm, or none");
  }
  const bool is_vtp = output.extension() == ".vtp";
  if (is_vtp && arguments.plane_z_mm)
    throw CaseError("command line", "-o", output.string(), "a file that ends in .ply: it keeps the camera's scale");
  if (!is_vtp && output.extension() != ".ply")
    throw CaseError("command line", "-o", output.string(), "a file that ends in .ply or .vtp");
  require_writable(output);
  refuse_input_as_output("-o", output, {arguments.camera});
  // A case's folder may hold the surface of its tissue.
  if (!std::filesystem::is_directory(arguments.input)) refuse_input_as_output("-o", output, {arguments.input});
  Workers workers(options.threads);
  Vec3 approach = arguments.approach.empty() ? Vec3(-Vec3::UnitZ()) : direction_of(arguments.approach, "--approach");
  PointCloud cloud;
  nlohmann::ordered_json result;
  const std::filesystem::path& input = arguments.input;
  std::string specimen_id = specimen_id_of(input);
  if (std::filesystem::is_directory(input) || is_one_of(input, {".yaml", ".yml", ".json"})) {
    Vec3 of_case;
    const TriMesh skin = stretched_skin(input, options, console, of_case, specimen_id);
    result = seen(skin, arguments, arguments.approach.empty() ? of_case : approach, workers, cloud);
  } else if (is_one_of(input, {".vtu", ".vtk", ".msh", ".node", ".ele"})) {
    result = seen(skin_of(read_tet_mesh(input, console), input), arguments, approach, workers, cloud);
  } else {
    const TriMesh read = read_cloud(input);
    require_surface(read.vertices, input);
    result = read.triangles.empty() ? cleaned(cloud_of(read), arguments, approach, options, workers, cloud)
                                    : seen(read, arguments, approach, workers, cloud);
    if (arguments.plane_z_mm) {
      if (!read.triangles.empty())
        throw CaseError("command line", "--plane-z-mm", "a surface with triangles", "a camera's cloud");
      result.update(take_plane_scale(cloud, result["planes"], arguments, console));
      result["area_mm2"] = sampled_area_mm2(cloud.points);
      result["spacing_mm"] = spacing_mm(cloud.points);
    }
  }
  if (cloud.points.size() < kFewestPoints) {
    throw DataError(input, "surface", fmt::format("{} points left", cloud.points.size()),
                    fmt::format("at least {}", kFewestPoints), "Look at the approach, the box and the planes");
  }
  require_surface(cloud.points, input);
  if (is_vtp) {
    write_vtp(output, mesh_of(cloud));
  } else if (arguments.plane_z_mm) {
    write_ply_at_true_size(output, mesh_of(cloud), result["camera_scale"].get<double>(), specimen_id);
  } else {
    write_ply(output, mesh_of(cloud), specimen_id);
  }
  result["specimen_id"] = specimen_id.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(specimen_id);
  result["surface"] = output.string();
  print_result(options, result);
  return kDone;
}

}  // namespace

void add_surface(Application& application) {
  auto [verb, a] = application.add_verb<SurfaceArguments>(
      "surface",
      "The surface that an observer sees, as an evenly sampled cloud with normals; of a camera's "
      "cloud, the cleaned part",
      "incise surface scene/scan.ply --planes 1 --approach 0 0 1 --camera scene/camera.json "
      "--plane-z-mm 74 -o tissue.ply",
      make_surface);
  verb->add_option("input", a.input,
                   "Case (its stretched specimen), tet mesh (.vtu, .vtk, .msh, .node), surface with triangles, or "
                   "cloud (.ply, .vtp, .stl, .obj)")
      ->required();
  verb->add_option("--approach", a.approach, "Direction of sight; default: the case's, or 0 0 -1")->expected(3);
  verb->add_option("--spacing-mm", a.view.spacing_mm, "Mesh: least distance between two points")
      ->check(CLI::Range(0.01, 100.0));
  verb->add_option("--max-tilt-deg", a.view.largest_tilt_deg, "Mesh: steeper faces are left out")
      ->check(CLI::Range(1.0, 90.0));
  verb->add_option("--box", a.box, "Cloud: keep what lies between two corners, x y z x y z")->expected(6);
  verb->add_option("--planes", a.cleaning.planes, "Cloud: planes (table, holder) to take away with what lies beneath")
      ->check(CLI::Range(0, 20));
  verb->add_option("--plane-tolerance-mm", a.cleaning.plane_tolerance_mm, "Cloud: thickness of a plane to either side")
      ->check(above_zero("--plane-tolerance-mm"));
  verb->add_option("--camera", a.camera, "Cloud in a camera's frame: JSON with T_robot_camera; with --plane-z-mm");
  verb->add_option(
      "--plane-z-mm", a.plane_z_mm,
      "Height of the largest plane in the robot's frame: the camera's scale follows from it and is taken out "
      "of the cloud; with --camera and --planes");
  verb->add_option("--outlier-neighbours", a.cleaning.outlier_neighbours, "Cloud: 0 keeps outliers")
      ->check(CLI::Range(0, 200));
  verb->add_option("--outlier-deviations", a.cleaning.outlier_deviations,
                   "Cloud: above the mean distance, beyond which a point goes")
      ->check(CLI::Range(0.0, 100.0));
  verb->add_option("--voxel-mm", a.cleaning.voxel_mm, "Cloud: one point per cube of this size; 0: all")
      ->check(CLI::Range(0.0, 100.0));
}

}  // namespace incise::cli
