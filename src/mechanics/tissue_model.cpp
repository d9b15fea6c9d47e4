#include "mechanics/loads.hpp"
#include "mechanics/shape_gradients.hpp"
#include "mechanics/tet_batches.hpp"
#include "mechanics/topology.hpp"
#include "mechanics/viscous_response.hpp"

#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/mechanics/tissue.hpp>

namespace incise {
namespace {

void require_sound(const TetMesh& mesh) {
  const std::vector<MeshProblem> problems = find_problems(mesh);
  std::string text;
  for (const MeshProblem& problem : problems) text += (text.empty() ? "" : "; ") + problem.text;
  INCISE_REQUIRE(problems.empty(), "expected a sound mesh, but " + text);
}

void require_valid(const Material& material) {
  const std::vector<Problem> violations = validate(material);
  if (violations.empty()) return;
  std::string others;
  for (std::size_t i = 1; i < violations.size(); ++i) others += (i > 1 ? "; also " : "Also ") + sentence(violations[i]);
  const Problem& first = violations.front();
  throw CaseError("case", "specimen.material." + first.path, first.found, first.expected, others);
}

void require_valid(const MaterialField& field, std::size_t tets) {
  const std::vector<Problem> violations = validate(field, tets);
  std::string text;
  for (const Problem& violation : violations) text += (text.empty() ? "" : "; ") + sentence(violation);
  INCISE_REQUIRE(violations.empty(), "expected sound values for every tet, but " + text);
}

void add_elements(TissueModel& model, const MaterialField& field) {
  const std::size_t count = model.mesh.tets.size();
  model.gradients.resize(count);
  model.volumes_mm3.resize(count);
  model.lame.resize(count);
  if (model.material.fibre_modulus_kpa > 0.0) model.fibres.assign(count, model.material.fibre_direction.normalized());
  model.vertex_mass_kg.assign(model.mesh.vertices.size(), 0.0);
  const double density = units::kg_mm3_from_kg_m3(model.material.density_kg_m3);
  for (std::size_t t = 0; t < count; ++t) {
    model.lame[t] = lame_parameters(
        field.youngs_modulus_kpa.empty() ? model.material.youngs_modulus_kpa : field.youngs_modulus_kpa[t],
        field.poissons_ratio.empty() ? model.material.poissons_ratio : field.poissons_ratio[t]);
    if (!model.fibres.empty() && !field.fibre_directions.empty()) model.fibres[t] = field.fibre_directions[t].normalized();
    const ShapeGradients shape = shape_gradients(model.mesh, t);
    model.gradients[t] = shape.gradients;
    model.volumes_mm3[t] = shape.volume_mm3;
    for (const VertexId v : model.mesh.tets[t])
      model.vertex_mass_kg[v.index()] += 0.25 * density * model.volumes_mm3[t];
  }
}

}  // namespace

TissueModel make_tissue_model(TetMesh mesh, const Material& material, std::vector<Constraint> constraints,
                              const Vec3& gravity_mm_s2, const MaterialField& field) {
  require_sound(mesh);
  require_valid(material);
  require_valid(field, mesh.tets.size());
  TissueModel model;
  model.mesh = std::move(mesh);
  model.material = material;
  model.constraints = std::move(constraints);
  add_elements(model, field);
  model.toughness = field.toughness;
  apply_constraints(model, gravity_mm_s2);
  require_no_rigid_motion(model);
  add_topology(model);
  model.batches = make_tet_batches(model);
  return model;
}

TissueState rest_state(const TissueModel& model) {
  TissueState state;
  state.positions = model.mesh.vertices;
  state.rotations.assign(model.mesh.tets.size(), Mat3::Identity());
  state.is_live.assign(model.mesh.tets.size(), 1);
  state.memory = rest_memory(model.material, model.mesh.tets.size());
  return state;
}

}  // namespace incise
