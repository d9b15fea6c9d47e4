#include <incise/core/error.hpp>
#include <incise/workflow/case.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr const char* kWhere = "case";
constexpr const char* kLabelArray = "label";
constexpr const char* kToughnessArray = "toughness";
// Of the default hold.
constexpr double kClampMm = 15.0;    // grip of a specimen holder's posterior clamp
constexpr double kSutureMm = 10.0;   // round the retraction suture
constexpr double kStretchMm = 20.0;  // paper II-A

/// Names of the mesh's cell arrays for a message: "'a', 'b'".
std::string cell_arrays(const TetMesh& mesh) {
  std::string names;
  for (const auto& [name, data] : mesh.cell_data) names += (names.empty() ? "'" : ", '") + name + "'";
  return names.empty() ? "a mesh without cell data" : "a mesh with cell data " + names;
}

MaterialField field_from(const TetMesh& mesh) {
  const char* field_name = "specimen.material.from_mesh";
  if (const auto malformed = malformed_material_array(mesh))
    throw CaseError(kWhere, field_name, malformed->found, malformed->expected);
  MaterialField field = material_field_of(mesh);
  if (field.youngs_modulus_kpa.empty() && field.poissons_ratio.empty() && field.fibre_directions.empty()) {
    throw CaseError(kWhere, field_name, cell_arrays(mesh),
                    "at least one of the cell arrays youngs_modulus_kpa, poissons_ratio, fibre_direction",
                    "A mesh that is made from a CT has none");
  }
  const std::vector<Problem> violations = validate(field, mesh.tets.size());
  if (violations.empty()) return field;
  const Problem& first = violations.front();
  throw CaseError(kWhere, field_name, fmt::format("{} of {}", first.path, first.found), first.expected);
}

/// Returns a cell array that has one number for each tet.
/// @param field  field of the case that uses it.
/// @param hint   why a mesh may lack it.
const std::vector<double>& numbers_of(const TetMesh& mesh, const char* array, const char* field, const char* hint) {
  const auto found = mesh.cell_data.find(array);
  if (found == mesh.cell_data.end())
    throw CaseError(kWhere, field, cell_arrays(mesh),
                    fmt::format("the cell array '{}', one number for each tet", array), hint);
  const auto& [components, values] = found->second;
  if (components != 1 || values.size() != mesh.tets.size())
    throw CaseError(
        kWhere, field,
        fmt::format("the cell array '{}' with {} components and {} numbers", array, components, values.size()),
        fmt::format("one number for each of {} tets", mesh.tets.size()));
  return values;
}

const std::vector<double>& labels_of(const TetMesh& mesh, const char* field) {
  return numbers_of(mesh, kLabelArray, field,
                    "A mesh that is made from a CT has the labels of ct.labels: give ct.labels or specimen.mesh");
}

/// @param field  field of the case that names the label.
void require_label(const std::vector<double>& labels, int label, const std::string& field) {
  if (std::find(labels.begin(), labels.end(), static_cast<double>(label)) != labels.end()) return;
  const auto [least, most] = std::minmax_element(labels.begin(), labels.end());
  throw CaseError(kWhere, field, fmt::format("{}, which no tet has", label),
                  fmt::format("a label of the mesh; its labels lie between {:g} and {:g}", *least, *most));
}

/// Sets `values` in the tets of one label; an empty list starts as `common` everywhere.
void lay_over(std::vector<double>& values, const std::vector<double>& labels, int label, double value, double common) {
  if (values.empty()) values.assign(labels.size(), common);
  for (std::size_t t = 0; t < labels.size(); ++t) {
    if (labels[t] == label) values[t] = value;
  }
}

/// Returns the fibre directions of the study's field, one for each tet.
std::vector<Vec3> directions_of(const FibreField& field, const TetMesh& mesh) {
  FibreDirections found = fibre_directions(mesh, field);
  if (found.outcome == Outcome::Success) return std::move(found.directions);
  throw CaseError(kWhere, "specimen.material.fibre_field",
                  fmt::format("a potential that has not converged after {} iterations (residual {:.1e})",
                              found.iterations, found.residual),
                  "one that converges", "Badly shaped tetrahedra may be the cause");
}

}  // namespace

std::vector<Problem> validate(const Material& material, const MaterialVariation& variation) {
  std::vector<Problem> violations = validate(material);
  if (variation.fibre_field && material.fibre_modulus_kpa == 0.0) {
    violations.push_back({"fibre_modulus_kpa", "0 kPa, with which fibre_field changes nothing", "a number above 0",
                          "Without fibres, leave out fibre_field"});
  }
  return violations;
}

std::vector<Problem> validate(const CompensationChoice& choice) {
  constexpr std::size_t kMostSectors = 360;
  std::vector<Problem> violations;
  const auto unused = [&](const char* field, const std::string& found, const char* expected) {
    violations.push_back(
        {field, fmt::format("{}, which method {} does not use", found, to_string(choice.method)), expected});
  };
  for (const auto& [field, list] :
       {std::pair{"residual_mm", &choice.residual_mm}, std::pair{"photographed_mm", &choice.photographed_mm}}) {
    if (list->size() > kMostSectors) {
      violations.push_back({field, fmt::format("{} numbers", list->size()), fmt::format("at most {}", kMostSectors)});
    }
  }
  const bool is_profile = choice.method == CompensationMethod::Profile;
  if (is_profile && choice.photographed_mm.empty()) {
    violations.push_back({"photographed_mm", "no numbers, without which method profile changes nothing",
                          "the expected errors by direction, or a list of one number for all",
                          "A calibration's photographed_profile.mean_mm is such a list"});
  }
  if (!is_profile && !choice.photographed_mm.empty()) unused("photographed_mm", "numbers", "none");
  if (is_profile && choice.bias_mm != 0.0) unused("bias_mm", fmt::format("{} mm", choice.bias_mm), "0");
  if (choice.method == CompensationMethod::Default) return violations;
  if (!choice.residual_mm.empty()) unused("residual_mm", "numbers", "none");
  if (choice.simulated_share != 1.0) unused("simulated_share", fmt::format("{}", choice.simulated_share), "1");
  return violations;
}

bool expects_by_direction(const CompensationChoice& choice) {
  return !choice.photographed_mm.empty() || !choice.residual_mm.empty() || choice.simulated_share != 1.0;
}

MaterialField material_field(const TetMesh& mesh, const Material& material, const MaterialVariation& variation) {
  if (const std::vector<Problem> violations = validate(material, variation); !violations.empty()) {
    const Problem& first = violations.front();
    throw CaseError(kWhere, "specimen.material." + first.path, first.found, first.expected, first.hint);
  }
  MaterialField field;
  if (variation.from_mesh) field = field_from(mesh);
  if (variation.fibre_field && !field.fibre_directions.empty()) {
    throw CaseError(kWhere, "specimen.material.fibre_field",
                    "fibre directions from the mesh, too: from_mesh, and the mesh's cell array 'fibre_direction'",
                    "one of the two");
  }
  const auto laid = mesh.cell_data.find(kLaidModulusArray);
  INCISE_REQUIRE(!variation.tumor_modulus_kpa || laid != mesh.cell_data.end(),
                 "expected a mesh on which lay_on_mesh has laid the tumour's stiffness");
  if (laid != mesh.cell_data.end()) field.youngs_modulus_kpa = laid->second.values;
  const bool has_only_fibres = variation.from_mesh && field.youngs_modulus_kpa.empty() && field.poissons_ratio.empty();
  if (has_only_fibres && material.fibre_modulus_kpa == 0.0) {
    throw CaseError(kWhere, "specimen.material.fibre_modulus_kpa",
                    "0 kPa, with which the mesh's fibre_direction changes nothing", "a number above 0",
                    "Without fibres, leave out from_mesh");
  }
  if (variation.fibre_field) field.fibre_directions = directions_of(*variation.fibre_field, mesh);
  if (variation.labels.empty()) return field;
  const std::vector<double>& labels = labels_of(mesh, "specimen.material.labels");
  for (std::size_t i = 0; i < variation.labels.size(); ++i) {
    const LabelMaterial& entry = variation.labels[i];
    require_label(labels, entry.label, fmt::format("specimen.material.labels[{}].label", i));
    if (entry.youngs_modulus_kpa) {
      lay_over(field.youngs_modulus_kpa, labels, entry.label, *entry.youngs_modulus_kpa, material.youngs_modulus_kpa);
    }
    if (entry.poissons_ratio) {
      lay_over(field.poissons_ratio, labels, entry.label, *entry.poissons_ratio, material.poissons_ratio);
    }
  }
  return field;
}

std::vector<double> toughness_of(const TetMesh& mesh, const ToughnessVariation& variation) {
  std::vector<double> toughness;
  if (variation.from_mesh) {
    const char* field = "cut.toughness_from_mesh";
    toughness = numbers_of(mesh, kToughnessArray, field, "A mesh that is made from a CT has none: give specimen.mesh");
    const auto bad = std::find_if_not(toughness.begin(), toughness.end(), [](double t) { return std::isfinite(t) && t > 0.0; });
    if (bad != toughness.end()) {
      throw CaseError(kWhere, field, fmt::format("toughness of {} at tet {}", *bad, bad - toughness.begin()), "a finite number above 0");
    }
  }
  if (variation.labels.empty()) return toughness;
  const std::vector<double>& labels = labels_of(mesh, "cut.toughness");
  for (std::size_t i = 0; i < variation.labels.size(); ++i) {
    const LabelToughness& entry = variation.labels[i];
    require_label(labels, entry.label, fmt::format("cut.toughness[{}].label", i));
    lay_over(toughness, labels, entry.label, entry.toughness, 1.0);
  }
  return toughness;
}

std::string default_hold_in_words() {
  return fmt::format(
      "The back end ({:g} mm) is clamped, the front end ({:g} mm) is pulled {:g} mm forwards, and a plane "
      "under the body's lowest point supports it",
      kClampMm, kSutureMm, kStretchMm);
}

std::vector<Constraint> default_constraints(const TetMesh& mesh) {
  constexpr double kShortestMm = 40.0;  // the part between the ends is then stretched to at most 2.3 times its length
  const Box3 box = bounding_box(mesh.vertices);
  const double length_mm = box.sizes().y(), lowest = box.min().z();
  if (!(length_mm >= kShortestMm)) {
    throw CaseError("case", "specimen.constraints",
                    fmt::format("none, and a body {:.3g} mm long from front to back", length_mm),
                    fmt::format("stated constraints for a body shorter than {:g} mm: by default {:g} mm are clamped at "
                                "the back and {:g} mm at the front are pulled by {:g} mm",
                                kShortestMm, kClampMm, kSutureMm, kStretchMm));
  }
  return {FixedConstraint{EndRegion{Vec3::UnitY(), kClampMm}, {true, true, true}},
          DisplacedConstraint{EndRegion{-Vec3::UnitY(), kSutureMm}, Vec3(0.0, -kStretchMm, 0.0)},
          SupportConstraint{Vec3(0.0, 0.0, lowest), Vec3::UnitZ()}};
}

}  // namespace incise
