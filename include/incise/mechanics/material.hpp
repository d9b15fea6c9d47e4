#pragma once

#include <incise/core/names.hpp>
#include <incise/core/problem.hpp>
#include <incise/geometry/tet_mesh.hpp>
#include <incise/geometry/types.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise {

enum class MaterialModel {
  Corotational,      ///< linear elasticity in a frame that turns with each tet (polar rotation), as in the paper
  StableNeoHookean,  ///< Smith, de Goes and Kim (2018): hyperelastic, defined for inverted tets too
};
inline constexpr std::array<std::string_view, 2> kMaterialModelNames{"corotational", "stable_neo_hookean"};
[[nodiscard]] constexpr Names names_of(MaterialModel) {
  return kMaterialModelNames;
}

/// How the change of volume enters the energy.
enum class VolumeTreatment {
  PerTet,    ///< each tet resists its own: the standard linear tet, which locks as Poisson's ratio nears 0.5
  Averaged,  ///< each vertex resists the mean over its tets (Bonet and Burton 1998): free of volumetric locking
};
inline constexpr std::array<std::string_view, 2> kVolumeTreatmentNames{"per_tet", "averaged"};
[[nodiscard]] constexpr Names names_of(VolumeTreatment) {
  return kVolumeTreatmentNames;
}

/// One Maxwell branch beside the elastic law: a shear spring that lets go with time.
struct PronyTerm {
  double shear_share = 0.0;  ///< its shear modulus over the long-time one, > 0
  double time_s = 1.0;       ///< relaxation time, > 0
};
inline void describe(Visitor& v, PronyTerm& t) {
  v("shear_share", t.shear_share, "Shear modulus of the branch over the long-time one.", {0.0, 1e6, true});
  v({"time_s", "Relaxation time.", "s"}, t.time_s, kPositive);
}

/// Young's modulus and density must lie in [least, most] and (0, most]. Far beyond any tissue, and wide enough for bodies in
/// units of their own, but products with lengths and volumes stay far from the ends of double precision.
inline constexpr double kLeastYoungsModulusKpa = 1e-6;
inline constexpr double kMostYoungsModulusKpa = 1e9;
inline constexpr double kMostDensityKgM3 = 1e9;
inline constexpr Range kYoungsModulusLimits{kLeastYoungsModulusKpa, kMostYoungsModulusKpa};
inline constexpr Range kPoissonsRatioLimits{0.0, 0.5, false, true};
/// Far beyond any tissue: fibres of the greatest stiffening pull 148 times as hard as linear ones at a strain of 7 %.
inline constexpr Range kStiffeningLimits{0.0, 100.0};
inline constexpr Range kFibreStiffeningLimits{0.0, 1000.0};

/// What tissue is made of. Defaults are the paper's (II-C.3); 70 kPa is an effective value, ~10 x published tongue
/// stiffness.
struct Material {
  MaterialModel model = MaterialModel::Corotational;
  VolumeTreatment volume = VolumeTreatment::PerTet;
  double youngs_modulus_kpa = 70.0;       ///< [1e-6, 1e9]; of the long-time response where there are Prony terms
  double poissons_ratio = 0.49;           ///< [0, 0.5)
  double stiffening = 0.0;                ///< [0, 100]; c20/c10 of Yeoh's law, 0: none; StableNeoHookean alone
  double density_kg_m3 = 1040.0;          ///< (0, 1e9]
  double fibre_modulus_kpa = 0.0;         ///< >= 0; stiffness added along the fibres, 0: isotropic
  double fibre_stiffening = 0.0;          ///< [0, 1000]; in the exponent of the fibres' energy, 0: linear fibres
  Vec3 fibre_direction = Vec3::UnitY();   ///< at rest, any length but 0; where no field gives another
  std::vector<PronyTerm> prony;           ///< viscosity acts only in steps of time: statics are its long-time limit
  double kelvin_voigt_time_s = 0.0;       ///< >= 0; shear viscosity over long-time shear modulus, 0: none
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
    "tongues; 0: it does not. For model stable_neo_hookean.",
    kStiffeningLimits);
  v({"density_kg_m3", "Density.", "kg/m3"}, m.density_kg_m3, {0.0, kMostDensityKgM3, true});
  v({"fibre_modulus_kpa", "Stiffness added along the fibres; 0: none.", "kPa"}, m.fibre_modulus_kpa,
    {0.0, kYoungsModulusLimits.most});
  v("fibre_stiffening", m.fibre_stiffening,
    "How fibres stiffen as they are stretched: s in E_f/(2s) (exp(s e^2) - 1), with the strain e; 0: they do not.",
    kFibreStiffeningLimits);
  v.direction("fibre_direction", m.fibre_direction,
              "Of the fibres at rest, where neither the mesh nor fibre_field gives one.");
  v("prony", m.prony,
    "Branches that relax with time, during the cut; the stretch is their long-time limit. Absent: none.");
  v({"kelvin_voigt_time_s", "Shear viscosity over long-time shear modulus, during the cut; 0: none.", "s"},
    m.kelvin_voigt_time_s, {0.0, 1e6});
}

/// Every number out of its range, and stiffening that would not act.
[[nodiscard]] std::vector<Problem> validate(const Material& m);

/// Whether a material has Prony terms or a damper.
[[nodiscard]] inline bool is_viscous(const Material& m) {
  return !m.prony.empty() || m.kelvin_voigt_time_s > 0.0;
}
/// How many Prony terms a viscous material has; nothing of another.
[[nodiscard]] inline std::optional<std::size_t> viscous_terms(const Material& m) {
  return is_viscous(m) ? std::optional(m.prony.size()) : std::nullopt;
}

/// What differs from tet to tet, one item per tet each; an empty list takes the material's own value everywhere.
struct MaterialField {
  std::vector<double> youngs_modulus_kpa;
  std::vector<double> poissons_ratio;
  std::vector<Vec3> fibre_directions;
  std::vector<double> toughness;  ///< how much more it takes to cut a tet than one of the reference tissue, > 0; of itself 1
};

/// The fields of elasticity that a mesh carries as cell data: `youngs_modulus_kpa`, `poissons_ratio` (1 component),
/// `fibre_direction` (3).
/// @throws InvalidArgument for an array of another number of components, see malformed_material_array.
[[nodiscard]] MaterialField material_field_of(const TetMesh& mesh);
/// The first of these arrays that has another number of components; nothing: none has.
[[nodiscard]] std::optional<Problem> malformed_material_array(const TetMesh& mesh);

/// The same for a field of `tets` items; one at most for each array.
[[nodiscard]] std::vector<Problem> validate(const MaterialField& field, std::size_t tets);

struct LameParameters {
  double lambda_kpa = 0.0;
  double mu_kpa = 0.0;
};
/// λ = E ν / ((1 + ν)(1 − 2ν)), μ = E / (2 (1 + ν)).
[[nodiscard]] LameParameters lame_parameters(double youngs_modulus_kpa, double poissons_ratio);

}  // namespace incise
