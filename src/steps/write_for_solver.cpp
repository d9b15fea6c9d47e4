#include <incise/core/version.hpp>
#include <incise/interchange/interchange.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/steps/case_steps.hpp>
#include <incise/workflow/material_sources.hpp>

#include <fmt/format.h>

namespace incise::steps {
namespace {

/// Returns the held specimen: on the case's own mesh, or on the mesh that its run makes from the CT.
std::shared_ptr<const TissueModel> specimen_of(const CaseFile& file, const StepContext& context) {
  if (!file.inputs.specimen_mesh.empty()) {
    TetMesh mesh = read_specimen_mesh(file, context.monitor);
    if (!file.inputs.elasticity_map.empty() || file.settings.variation.tumor_modulus_kpa) {
      RunFolder inputs(file, output_beside(file.file), context.run);
      lay_on_mesh(file.settings, read_material_sources(file.settings, inputs, context.monitor), mesh);
    }
    return std::make_shared<TissueModel>(tissue_of(file.settings, std::move(mesh)));
  }
  CaseRun run(file, output_beside(file.file), {.until = Stage::Mesh}, context.run);
  return run.study(context.workers, context.monitor).model;
}

}  // namespace

StepResult write_for_solver(const CaseFile& file, InterchangeFormat format, const std::filesystem::path& output,
                            const StepContext& context) {
  require_replaceable(output);
  const bool is_sofa = format == InterchangeFormat::Sofa;
  const char* name = is_sofa ? "case.scn" : "case.feb";
  std::shared_ptr<const TissueModel> model;
  AtomicFolder target(output);
  try {
    model = specimen_of(file, context);
    const InterchangeCase specimen{
        *model, file.settings.gravity_mm_s2, file.settings.title,
        fmt::format("Written by incise {} ({}) from {}", version(), source_commit(), file.file.string())};
    write_atomically(target.path() / name, is_sofa ? sofa_scene_xml(specimen) : febio_input_xml(specimen));
  } catch (const CaseError& error) {
    throw error.in_file(file.file.string());
  }
  const double wall_s = context.wall_s();
  RunFolder(file, target.path(), context.run).write_manifest_to(target.path(), wall_s);
  target.commit();
  return {{{"format", to_string(format)},
           {"files", {(output / name).string()}},
           {"vertices", model->mesh.vertices.size()},
           {"tets", model->mesh.tets.size()},
           {"wall_s", wall_s}}};
}

}  // namespace incise::steps
