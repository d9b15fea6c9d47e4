#include "described_options.hpp"
#include "option_checks.hpp"
#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/steps/tissue_steps.hpp>

namespace incise::cli {
namespace {

struct SurfaceArguments : steps::SurfaceRequest {
  std::vector<double> sight;
  std::vector<double> box;
};

int make_surface(const SurfaceArguments& arguments, const CommonOptions& options) {
  steps::SurfaceRequest request = arguments;
  request.output = options.required_output("surface.ply");
  if (request.plane_z_mm.has_value() != !request.camera.empty()) {
    throw CaseError("command line", request.plane_z_mm ? "--camera" : "--plane-z-mm", "nothing",
                    "both --camera and --plane-z-mm, or neither");
  }
  const bool is_vtp = request.output.extension() == ".vtp";
  if (is_vtp && request.plane_z_mm) {
    throw CaseError("command line", "-o", request.output.string(),
                    "a file that ends in .ply: it keeps the camera's scale");
  }
  if (!is_vtp && request.output.extension() != ".ply")
    throw CaseError("command line", "-o", request.output.string(), "a file that ends in .ply or .vtp");
  require_writable(request.output);
  refuse_input_as_output("-o", request.output, {request.camera});
  // A case's folder may hold the surface of its tissue.
  if (!std::filesystem::is_directory(request.input)) refuse_input_as_output("-o", request.output, {request.input});
  if (!arguments.sight.empty()) request.approach = direction_of(arguments.sight, "--approach");
  if (!arguments.box.empty()) request.cleaning.box = Box3(Vec3(arguments.box.data()), Vec3(arguments.box.data() + 3));
  require_valid(validate(request.cleaning));
  return run_step(options, [&](const auto& context) { return steps::see_surface(request, context); });
}

}  // namespace

void add_surface(Application& application) {
  auto [verb, a] = application.add_verb<SurfaceArguments>(
      "surface",
      "Sample the surface that an observer sees as an evenly spaced cloud with normals, or clean a camera's cloud",
      "incise surface scene/scan.ply --planes 1 --approach 0 0 1 --camera scene/camera.json "
      "--plane-z-mm 74 -o tissue.ply",
      make_surface);
  verb->add_option("input", a.input,
                   "Case (its stretched specimen), tet mesh (.vtu, .vtk, .msh, .node), surface with triangles, or "
                   "cloud (.ply, .vtp, .stl, .obj)")
      ->required();
  verb->add_option("--approach", a.sight, "Direction of sight; default: the case's, or 0 0 -1")->expected(3);
  verb->add_option("--spacing-mm", a.view.spacing_mm, "Mesh: least distance between two points")
      ->check(CLI::Range(0.01, 100.0));
  verb->add_option("--max-tilt-deg", a.view.largest_tilt_deg, "Mesh: greatest tilt; steeper faces are left out")
      ->check(CLI::Range(1.0, 90.0));
  verb->add_option("--box", a.box, "Cloud: box to keep, between two corners, x y z x y z")->expected(6);
  add_options_of(*verb, a.cleaning, "planes", "plane_tolerance_mm", "outlier_neighbours", "outlier_deviations",
                 "voxel_mm");
  verb->add_option("--camera", a.camera, "Cloud in a camera's frame: JSON with T_robot_camera; with --plane-z-mm");
  verb->add_option(
      "--plane-z-mm", a.plane_z_mm,
      "Height of the largest plane in the robot's frame: it gives the camera's scale, which is removed from the cloud; "
      "with --camera and --planes");
}

}  // namespace incise::cli
