#pragma once

#include <incise/core/names.hpp>
#include <incise/core/problem.hpp>
#include <incise/geometry/tet_mesh.hpp>
#include <incise/geometry/types.hpp>

#include <optional>
#include <vector>

namespace incise {

enum class MaterialModel {
  Corotational,      ///< linear elasticity in a frame that rotates with each tet (polar rotation), as in the paper
  StableNeoHookean,  ///< Smith, de Goes and Kim (2018): hyperelastic, defined for inverted tets too
};
inline constexpr std::array<std::string_view, 2> kMaterialModelNames{"corotational", "stable_neo_hookean"};
[[nodiscard]] constexpr Names names_of(MaterialModel) {
  return kMaterialModelNames;
}

/// How the change of volume enters the energy.
enum class VolumeTreatment {
  PerTet,    ///< each tet resists its own change: the standard linear tet, which locks as Poisson's ratio nears 0.5
  Averaged,  ///< each vertex resists the mean change of its tets (Bonet and Burton 1998): no volumetric locking
};
inline constexpr std::array<std::string_view, 2> kVolumeTreatmentNames{"per_tet", "averaged"};
[[nodiscard]] constexpr Names names_of(VolumeTreatment) {
  return kVolumeTreatmentNames;
}

/// One Maxwell branch, parallel to the elastic law: a shear spring whose stress relaxes with time.
struct PronyTerm {
  double shear_share = 0.0;  ///< shear modulus of the branch divided by the long-time one, > 0
  double time_s = 1.0;       ///< relaxation time, > 0
};
inline void describe(Visitor& v, PronyTerm& t) {
  v("shear_share", t.shear_share, "Shear modulus of the branch over the long-time one.", {0.0, 1e6, true});
  v({"time_s", "Relaxation time.", "s"}, t.time_s, kPositive);
}

/// Young's modulus must lie in [least, most], density in (0, most]. The limits are far beyond any tissue, so they also
/// admit bodies in other units; products with lengths and volumes still stay well within double precision.
inline constexpr double kLeastYoungsModulusKpa = 1e-6;
inline constexpr double kMostYoungsModulusKpa = 1e9;
inline constexpr double kMostDensityKgM3 = 1e9;
inline constexpr Range kYoungsModulusLimits{kLeastYoungsModulusKpa, kMostYoungsModulusKpa};
inline constexpr Range kPoissonsRatioLimits{0.0, 0.5, false, true};
/// Far beyond any tissue.
inline constexpr Range kStiffeningLimits{0.0, 100.0};
/// Far beyond any tissue: at 1000, fibres pull 148 times as hard as linear ones at a strain of 7 %.
inline constexpr Range kFibreStiffeningLimits{0.0, 1000.0};

/// Material of the tissue. The defaults are the paper's (II-C.3); 70 kPa is an effective value, about ten times the
/// published stiffness of the tongue.
struct Material {
  MaterialModel model = MaterialModel::Corotational;
  VolumeTreatment volume = VolumeTreatment::PerTet;
  double youngs_modulus_kpa = 70.0;       ///< [1e-6, 1e9]; with Prony terms: of the long-time response
  double poissons_ratio = 0.49;           ///< [0, 0.5)
  double stiffening = 0.0;                ///< [0, 100]; c20/c10 of Yeoh's law, 0: none; StableNeoHookean only
  double density_kg_m3 = 1040.0;          ///< (0, 1e9]
  double fibre_modulus_kpa = 0.0;         ///< [0, 1e9]; stiffness added along the fibres, 0: isotropic
  double fibre_stiffening = 0.0;          ///< [0, 1000]; s in the fibres' energy E_f/(2s) (exp(s e²) − 1), 0: linear
  Vec3 fibre_direction = Vec3::UnitY();   ///< at rest, any length but 0; a MaterialField overrides it per tet
  std::vector<PronyTerm> prony;           ///< viscosity acts only in time steps; statics give its long-time limit
  double kelvin_voigt_time_s = 0.0;       ///< [0, 1e6]; shear viscosity over long-time shear modulus, 0: none
};
inline void describe(Visitor& v, Material& m) {
  v("model", m.model, "Linear elasticity in a frame that turns with each tet, as in the paper; or a hyperelastic law.");
  v("volume", m.volume,
    "How volume change is resisted: tet by tet (locks as Poisson's ratio nears 0.5), or as a mean about each vertex.");
  v({"youngs_modulus_kpa", "Young's modulus; the paper's 70 is about ten times published tongue stiffness.", "kPa"},
    m.youngs_modulus_kpa, kYoungsModulusLimits);
  v("poissons_ratio", m.poissons_ratio, "Poisson's ratio.", kPoissonsRatioLimits);
  v("stiffening", m.stiffening,
    "How the tissue between the fibres stiffens as it changes its shape: c20/c10 of Yeoh's law, 0.469 in published "
    "tongues; 0: not at all. Only with model stable_neo_hookean.",
    kStiffeningLimits);
  v({"density_kg_m3", "Density.", "kg/m3"}, m.density_kg_m3, {0.0, kMostDensityKgM3, true});
  v({"fibre_modulus_kpa", "Stiffness added along the fibres; 0: none.", "kPa"}, m.fibre_modulus_kpa,
    {0.0, kYoungsModulusLimits.most});
  v("fibre_stiffening", m.fibre_stiffening,
    "How fibres stiffen as they are stretched: s in E_f/(2s) (exp(s e^2) - 1), with the strain e; 0: not at all.",
    kFibreStiffeningLimits);
  v.direction("fibre_direction", m.fibre_direction,
              "Direction of the fibres at rest, where neither the mesh nor fibre_field gives one.");
  v("prony", m.prony,
    "Branches that relax with time, during the cut; the stretch is their long-time limit. Absent: none.");
  v({"kelvin_voigt_time_s", "Shear viscosity over long-time shear modulus, during the cut; 0: none.", "s"},
    m.kelvin_voigt_time_s, {0.0, 1e6});
}

/// Returns every number that is out of range, and every stiffening that has no effect with the other settings; empty:
/// valid.
[[nodiscard]] std::vector<Problem> validate(const Material& m);

/// Whether the material has Prony terms or a Kelvin-Voigt damper.
[[nodiscard]] inline bool is_viscous(const Material& m) {
  return !m.prony.empty() || m.kelvin_voigt_time_s > 0.0;
}
/// Returns the number of Prony terms of a viscous material (0 or more); nullopt for any other material.
[[nodiscard]] inline std::optional<std::size_t> viscous_terms(const Material& m) {
  return is_viscous(m) ? std::optional(m.prony.size()) : std::nullopt;
}

/// Properties that differ from tet to tet. Each list has one item per tet; an empty one means the material's own value
/// everywhere.
struct MaterialField {
  std::vector<double> youngs_modulus_kpa;
  std::vector<double> poissons_ratio;
  std::vector<Vec3> fibre_directions;
  std::vector<double> toughness;  ///< relative to the reference tissue, > 0; empty: 1 everywhere
};

/// Returns the elastic properties that the mesh carries as cell data: `youngs_modulus_kpa`, `poissons_ratio` (1
/// component each) and `fibre_direction` (3). Values are not checked.
/// @throws InvalidArgument if an array has a different number of components (malformed_material_array).
[[nodiscard]] MaterialField material_field_of(const TetMesh& mesh);
/// Returns the first of these arrays that has the wrong number of components; nullopt: none has.
[[nodiscard]] std::optional<Problem> malformed_material_array(const TetMesh& mesh);

/// Returns every problem of a field for a mesh of `tets` tets, at most one per array: a wrong number of items, or the
/// first value out of range. Empty: valid.
[[nodiscard]] std::vector<Problem> validate(const MaterialField& field, std::size_t tets);

struct LameParameters {
  double lambda_kpa = 0.0;
  double mu_kpa = 0.0;
};
/// Returns λ = E ν / ((1 + ν)(1 − 2ν)) and μ = E / (2 (1 + ν)), kPa.
/// @throws InvalidArgument unless E is finite and > 0 and ν lies in [0, 0.5).
[[nodiscard]] LameParameters lame_parameters(double youngs_modulus_kpa, double poissons_ratio);

}  // namespace incise
