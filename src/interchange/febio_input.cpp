#include "interchange/specimen_text.hpp"

#include <incise/core/units.hpp>

#include <fmt/format.h>

namespace incise {
namespace {

constexpr const char* kTissue = "tissue";
constexpr int kLoadSteps = 10;
/// A plane becomes two triangles that form a square; half its side is this many diagonals of the body's box.
constexpr double kPlaneReach = 3.0;

/// Returns text such as "1,2,3" for indices that start at 0.
template <class Indices>
std::string numbers_from_1(const Indices& indices) {
  std::string text;
  for (const auto index : indices) text += fmt::format("{}{}", text.empty() ? "" : ",", index + 1);
  return text;
}

std::string triangle_text(const Triangle& t, std::size_t first_vertex = 0) {
  return fmt::format("{},{},{}", first_vertex + t[0].index() + 1, first_vertex + t[1].index() + 1,
                     first_vertex + t[2].index() + 1);
}

class FebioInput {
 public:
  explicit FebioInput(const InterchangeCase& specimen)
      : specimen_(specimen), model_(specimen.model), skin_(boundary_faces(model_.mesh)), held_(held_sets(model_)) {}

  std::string text() {
    require_known_law(model_, "febio");
    pugi::xml_document document;
    with(document.append_child(pugi::node_declaration), {{"version", "1.0"}, {"encoding", "UTF-8"}});
    pugi::xml_node root = with(document.append_child("febio_spec"), {{"version", "4.0"}});
    add_comments(root);
    add_text(with(root.append_child("Module"), {{"type", "solid"}}), "units", "mm-kg-s");
    add_control(root);
    material_ = root.append_child("Material");
    mesh_ = root.append_child("Mesh");
    domains_ = root.append_child("MeshDomains");
    data_ = root.append_child("MeshData");
    boundary_ = root.append_child("Boundary");
    rigid_ = root.append_child("Rigid");
    loads_ = root.append_child("Loads");
    contact_ = root.append_child("Contact");
    add_tissue();
    add_supports();
    add_law();
    for (const HeldSet& held : held_) add_held(held);
    add_loads();
    for (pugi::xml_node section : {data_, boundary_, rigid_, loads_, contact_}) {
      if (!section.first_child()) root.remove_child(section);
    }
    add_load_curve_and_output(root);
    return xml_text(document);
  }

 private:
  void add_comments(pugi::xml_node root) const {
    add_comment(root, specimen_.title);
    add_comment(root, specimen_.provenance);
    add_comment(root, "Units: mm, kg, s; so stress in kPa, force in mN, density in kg/mm3. Frame LPS.");
    add_comment(root,
                "Run: febio4 -i FILE. Displacements of every node go to displacement.csv. Nodes and elements are the "
                "vertices and tets of the incise case in its order, numbered from 1.");
    if (model_.material.model == MaterialModel::Corotational) {
      add_comment(root,
                  "DIFFERS: FEBio has no corotational law. 'isotropic elastic' (Saint Venant and Kirchhoff: second "
                  "Piola-Kirchhoff stress linear in Green-Lagrange strain) is the nearest: equal at small strain and "
                  "for any rotation. At a stretch s along one axis it gives a stress of E (s^2 - 1) s / 2 per rest "
                  "area where incise gives E (s - 1), both for nu 0: 32 % more at s = 1.2, and it softens in "
                  "compression.");
    } else {
      add_comment(root,
                  "DIFFERS: FEBio's 'neo-Hookean' has mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2; incise's stable "
                  "Neo-Hookean (Smith, de Goes and Kim 2018) is equal at small strain and close while J stays near 1, "
                  "and only it is defined for inverted tets.");
    }
    if (model_.material.volume == VolumeTreatment::Averaged) {
      add_comment(root,
                  "DIFFERS: incise averages the change of volume about each vertex (material.volume: averaged). These "
                  "are standard tet4 elements, which lock as Poisson's ratio nears 0.5.");
    }
    if (!model_.material.prony.empty() || model_.material.kelvin_voigt_time_s > 0.0) {
      add_comment(root, "The case's viscosity is left out: equilibrium is its long-time limit.");
    }
  }

  static void add_control(pugi::xml_node root) {
    pugi::xml_node control = root.append_child("Control");
    add_text(control, "analysis", "STATIC");
    add_text(control, "time_steps", fmt::format("{}", kLoadSteps));
    add_text(control, "step_size", fmt::format("{}", 1.0 / kLoadSteps));
    pugi::xml_node solver = with(control.append_child("solver"), {{"type", "solid"}});
    add_text(solver, "dtol", "1e-06");
    add_text(solver, "etol", "1e-08");
    add_text(solver, "rtol", "1e-06");
    pugi::xml_node stepper = with(control.append_child("time_stepper"), {{"type", "default"}});
    add_text(stepper, "max_retries", "10");
    add_text(stepper, "opt_iter", "15");
    add_text(stepper, "dtmin", "0.001");
    add_text(stepper, "dtmax", fmt::format("{}", 1.0 / kLoadSteps));
  }

  void add_nodes(const std::string& name, const Points& points) {
    pugi::xml_node nodes = with(mesh_.append_child("Nodes"), {{"name", name}});
    for (const Vec3& p : points) {
      with(add_text(nodes, "node", text_of(p, ",")), {{"id", fmt::format("{}", ++node_count_)}});
    }
  }

  pugi::xml_node add_elements(const std::string& name, const char* type) {
    return with(mesh_.append_child("Elements"), {{"type", type}, {"name", name}});
  }

  void add_element(pugi::xml_node elements, const std::string& corners) {
    with(add_text(elements, "elem", corners), {{"id", fmt::format("{}", ++element_count_)}});
  }

  void add_surface(const std::string& name, const std::vector<std::string>& triangles) {
    pugi::xml_node surface = with(mesh_.append_child("Surface"), {{"name", name}});
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      with(add_text(surface, "tri3", triangles[i]), {{"id", fmt::format("{}", i + 1)}});
    }
  }

  void add_node_set(const std::string& name, const std::string& numbers) {
    with(add_text(mesh_, "NodeSet", numbers), {{"name", name}});
  }

  void add_tissue() {
    add_nodes("tissue_nodes", model_.mesh.vertices);
    pugi::xml_node elements = add_elements(kTissue, "tet4");
    for (const Tet& t : model_.mesh.tets) {
      add_element(elements,
                  fmt::format("{},{},{},{}", t[0].index() + 1, t[1].index() + 1, t[2].index() + 1, t[3].index() + 1));
    }
    with(domains_.append_child("SolidDomain"), {{"name", kTissue}, {"mat", kTissue}});
  }

  pugi::xml_node add_material(const std::string& name, const char* type, double density) {
    pugi::xml_node material = with(material_.append_child("material"),
                                   {{"id", fmt::format("{}", ++material_count_)}, {"name", name}, {"type", type}});
    add_text(material, "density", fmt::format("{}", density));
    return material;
  }

  void add_law() {
    const bool is_corotational = model_.material.model == MaterialModel::Corotational;
    pugi::xml_node material = add_material(kTissue, is_corotational ? "isotropic elastic" : "neo-Hookean",
                                           units::kg_mm3_from_kg_m3(model_.material.density_kg_m3));
    const Stiffness stiffness = stiffness_of(model_);
    add_parameter(material, "E", "youngs_modulus_kpa", stiffness.youngs_modulus_kpa, stiffness.varies());
    add_parameter(material, "v", "poissons_ratio", stiffness.poissons_ratio, stiffness.varies());
  }

  void add_parameter(pugi::xml_node material, const char* name, const char* map, const std::vector<double>& values,
                     bool varies) {
    if (!varies) {
      add_text(material, name, fmt::format("{}", values.front()));
      return;
    }
    with(add_text(material, name, map), {{"type", "map"}});
    pugi::xml_node data = with(data_.append_child("ElementData"), {{"name", map}, {"elem_set", kTissue}});
    for (std::size_t i = 0; i < values.size(); ++i) {
      with(add_text(data, "e", fmt::format("{}", values[i])), {{"lid", fmt::format("{}", i + 1)}});
    }
  }

  void add_held(const HeldSet& held) {
    const std::string name = fmt::format("constraint_{}_{}", held.constraint, letters(held.axes));
    add_node_set(name, numbers_from_1(held.vertices));
    if (std::holds_alternative<FixedConstraint>(model_.constraints[held.constraint])) {
      pugi::xml_node bc = add_boundary_condition(name, "zero displacement", name);
      for (std::size_t i = 0; i < 3; ++i)
        add_text(bc, fmt::format("{}_dof", "xyz"[i]).c_str(), held.axes[i] ? "1" : "0");
      return;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (!held.axes[i]) continue;
      const std::string axis(1, "xyz"[i]);
      pugi::xml_node bc = add_boundary_condition(name + "_" + axis, "prescribed displacement", name);
      add_text(bc, "dof", axis);
      add_text(bc, "value", fmt::format("{}", held.displacement_mm[static_cast<int>(i)])).append_attribute("lc") = 1;
      add_text(bc, "relative", "0");
    }
  }

  pugi::xml_node add_boundary_condition(const std::string& name, const char* type, const std::string& node_set) {
    return with(boundary_.append_child("bc"), {{"name", name}, {"type", type}, {"node_set", node_set}});
  }

  /// Uses forces on vertices instead of FEBio's own tractions and body forces: they keep direction and size, as in
  /// incise. In a linear tet, a quarter of the body force acts on each corner.
  void add_vertex_forces(const std::string& name, const std::vector<VertexLoad>& loads) {
    std::vector<std::int32_t> vertices;
    for (const VertexLoad& load : loads) vertices.push_back(load.vertex.value);
    add_node_set(name, numbers_from_1(vertices));
    pugi::xml_node data =
        with(data_.append_child("NodeData"), {{"name", name + "_mn"}, {"node_set", name}, {"data_type", "vec3"}});
    for (std::size_t i = 0; i < loads.size(); ++i) {
      with(add_text(data, "node", text_of(loads[i].force_mn, ",")), {{"lid", fmt::format("{}", i + 1)}});
    }
    pugi::xml_node node =
        with(loads_.append_child("nodal_load"), {{"name", name}, {"type", "nodal_force"}, {"node_set", name}});
    with(add_text(node, "value", name + "_mn"), {{"lc", "1"}, {"type", "map"}});
  }

  void add_loads() {
    if (!specimen_.gravity_mm_s2.isZero(0.0)) {
      std::vector<VertexLoad> weight;
      for (std::size_t v = 0; v < model_.vertex_mass_kg.size(); ++v) {
        weight.push_back({VertexId(v), model_.vertex_mass_kg[v] * specimen_.gravity_mm_s2});
      }
      add_comment(loads_, fmt::format("Gravity of {} mm/s2, as the weight of each node's share of the tissue",
                                      text_of(specimen_.gravity_mm_s2)));
      add_vertex_forces("gravity", weight);
    }
    for (std::size_t i = 0; i < model_.constraints.size(); ++i) {
      const auto* traction = std::get_if<TractionConstraint>(&model_.constraints[i]);
      if (traction == nullptr) continue;
      add_comment(loads_, fmt::format("Traction of {} kPa, as forces on nodes that keep their direction",
                                      text_of(traction->traction_kpa)));
      add_vertex_forces(fmt::format("constraint_{}_traction", i), vertex_loads(model_.mesh, skin_, *traction));
    }
  }

  void add_supports() {
    if (model_.supports.empty()) return;
    std::vector<std::string> triangles;
    for (const BoundaryFace& face : skin_) triangles.push_back(triangle_text(face.corners));
    add_surface("skin", triangles);
    for (const SupportPlane& support : model_.supports) {
      const auto& constraint = std::get<SupportConstraint>(model_.constraints[support.constraint]);
      add_support(fmt::format("constraint_{}_support", support.constraint),
                  constraint.holder ? constraint.holder->surface : plate_of(support));
    }
  }

  [[nodiscard]] TriMesh plate_of(const SupportPlane& support) const {
    const Box3 box = bounding_box(model_.mesh.vertices);
    const Vec3 center = box.center() - (box.center() - support.point_mm).dot(support.normal) * support.normal;
    const Vec3 u = kPlaneReach * box.diagonal().norm() * support.normal.unitOrthogonal();
    const Vec3 w = support.normal.cross(u);
    return {{center - u - w, center + u - w, center + u + w, center - u + w},
            {{VertexId{0}, VertexId{1}, VertexId{2}}, {VertexId{0}, VertexId{2}, VertexId{3}}},
            {}};
  }

  void add_support(const std::string& name, const TriMesh& shell) {
    const std::size_t first = node_count_;
    add_nodes(name + "_nodes", shell.vertices);
    pugi::xml_node elements = add_elements(name, "tri3");
    std::vector<std::string> triangles;
    for (const Triangle& t : shell.triangles) {
      triangles.push_back(triangle_text(t, first));
      add_element(elements, triangles.back());
    }
    add_surface(name + "_surface", triangles);
    pugi::xml_node pair = with(mesh_.append_child("SurfacePair"), {{"name", name + "_pair"}});
    add_text(pair, "primary", "skin");
    add_text(pair, "secondary", name + "_surface");
    pugi::xml_node domain = with(domains_.append_child("ShellDomain"), {{"name", name}, {"mat", name}});
    add_text(domain, "shell_thickness", "0.001");
    add_text(add_material(name, "rigid body", 1e-6), "center_of_mass", "0,0,0");
    pugi::xml_node fixed = with(rigid_.append_child("rigid_bc"), {{"name", name + "_fixed"}, {"type", "rigid_fixed"}});
    add_text(fixed, "rb", name);
    for (const char* dof : {"Rx_dof", "Ry_dof", "Rz_dof", "Ru_dof", "Rv_dof", "Rw_dof"}) add_text(fixed, dof, "1");
    add_comment(contact_,
                "Frictionless and unilateral. FEBio chooses the penalty and refines it (augmented Lagrangian).");
    pugi::xml_node contact = with(contact_.append_child("contact"),
                                  {{"name", name}, {"type", "sliding-elastic"}, {"surface_pair", name + "_pair"}});
    add_text(contact, "laugon", "AUGLAG");
    add_text(contact, "tolerance", "0.05");
    add_text(contact, "gaptol", "0.05");
    add_text(contact, "penalty", "1");
    add_text(contact, "auto_penalty", "1");
    add_text(contact, "two_pass", "0");
    add_text(contact, "fric_coeff", "0");
  }

  static void add_load_curve_and_output(pugi::xml_node root) {
    pugi::xml_node curve =
        with(root.append_child("LoadData").append_child("load_controller"), {{"id", "1"}, {"type", "loadcurve"}});
    add_text(curve, "interpolate", "LINEAR");
    add_text(curve, "extend", "CONSTANT");
    pugi::xml_node points = curve.append_child("points");
    add_text(points, "pt", "0,0");
    add_text(points, "pt", "1,1");
    pugi::xml_node output = root.append_child("Output");
    pugi::xml_node plot = with(output.append_child("plotfile"), {{"type", "febio"}});
    for (const char* name : {"displacement", "stress"}) with(plot.append_child("var"), {{"type", name}});
    with(output.append_child("logfile").append_child("node_data"),
         {{"data", "ux;uy;uz"}, {"file", "displacement.csv"}, {"delim", ","}});
  }

  const InterchangeCase& specimen_;
  const TissueModel& model_;
  std::vector<BoundaryFace> skin_;
  std::vector<HeldSet> held_;
  pugi::xml_node material_, mesh_, domains_, data_, boundary_, rigid_, loads_, contact_;
  std::size_t node_count_ = 0;
  std::size_t element_count_ = 0;
  int material_count_ = 0;
};

}  // namespace

std::string febio_input_xml(const InterchangeCase& specimen) {
  return FebioInput(specimen).text();
}

}  // namespace incise
