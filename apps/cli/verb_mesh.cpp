#include "option_checks.hpp"
#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/volume_io.hpp>
#include <incise/meshing/mesher.hpp>
#include <incise/storage/result_json.hpp>

#include <fmt/format.h>

#include <memory>

namespace incise::cli {
namespace {

bool is_surface(const std::filesystem::path& path) {
  const std::string ending = path.extension().string();
  return ending == ".stl" || ending == ".ply" || ending == ".obj" || ending == ".vtp";
}

/// Whatever the mesher requires of its input, it came from the file and the lengths.
MeshingResult meshed(const std::filesystem::path& input, const SizingField& sizing, const MeshingSettings& settings, Monitor& monitor) {
  try {
    if (!is_surface(input)) return mesh_labels(read_labels(input), sizing, settings, monitor);
    const TriMesh surface = read_surface(input);
    require_closed_manifold(surface, input);
    require_body_size(bounding_box(surface.vertices), input);
    return mesh_surface(surface, sizing, settings, monitor);
  } catch (const InvalidArgument& error) {
    throw fault_of_file(input, "", error, "a body that can be meshed with these lengths");
  }
}

}  // namespace

void add_mesh(Application& application) {
  struct Arguments {
    std::filesystem::path input;
    std::filesystem::path around;
    double fine_mm = SizingSettings{}.fine_mm;
    double coarse_mm = SizingSettings{}.coarse_mm;
    double depth_mm = 5.0;
    int tets = 0;
    CLI::Option* fine_option = nullptr;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb = application.add_verb(
      "mesh", "Make a graded tetrahedral mesh from labels or a closed surface",
      "incise mesh labels.nrrd --around path.csv --fine-mm 0.8 --coarse-mm 4 -o tongue.vtu",
      [arguments](const CommonOptions& options) {
        Console console(options.level());
        const std::filesystem::path output = options.required_output("tongue.vtu");
        refuse_input_as_output("-o", output, {arguments->input, arguments->around});
        MeshingSettings settings;
        if (arguments->tets > 0 && arguments->tets < kFewestTets) {
          throw CaseError("command line", "--tets", fmt::format("{}", arguments->tets),
                          fmt::format("0, or {} and more", kFewestTets));
        }
        if (arguments->around.empty() && arguments->fine_option->count() > 0) {
          throw CaseError("command line", "--fine-mm", "no --around", "a planned cut to be fine around",
                          "Edges are at most --coarse-mm without it");
        }
        if (output.extension() != ".vtu") {
          throw CaseError("command line", "-o", output.string(), "a file that ends in .vtu");
        }
        if (arguments->tets > 0) settings.target_tets = arguments->tets;
        SizingField sizing = SizingField::uniform(arguments->coarse_mm);
        if (!arguments->around.empty()) {
          if (arguments->fine_mm > arguments->coarse_mm) {
            throw CaseError("command line", "--fine-mm", fmt::format("{} mm", arguments->fine_mm),
                            fmt::format("at most --coarse-mm = {} mm", arguments->coarse_mm));
          }
          PlannedCut cut;
          cut.path = read_contour(arguments->around, true);
          cut.depth_mm = arguments->depth_mm;
          SizingSettings sizes;
          sizes.fine_mm = arguments->fine_mm;
          sizes.coarse_mm = arguments->coarse_mm;
          sizing = SizingField::around_cut(cut, sizes);
        }
        const MeshingResult made = meshed(arguments->input, sizing, settings, console);
        write_vtu(output, made.mesh);
        if (!options.quiet) console.message(Severity::Detail, to_text(made.quality));
        nlohmann::ordered_json result = to_json(made);
        result["mesh"] = output.string();
        print_result(options, result);
        return made.meets_quality && made.meets_volume ? kDone : kNotAcceptable;
      });
  verb->add_option("input", arguments->input,
                   "Labels (.nrrd, .nii[.gz], .mhd/.mha) or closed surface (.stl, .ply, .obj, .vtp)")
      ->required();
  verb->add_option("--around", arguments->around, "Planned cut on the surface (.csv, .vtp, .mrk.json): fine there");
  arguments->fine_option =
      verb->add_option("--fine-mm", arguments->fine_mm, "Edge length around the cut")->check(CLI::Range(0.05, 50.0));
  verb->add_option("--coarse-mm", arguments->coarse_mm, "Longest edge length")->check(CLI::Range(0.05, 100.0));
  verb->add_option("--depth-mm", arguments->depth_mm, "Depth of the cut")->check(CLI::Range(0.1, 100.0));
  verb->add_option("--tets", arguments->tets, "Count to aim for; 0: as the lengths give")
      ->check(CLI::Range(0, 5000000));
}

}  // namespace incise::cli
