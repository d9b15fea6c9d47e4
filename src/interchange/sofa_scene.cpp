#include "interchange/specimen_text.hpp"

#include <incise/core/error.hpp>
#include <incise/core/units.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace incise {
namespace {

// A damped fall into equilibrium: these settings brought the stretched block of SOFA's own reference fields to rest.
constexpr double kStepS = 0.05;
constexpr double kRampS = 1.0;       ///< time over which prescribed displacements grow
constexpr double kHeldUntilS = 1e6;  ///< SOFA releases a moved vertex after the last key
constexpr int kSteps = 200;

class SofaScene {
 public:
  explicit SofaScene(const InterchangeCase& specimen) : specimen_(specimen), model_(specimen.model) {}

  std::string text() {
    require_known_law(model_, "sofa");
    pugi::xml_document document;
    add_comments(document);
    pugi::xml_node root =
        with(document.append_child("Node"),
             {{"name", "root"}, {"dt", fmt::format("{}", kStepS)}, {"gravity", text_of(specimen_.gravity_mm_s2)}});
    root.append_child("DefaultAnimationLoop");
    pugi::xml_node tissue = with(root.append_child("Node"), {{"name", "tissue"}});
    add_solver(tissue);
    add_mesh(tissue);
    add_law(tissue);
    for (const HeldSet& held : held_sets(model_)) add_held(tissue, held);
    for (std::size_t i = 0; i < model_.constraints.size(); ++i) add_loads_and_supports(tissue, i);
    with(add(tissue, "VTKExporter", "Sofa.Component.IO.Mesh"),
         {{"filename", "sofa_result"},
          {"listening", "1"},
          {"edges", "0"},
          {"tetras", "1"},
          {"exportEveryNumberOfSteps", fmt::format("{}", kSteps)}});
    for (const std::string& name : plugins_)
      with(root.insert_child_before("RequiredPlugin", root.child("DefaultAnimationLoop")), {{"name", name}});
    return xml_text(document);
  }

 private:
  pugi::xml_node add(pugi::xml_node parent, const char* component, const char* plugin) {
    plugins_.insert(plugin);
    return parent.append_child(component);
  }

  void add_comments(pugi::xml_document& document) const {
    add_comment(document, specimen_.title);
    add_comment(document, specimen_.provenance);
    add_comment(
        document,
        "Units: mm, kg, s; so stress in kPa, force in mN, density in kg/mm3. Frame LPS. SOFA itself has no units.");
    add_comment(
        document,
        fmt::format(
            "Run: runSofa -g batch -n {} FILE. The last positions go to sofa_result*.vtu; displacement = position - "
            "position at the start. Vertices and tets are those of the incise case, in its order, from 0.",
            kSteps));
    add_comment(
        document,
        "SOFA reaches equilibrium by damped motion (implicit Euler): compare once the speeds have died down. Its "
        "StaticSolver does not converge with this force field.");
    if (model_.material.volume == VolumeTreatment::Averaged) {
      add_comment(document,
                  "DIFFERS: incise averages the change of volume about each vertex (material.volume: averaged). SOFA "
                  "has standard tets only, which lock as Poisson's ratio nears 0.5.");
    }
    if (!model_.material.prony.empty() || model_.material.kelvin_voigt_time_s > 0.0) {
      add_comment(document, "The case's viscosity is left out: equilibrium is its long-time limit.");
    }
  }

  void add_solver(pugi::xml_node tissue) {
    with(add(tissue, "EulerImplicitSolver", "Sofa.Component.ODESolver.Backward"),
         {{"rayleighStiffness", "0.1"}, {"rayleighMass", "0.1"}});
    with(add(tissue, "CGLinearSolver", "Sofa.Component.LinearSolver.Iterative"),
         {{"template", "GraphScattered"}, {"iterations", "800"}, {"tolerance", "1e-18"}, {"threshold", "1e-18"}});
  }

  void add_mesh(pugi::xml_node tissue) {
    std::string positions;
    for (const Vec3& p : model_.mesh.vertices) positions += (positions.empty() ? "" : "  ") + text_of(p);
    std::string tets;
    for (const Tet& t : model_.mesh.tets) {
      tets += fmt::format("{}{} {} {} {}", tets.empty() ? "" : "  ", t[0].value, t[1].value, t[2].value, t[3].value);
    }
    with(add(tissue, "TetrahedronSetTopologyContainer", "Sofa.Component.Topology.Container.Dynamic"),
         {{"name", "mesh"}, {"position", positions}, {"tetrahedra", tets}});
    with(tissue.append_child("TetrahedronSetGeometryAlgorithms"), {{"template", "Vec3"}});
    with(add(tissue, "MechanicalObject", "Sofa.Component.StateContainer"),
         {{"name", "state"}, {"template", "Vec3"}, {"position", "@mesh.position"}});
    with(add(tissue, "DiagonalMass", "Sofa.Component.Mass"),
         {{"massDensity", fmt::format("{}", units::kg_mm3_from_kg_m3(model_.material.density_kg_m3))},
          {"topology", "@mesh"}});
  }

  void add_law(pugi::xml_node tissue) {
    const Stiffness stiffness = stiffness_of(model_);
    if (model_.material.model == MaterialModel::StableNeoHookean) {
      if (stiffness.varies()) {
        throw CaseError(
            "case", "specimen.material.model", "stable_neo_hookean with a stiffness that varies from tet to tet",
            "one stiffness for an export as sofa", "SOFA's hyperelastic force field has one set of parameters");
      }
      add_comment(tissue,
                  "Stable Neo-Hookean as SOFA has it: without the logarithmic term of Smith, de Goes and Kim (2018), "
                  "the same at small strain. Parameters: mu, lambda.");
      with(add(tissue, "TetrahedronHyperelasticityFEMForceField", "Sofa.Component.SolidMechanics.FEM.HyperElastic"),
           {{"materialName", "StableNeoHookean"},
            {"ParameterSet", fmt::format("{} {}", model_.lame.front().mu_kpa, model_.lame.front().lambda_kpa)}});
      return;
    }
    add_comment(tissue,
                "The same law as incise: linear elasticity about the polar rotation of each tet's deformation "
                "gradient. SOFA's other corotational force fields take their rotation from edges of the tet and "
                "differ by up to millimetres.");
    with(add(tissue, "FastTetrahedralCorotationalForceField", "Sofa.Component.SolidMechanics.FEM.Elastic"),
         {{"method", "polar"},
          {"topology", "@mesh"},
          {"youngModulus", fmt::format("{}", fmt::join(stiffness.youngs_modulus_kpa, " "))},
          {"poissonRatio", fmt::format("{}", fmt::join(stiffness.poissons_ratio, " "))}});
  }

  void add_held(pugi::xml_node tissue, const HeldSet& held) {
    const bool is_moved = std::holds_alternative<DisplacedConstraint>(model_.constraints[held.constraint]);
    const bool is_whole = held.axes[0] && held.axes[1] && held.axes[2];
    const char* component = is_moved   ? "LinearMovementProjectiveConstraint"
                            : is_whole ? "FixedProjectiveConstraint"
                                       : "PartialFixedProjectiveConstraint";
    pugi::xml_node node = with(add(tissue, component, "Sofa.Component.Constraint.Projective"),
                               {{"name", fmt::format("constraint_{}_{}", held.constraint, letters(held.axes))},
                                {"template", "Vec3"},
                                {"indices", fmt::format("{}", fmt::join(held.vertices, " "))}});
    if (is_moved) {
      // An axis that an earlier constraint holds has the same prescribed displacement, so moving all three is correct.
      const std::string end = text_of(held.displacement_mm);
      with(node, {{"keyTimes", fmt::format("0 {} {}", kRampS, kHeldUntilS)},
                  {"movements", fmt::format("0 0 0  {}  {}", end, end)}});
    } else if (!is_whole) {
      with(node, {{"fixedDirections", fmt::format("{:d} {:d} {:d}", held.axes[0], held.axes[1], held.axes[2])}});
    }
  }

  void add_loads_and_supports(pugi::xml_node tissue, std::size_t index) {
    const std::string name = fmt::format("constraint_{}", index);
    if (const auto* traction = std::get_if<TractionConstraint>(&model_.constraints[index])) {
      std::string indices;
      std::string forces;
      for (const VertexLoad& load : vertex_loads(model_.mesh, boundary_faces(model_.mesh), *traction)) {
        indices += fmt::format("{}{}", indices.empty() ? "" : " ", load.vertex.value);
        forces += (forces.empty() ? "" : "  ") + text_of(load.force_mn);
      }
      add_comment(tissue, fmt::format("Traction of {} kPa, as forces on vertices that keep their direction",
                                      text_of(traction->traction_kpa)));
      with(add(tissue, "ConstantForceField", "Sofa.Component.MechanicalLoad"),
           {{"name", name}, {"indices", indices}, {"forces", forces}});
      return;
    }
    const auto* support = std::get_if<SupportConstraint>(&model_.constraints[index]);
    if (support == nullptr) return;
    if (support->holder) {
      throw CaseError("case", fmt::format("specimen.constraints[{}].surface", index),
                      fmt::format("'{}'", support->holder->name), "a plane for an export as sofa",
                      "SOFA handles contact with a surface by another method, with its own friction and margins");
    }
    const SupportPlane& plane = *std::ranges::find(model_.supports, index, &SupportPlane::constraint);
    const double sum = std::accumulate(plane.stiffness.begin(), plane.stiffness.end(), 0.0);
    add_comment(
        tissue,
        "Support: pushes vertices behind the plane, never pulls. SOFA has one stiffness for all vertices, the mean of "
        "incise's, which are proportional to each vertex's share of the surface. Depths behind the plane differ by "
        "hundredths of a mm.");
    const double stiffness = sum / static_cast<double>(std::max<std::size_t>(plane.stiffness.size(), 1));
    with(add(tissue, "PlaneForceField", "Sofa.Component.MechanicalLoad"),
         {{"name", name},
          {"normal", text_of(plane.normal)},
          {"d", fmt::format("{}", plane.normal.dot(plane.point_mm))},
          {"stiffness", fmt::format("{}", stiffness)},
          {"damping", "0"}});
  }

  const InterchangeCase& specimen_;
  const TissueModel& model_;
  std::set<std::string> plugins_;
};

}  // namespace

std::string sofa_scene_xml(const InterchangeCase& specimen) {
  return SofaScene(specimen).text();
}

}  // namespace incise
