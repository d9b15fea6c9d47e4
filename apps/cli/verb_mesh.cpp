#include "option_checks.hpp"
#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/meshing/mesher.hpp>
#include <incise/steps/tissue_steps.hpp>

#include <fmt/format.h>

namespace incise::cli {
namespace {

int run_mesh(steps::MeshRequest request, const CommonOptions& options) {
  request.output = options.required_output("tongue.vtu");
  refuse_input_as_output("-o", request.output, {request.input, request.around});
  if (request.tets > 0 && request.tets < kFewestTets) {
    throw CaseError("command line", "--tets", fmt::format("{}", request.tets),
                    fmt::format("0, or at least {}", kFewestTets));
  }
  if (request.around.empty() && request.fine_mm) {
    throw CaseError("command line", "--fine-mm", "no --around", "a planned cut around which to refine the mesh",
                    "Without it, edges are at most --coarse-mm long");
  }
  if (request.output.extension() != ".vtu") {
    throw CaseError("command line", "-o", request.output.string(), "a file that ends in .vtu");
  }
  return run_step(options, [&](const auto& context) { return steps::mesh_body(request, context); });
}

}  // namespace

void add_mesh(Application& application) {
  auto [verb, a] = application.add_verb<steps::MeshRequest>(
      "mesh", "", "incise mesh labels.nrrd --around path.csv --fine-mm 0.8 --coarse-mm 4 -o tongue.vtu", run_mesh);
  verb->add_option("input", a.input,
                   "Labels (.nrrd/.nhdr, .nii[.gz], .mhd/.mha) or closed surface (.stl, .ply, .obj, .vtp)")
      ->required();
  verb->add_option("--around", a.around,
                   "Planned cut on the surface (.csv, .vtp, .mrk.json), around which the mesh is fine");
  verb->add_option("--fine-mm", a.fine_mm,
                   "Edge length around the cut; by default 0.8, proportionally less for a body shorter than 40 mm")
      ->check(CLI::Range(0.05, 50.0));
  verb->add_option("--coarse-mm", a.coarse_mm,
                   "Longest edge length; by default 4, proportionally less for a body shorter than 40 mm")
      ->check(CLI::Range(0.05, 100.0));
  verb->add_option("--depth-mm", a.depth_mm, "Depth of the cut")->check(CLI::Range(0.1, 100.0));
  verb->add_option("--tets", a.tets, "Number of tets to aim for; 0: as many as the lengths give")
      ->check(whole_between("--tets", 0, 5000000));
}

}  // namespace incise::cli
