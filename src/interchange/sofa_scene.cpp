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
    pugi::xml_node root = document.append_child("Node");
    root.append_attribute("name") = "root";
    set(root, "dt", kStepS);
    set(root, "gravity", text_of(specimen_.gravity_mm_s2));
    root.append_child("DefaultAnimationLoop");
    pugi::xml_node tissue = root.append_child("Node");
    tissue.append_attribute("name") = "tissue";
    add_solver(tissue);
    add_mesh(tissue);
    add_law(tissue);
    for (const HeldSet& held : held_sets(model_)) add_held(tissue, held);
    for (std::size_t i = 0; i < model_.constraints.size(); ++i) add_loads_and_supports(tissue, i);
    pugi::xml_node exporter = add(tissue, "VTKExporter", "Sofa.Component.IO.Mesh");
    exporter.append_attribute("filename") = "sofa_result";
    exporter.append_attribute("listening") = 1;
    exporter.append_attribute("edges") = 0;
    exporter.append_attribute("tetras") = 1;
    exporter.append_attribute("exportEveryNumberOfSteps") = kSteps;
    for (const std::string& name : plugins_) {
      pugi::xml_node plugin = root.insert_child_before("RequiredPlugin", root.child("DefaultAnimationLoop"));
      plugin.append_attribute("name") = name.c_str();
    }
    return xml_text(document);
  }

 private:
  template <class Number>
  static void set(pugi::xml_node node, const char* name, const Number& value) {
    node.append_attribute(name) = fmt::format("{}", value).c_str();
  }

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
                  "has standard "
                  "tets only, which lock as Poisson's ratio nears 0.5.");
    }
    if (!model_.material.prony.empty() || model_.material.kelvin_voigt_time_s > 0.0) {
      add_comment(document, "The case's viscosity is left out: equilibrium is its long-time limit.");
    }
  }

  void add_solver(pugi::xml_node tissue) {
    pugi::xml_node solver = add(tissue, "EulerImplicitSolver", "Sofa.Component.ODESolver.Backward");
    set(solver, "rayleighStiffness", 0.1);
    set(solver, "rayleighMass", 0.1);
    pugi::xml_node linear = add(tissue, "CGLinearSolver", "Sofa.Component.LinearSolver.Iterative");
    linear.append_attribute("template") = "GraphScattered";
    set(linear, "iterations", 800);
    set(linear, "tolerance", 1e-18);
    set(linear, "threshold", 1e-18);
  }

  void add_mesh(pugi::xml_node tissue) {
    std::string positions;
    for (const Vec3& p : model_.mesh.vertices) positions += (positions.empty() ? "" : "  ") + text_of(p);
    std::string tets;
    for (const Tet& t : model_.mesh.tets) {
      tets += fmt::format("{}{} {} {} {}", tets.empty() ? "" : "  ", t[0].value, t[1].value, t[2].value, t[3].value);
    }
    pugi::xml_node topology =
        add(tissue, "TetrahedronSetTopologyContainer", "Sofa.Component.Topology.Container.Dynamic");
    topology.append_attribute("name") = "mesh";
    topology.append_attribute("position") = positions.c_str();
    topology.append_attribute("tetrahedra") = tets.c_str();
    tissue.append_child("TetrahedronSetGeometryAlgorithms").append_attribute("template") = "Vec3";
    pugi::xml_node state = add(tissue, "MechanicalObject", "Sofa.Component.StateContainer");
    state.append_attribute("name") = "state";
    state.append_attribute("template") = "Vec3";
    state.append_attribute("position") = "@mesh.position";
    pugi::xml_node mass = add(tissue, "DiagonalMass", "Sofa.Component.Mass");
    set(mass, "massDensity", units::kg_mm3_from_kg_m3(model_.material.density_kg_m3));
    mass.append_attribute("topology") = "@mesh";
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
                  "the same at "
                  "small strain. Parameters: mu, lambda.");
      pugi::xml_node law =
          add(tissue, "TetrahedronHyperelasticityFEMForceField", "Sofa.Component.SolidMechanics.FEM.HyperElastic");
      law.append_attribute("materialName") = "StableNeoHookean";
      law.append_attribute("ParameterSet") =
          fmt::format("{} {}", model_.lame.front().mu_kpa, model_.lame.front().lambda_kpa).c_str();
      return;
    }
    add_comment(tissue,
                "The same law as incise: linear elasticity about the polar rotation of each tet's deformation "
                "gradient. SOFA's other "
                "corotational force fields take their rotation from edges of the tet and differ by up to millimetres.");
    pugi::xml_node law =
        add(tissue, "FastTetrahedralCorotationalForceField", "Sofa.Component.SolidMechanics.FEM.Elastic");
    law.append_attribute("method") = "polar";
    law.append_attribute("topology") = "@mesh";
    law.append_attribute("youngModulus") = fmt::format("{}", fmt::join(stiffness.youngs_modulus_kpa, " ")).c_str();
    law.append_attribute("poissonRatio") = fmt::format("{}", fmt::join(stiffness.poissons_ratio, " ")).c_str();
  }

  void add_held(pugi::xml_node tissue, const HeldSet& held) {
    const bool is_moved = std::holds_alternative<DisplacedConstraint>(model_.constraints[held.constraint]);
    const bool is_whole = held.axes[0] && held.axes[1] && held.axes[2];
    const char* component = is_moved   ? "LinearMovementProjectiveConstraint"
                            : is_whole ? "FixedProjectiveConstraint"
                                       : "PartialFixedProjectiveConstraint";
    pugi::xml_node node = add(tissue, component, "Sofa.Component.Constraint.Projective");
    node.append_attribute("name") = fmt::format("constraint_{}_{}", held.constraint, letters(held.axes)).c_str();
    node.append_attribute("template") = "Vec3";
    node.append_attribute("indices") = fmt::format("{}", fmt::join(held.vertices, " ")).c_str();
    if (is_moved) {
      // An axis that an earlier constraint holds has the same prescribed displacement, so moving all three is correct.
      node.append_attribute("keyTimes") = fmt::format("0 {} {}", kRampS, kHeldUntilS).c_str();
      const std::string end = text_of(held.displacement_mm);
      node.append_attribute("movements") = fmt::format("0 0 0  {}  {}", end, end).c_str();
    } else if (!is_whole) {
      node.append_attribute("fixedDirections") =
          fmt::format("{:d} {:d} {:d}", held.axes[0], held.axes[1], held.axes[2]).c_str();
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
      pugi::xml_node node = add(tissue, "ConstantForceField", "Sofa.Component.MechanicalLoad");
      node.append_attribute("name") = name.c_str();
      node.append_attribute("indices") = indices.c_str();
      node.append_attribute("forces") = forces.c_str();
      return;
    }
    const auto* support = std::get_if<SupportConstraint>(&model_.constraints[index]);
    if (support == nullptr) return;
    if (support->holder) {
      throw CaseError("case", fmt::format("specimen.constraints[{}].surface", index),
                      fmt::format("'{}'", support->holder->name), "a plane for an export as sofa",
                      "SOFA handles contact with a surface by another method, with its own friction and margins");
    }
    const SupportPlane& plane = *std::find_if(model_.supports.begin(), model_.supports.end(),
                                              [index](const SupportPlane& s) { return s.constraint == index; });
    const double sum = std::accumulate(plane.stiffness.begin(), plane.stiffness.end(), 0.0);
    add_comment(
        tissue,
        "Support: pushes vertices behind the plane, never pulls. SOFA has one stiffness for all vertices, the mean of "
        "incise's, which are proportional to each vertex's share of the surface. Depths behind the plane differ by "
        "hundredths of a mm.");
    pugi::xml_node node = add(tissue, "PlaneForceField", "Sofa.Component.MechanicalLoad");
    node.append_attribute("name") = name.c_str();
    node.append_attribute("normal") = text_of(plane.normal).c_str();
    set(node, "d", plane.normal.dot(plane.point_mm));
    set(node, "stiffness", sum / static_cast<double>(std::max<std::size_t>(plane.stiffness.size(), 1)));
    set(node, "damping", 0);
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
