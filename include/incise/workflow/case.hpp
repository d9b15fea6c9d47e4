#pragma once

#include <incise/core/defaults.hpp>
#include <incise/core/names.hpp>
#include <incise/cutting/cut_settings.hpp>
#include <incise/cutting/thermal.hpp>
#include <incise/cutting/tool.hpp>
#include <incise/evaluation/evaluation.hpp>
#include <incise/geometry/tet_mesh.hpp>
#include <incise/imaging/segmentation.hpp>
#include <incise/mechanics/constraints.hpp>
#include <incise/mechanics/fibre_field.hpp>
#include <incise/mechanics/material.hpp>
#include <incise/planning/plan_path.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// Edge lengths, mm, of the mesh that is made from labels.
struct MeshingChoice {
  std::optional<double> fine_mm;    ///< in the band that the needle can reach; absent: see default_lengths
  std::optional<double> coarse_mm;  ///< far from the cut; absent: see default_lengths
  int tets = 0;                     ///< count to aim for by scaling both lengths; 0: as the lengths give
  /// Of the coarse mesh with which the planned cut is found in the unstretched body; absent: the default coarse_mm.
  std::optional<double> survey_mm;
};
inline void describe(Visitor& v, MeshingChoice& m) {
  v({"fine_mm",
     "Edge length in the band that the needle can reach; absent: 0.8, proportionally less for a body shorter than "
     "40 mm.",
     "mm"},
    m.fine_mm, {0.1, 20.0});
  v({"coarse_mm",
     "Longest edge length, far from the cut; absent: 4, proportionally less for a body shorter than 40 mm.", "mm"},
    m.coarse_mm, {0.1, 50.0});
  v("tets", m.tets, "Number of tets to aim for by scaling both lengths; 0: the lengths decide.", {0.0, 5e6});
  v({"survey_mm",
     "Edge length of the coarse mesh with which the planned cut is found in the unstretched body; absent: 4, "
     "proportionally less for a body shorter than 40 mm.",
     "mm"},
    m.survey_mm, {0.5, 20.0});
}

inline constexpr Range kLabelRange{-1e9, 1e9};

/// Material of the tets with one value of the mesh's cell array `label`, where it differs from the rest.
struct LabelMaterial {
  int label = 0;
  std::optional<double> youngs_modulus_kpa;
  std::optional<double> poissons_ratio;
};
inline void describe(Visitor& v, LabelMaterial& m) {
  v("label", m.label, "Value of the mesh's cell array 'label', or of ct.labels.", kLabelRange);
  v({"youngs_modulus_kpa", "Young's modulus of these tets; absent: as elsewhere.", "kPa"}, m.youngs_modulus_kpa,
    kYoungsModulusLimits);
  v("poissons_ratio", m.poissons_ratio, "Poisson's ratio of these tets; absent: as elsewhere.", kPoissonsRatioLimits);
}

/// Which differences of material within the specimen a study takes from its mesh, or from the sources laid on it
/// (material_sources.hpp).
struct MaterialVariation {
  /// Use the mesh's cell data youngs_modulus_kpa, poissons_ratio and fibre_direction, as far as they exist.
  bool from_mesh = false;
  std::optional<double> tumor_modulus_kpa;  ///< Young's modulus in the tumour's surface; absent: as elsewhere
  std::optional<FibreField> fibre_field;    ///< absent: directions are those of the mesh or the material
  std::vector<LabelMaterial>
      labels;  ///< override the others; tets with other labels keep their material
};
inline void describe(Visitor& v, MaterialVariation& m) {
  v("from_mesh", m.from_mesh,
    "Whether to use the mesh's cell data youngs_modulus_kpa, poissons_ratio and fibre_direction, as far as they "
    "exist.");
  v({"tumor_modulus_kpa",
     "Young's modulus within tumor.surface, which is drawn on the tissue as scanned; absent: as elsewhere.", "kPa"},
    m.tumor_modulus_kpa, kYoungsModulusLimits);
  v("fibre_field", m.fibre_field,
    "Fibres that run from one region to another, through the body at rest; regions are given as in constraints. "
    "Absent: fibres run along fibre_direction.");
  v("labels", m.labels,
    "Parts with another stiffness, by the mesh's cell array 'label' or by ct.labels; absent: none.");
}

/// Toughness of the tets with one value of the mesh's cell array `label`.
struct LabelToughness {
  int label = 0;
  double toughness = 1.0;  ///< relative to the reference tissue, > 0
};
inline void describe(Visitor& v, LabelToughness& m) {
  v("label", m.label, "Value of the mesh's cell array 'label'.", kLabelRange);
  v("toughness", m.toughness, "Toughness of these tets; the reference tissue has 1.", {1e-3, 1e3});
}

/// Toughness of the specimen against cutting, relative to the tissue for which speed and dullness hold; 1 unless
/// stated.
struct ToughnessVariation {
  bool from_mesh = false;              ///< use the mesh's cell array `toughness`
  std::vector<LabelToughness> labels;  ///< override `from_mesh`
};
inline void describe(Visitor& v, ToughnessVariation& m) {
  v("toughness", m.labels,
    "Parts that need more or less dose to be cut, by the mesh's cell array 'label' or by ct.labels; absent: 1 "
    "everywhere.");
  v("toughness_from_mesh", m.from_mesh, "Whether to use the mesh's cell data toughness.");
}

enum class TumorConfiguration {
  Stretched,  ///< the edge is marked on the clamped and stretched tissue, as in the paper
  Rest,       ///< on the tissue as it was scanned
};
inline constexpr std::array<std::string_view, 2> kTumorConfigurationNames{"stretched", "rest"};
[[nodiscard]] constexpr Names names_of(TumorConfiguration) {
  return kTumorConfigurationNames;
}

enum class CompensationMethod {
  Default,  ///< pass by pass, until the cut lies where it was intended
  Paper,    ///< each waypoint moves once, by the error measured in its direction
  Profile,  ///< each waypoint moves once, by the error that photographs of other cuts showed in its direction
};
inline constexpr std::array<std::string_view, 3> kCompensationMethodNames{"default", "paper", "profile"};
[[nodiscard]] constexpr Names names_of(CompensationMethod) {
  return kCompensationMethodNames;
}

/// How the path is corrected.
struct CompensationChoice {
  CompensationMethod method = CompensationMethod::Default;
  ContourKind observable = ContourKind::Centerline;
  double bias_mm = 0.0;
  double simulated_share = 1.0;
  std::vector<double> residual_mm;
  std::vector<double> photographed_mm;
};
inline void describe(Visitor& v, CompensationChoice& m) {
  v("method", m.method,
    "default: pass by pass until the simulated cut lies where it was intended; paper: each waypoint moves once by the "
    "error simulated there; profile: each waypoint moves once by photographed_mm, and simulation only verifies the "
    "path.");
  v("observable", m.observable,
    "Line of the cut that the default method brings to its target; the paper's method uses the mid-line.");
  v({"bias_mm",
     "Expected error of the real cut minus that of the simulated one; positive: farther out. Default method only.",
     "mm"},
    m.bias_mm, {-10.0, 10.0});
  v("simulated_share", m.simulated_share,
    "Expected error of a real cut along the planned path per simulated error, bias included; default method only. "
    "1: as simulated; 0: residual_mm alone, whatever is simulated.",
    {-1.0, 3.0});
  v({"residual_mm",
     "Expected error of the real cut beyond that share, by direction from the middle of the tumour edge; positive: "
     "farther out. Default method only. A list of one number, or of one for each of up to 360 sectors of equal angle, "
     "the first about plan.start_direction, then counter-clockwise as seen along the approach. Empty: none.",
     "mm"},
    m.residual_mm, {-10.0, 10.0});
  v({"photographed_mm",
     "Expected error of the real cut along the planned path, by direction as in residual_mm; method profile only.",
     "mm"},
    m.photographed_mm, {-10.0, 10.0});
}
/// Returns every violation: lists that are too long or missing, and fields that the method does not use:
/// photographed_mm, residual_mm, simulated_share, and bias_mm with method profile.
[[nodiscard]] std::vector<Problem> validate(const CompensationChoice& choice);
/// Returns whether the choice expects errors of the planned path by direction. These hold for a ring as planned, and
/// for no other path.
[[nodiscard]] bool expects_by_direction(const CompensationChoice& choice);

/// Settings of a study, independent of files. Every default is here or in the structs that it contains.
struct Case {
  std::string title = "Incision study";
  std::string specimen_id;  ///< see io/specimen_id.hpp; empty: follows from the scan or mesh
  bool is_virtual = false;  ///< the specimen is synthetic; stated on every page made of it
  SegmentationSettings segmentation;
  MeshingChoice meshing;
  Material material;
  MaterialVariation variation;
  std::optional<std::vector<Constraint>> constraints;  ///< absent: see default_constraints
  Vec3 gravity_mm_s2{0.0, 0.0, -9810.0};
  std::optional<double> time_since_stretch_s;  ///< from stretch to cut, for viscous tissue; absent: it has relaxed
  TumorConfiguration tumor_configuration = TumorConfiguration::Stretched;
  double surface_tolerance_mm = 5.0;        ///< farthest that a tumour edge may lie off the surface, along the approach
  PlanSettings plan;
  Tool tool;
  CutSettings cut;  ///< without its power, which is in plan
  ToughnessVariation toughness;
  ThermalSettings thermal;
  CompensationChoice compensation;
  double close_margin_mm =
      kCloseMarginMm;               ///< clinical cut-off below which a negative margin is too close (paper III-A.1)
  int frames = 24;                  ///< moments of the cut that are kept for pictures
  std::optional<Mat4> T_robot_sim;  ///< place of the specimen in the robot's base frame; rigid, mm; absent: no program
  std::optional<Mat4> T_flange_tool;  ///< the needle's tip (z along the needle); absent: 150 mm before the flange
};

/// Name of the cell array of Young's modulus, kPa, that lay_on_mesh (material_sources.hpp) sets.
inline constexpr const char* kLaidModulusArray = "laid_modulus_kpa";

/// Returns every violation of the material and its variation: numbers out of range, and settings without effect.
[[nodiscard]] std::vector<Problem> validate(const Material& material, const MaterialVariation& variation);

/// Returns the material of each tet, as far as the study varies it; empty lists if nothing varies. Values laid on the
/// mesh override the mesh's own, and labels override both.
/// @throws InvalidArgument for a stiff tumour that was not laid on the mesh;
/// @throws CaseError (field specimen.material.from_mesh or .labels[i]) if the mesh lacks data that the study requires;
/// (.fibre_field…) if the mesh has fibres already, if the field's regions do not fit the mesh (fibre_directions), or if
/// its potential does not converge; (other fields of specimen.material) for violations of validate.
[[nodiscard]] MaterialField material_field(const TetMesh& mesh, const Material& material, const MaterialVariation& variation);

/// Returns the toughness of each tet, relative to the reference tissue; an empty list if the study does not vary it.
/// @throws CaseError (field cut.toughness_from_mesh or cut.toughness[i]) if the mesh lacks data that the study
/// requires, or has a number that is not above 0.
[[nodiscard]] std::vector<double> toughness_of(const TetMesh& mesh, const ToughnessVariation& variation);

/// Returns the paper's set-up (II-A) for a tongue in LPS: posterior 15 mm clamped, anterior 10 mm pulled 20 mm forward,
/// underside resting on a platform at the mesh's lowest point.
/// @throws CaseError for a body shorter than 40 mm along y, to which these lengths do not apply.
[[nodiscard]] std::vector<Constraint> default_constraints(const TetMesh& mesh);
/// Describes these constraints in a sentence without its full stop: "The back end (15 mm) is clamped, …".
[[nodiscard]] std::string default_hold_in_words();

}  // namespace incise
