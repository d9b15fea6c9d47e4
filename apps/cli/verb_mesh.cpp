#include "option_checks.hpp"
#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/core/problem_text.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/volume_io.hpp>
#include <incise/meshing/mesher.hpp>
#include <incise/storage/own_files.hpp>
#include <incise/storage/result_json.hpp>

#include <fmt/format.h>

#include <functional>
#include <optional>

namespace incise::cli {
namespace {

struct MeshArguments {
  std::filesystem::path input;
  std::filesystem::path around;
  std::optional<double> fine_mm;
  std::optional<double> coarse_mm;
  double depth_mm = 5.0;
  int tets = 0;
};

bool is_surface(const std::filesystem::path& path) {
  const std::string ending = path.extension().string();
  return ending == ".stl" || ending == ".ply" || ending == ".obj" || ending == ".vtp";
}

/// Edge lengths for a body whose longest side is this long, mm.
using SizingFor = std::function<SizingField(double)>;

/// Whatever the mesher requires of its input, it came from the file and the lengths.
MeshingResult meshed(const std::filesystem::path& input, const SizingFor& sizing, const MeshingSettings& settings,
                     Monitor& monitor) {
  try {
    if (!is_surface(input)) {
      const LabelVolume labels = read_labels(input);
      return mesh_labels(labels, sizing(longest_side_mm(labels)), settings, monitor);
    }
    const TriMesh surface = read_surface(input);
    require_closed_manifold(surface, input);
    const Box3 box = bounding_box(surface.vertices);
    require_body_size(box, input);
    return mesh_surface(surface, sizing(box.sizes().maxCoeff()), settings, monitor);
  } catch (const InvalidArgument& error) {
    throw fault_of_file(input, "", error, "a body that can be meshed with these lengths");
  }
}

int run(const MeshArguments& arguments, const CommonOptions& options) {
  Console console(options.level());
  const std::filesystem::path output = options.required_output("tongue.vtu");
  refuse_input_as_output("-o", output, {arguments.input, arguments.around});
  require_own_manifest_beside(output);
  MeshingSettings settings;
  if (arguments.tets > 0 && arguments.tets < kFewestTets) {
    throw CaseError("command line", "--tets", fmt::format("{}", arguments.tets),
                    fmt::format("0, or {} and more", kFewestTets));
  }
  if (arguments.around.empty() && arguments.fine_mm) {
    throw CaseError("command line", "--fine-mm", "no --around", "a planned cut to be fine around",
                    "Edges are at most --coarse-mm without it");
  }
  if (output.extension() != ".vtu") {
    throw CaseError("command line", "-o", output.string(), "a file that ends in .vtu");
  }
  if (arguments.tets > 0) settings.target_tets = arguments.tets;
  const auto require_order = [](double fine_mm, double coarse_mm) {
    if (fine_mm <= coarse_mm) return;
    throw CaseError("command line", "--fine-mm", fmt::format("{:.3g} mm", fine_mm),
                    fmt::format("at most --coarse-mm = {:.3g} mm", coarse_mm));
  };
  if (arguments.fine_mm && arguments.coarse_mm) require_order(*arguments.fine_mm, *arguments.coarse_mm);
  PlannedCut cut;
  if (!arguments.around.empty()) cut.path = read_contour(arguments.around, true);
  cut.depth_mm = arguments.depth_mm;
  const auto sizing = [&](double longest_mm) {
    SizingSettings sizes = default_lengths(longest_mm);
    sizes.fine_mm = arguments.fine_mm.value_or(sizes.fine_mm);
    sizes.coarse_mm = arguments.coarse_mm.value_or(sizes.coarse_mm);
    if (arguments.around.empty()) return SizingField::uniform(sizes.coarse_mm);
    require_order(sizes.fine_mm, sizes.coarse_mm);
    return SizingField::around_cut(cut, sizes);
  };
  const MeshingResult made = meshed(arguments.input, sizing, settings, console);
  const nlohmann::json chosen{
      {"around", arguments.around.string()}, {"depth_mm", arguments.depth_mm}, {"tets", arguments.tets}};
  const Manifest manifest = manifest_of(options, chosen.dump(), {arguments.input, arguments.around}, options.wall_s());
  write_vtu(output, made.mesh);
  write_manifest_beside(output, manifest);
  if (!options.quiet) console.message(Severity::Detail, to_text(made.quality));
  nlohmann::ordered_json result = to_json(made);
  result["mesh"] = output.string();
  print_result(options, result);
  return made.meets_quality && made.meets_volume ? kDone : kNotAcceptable;
}

}  // namespace

void add_mesh(Application& application) {
  auto [verb, a] = application.add_verb<MeshArguments>(
      "mesh", "", "incise mesh labels.nrrd --around path.csv --fine-mm 0.8 --coarse-mm 4 -o tongue.vtu", run);
  verb->add_option("input", a.input, "Labels (.nrrd, .nii[.gz], .mhd/.mha) or closed surface (.stl, .ply, .obj, .vtp)")
      ->required();
  verb->add_option("--around", a.around, "Planned cut on the surface (.csv, .vtp, .mrk.json): fine there");
  verb->add_option("--fine-mm", a.fine_mm,
                   "Edge length around the cut; by default 0.8, in proportion for a body shorter than 40 mm")
      ->check(CLI::Range(0.05, 50.0));
  verb->add_option("--coarse-mm", a.coarse_mm,
                   "Longest edge length; by default 4, in proportion for a body shorter than 40 mm")
      ->check(CLI::Range(0.05, 100.0));
  verb->add_option("--depth-mm", a.depth_mm, "Depth of the cut")->check(CLI::Range(0.1, 100.0));
  verb->add_option("--tets", a.tets, "Count to aim for; 0: as the lengths give")->check(CLI::Range(0, 5000000));
}

}  // namespace incise::cli
