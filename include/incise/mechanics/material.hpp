#pragma once

#include <string>
#include <vector>

namespace incise {

enum class MaterialModel {
  Corotational,  ///< linear elasticity in a frame that turns with each tet (polar rotation), as in the paper
};

/// What tissue is made of. Defaults are the paper's (II-C.3); 70 kPa is an effective value, ~10 x published tongue
/// stiffness.
struct Material {
  MaterialModel model = MaterialModel::Corotational;
  double youngs_modulus_kpa = 70.0;  ///< > 0
  double poissons_ratio = 0.49;      ///< [0, 0.5)
  double density_kg_m3 = 1040.0;     ///< > 0
};

/// Every violation, one sentence each; empty: valid.
[[nodiscard]] std::vector<std::string> validate(const Material& material);

struct LameParameters {
  double lambda_kpa = 0.0;
  double mu_kpa = 0.0;
};
/// λ = E ν / ((1 + ν)(1 − 2ν)), μ = E / (2 (1 + ν)).
[[nodiscard]] LameParameters lame_parameters(double youngs_modulus_kpa, double poissons_ratio);

}  // namespace incise
