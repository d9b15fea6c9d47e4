#include <incise/core/error.hpp>
#include <incise/mechanics/material.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {

std::vector<std::string> validate(const Material& material) {
  std::vector<std::string> violations;
  const auto check_positive = [&](const char* name, double value) {
    if (std::isfinite(value) && value > 0.0) return;
    violations.push_back(fmt::format("{}: found {}, expected a finite number above 0", name, value));
  };
  check_positive("youngs_modulus_kpa", material.youngs_modulus_kpa);
  const double nu = material.poissons_ratio;
  if (!(nu >= 0.0 && nu < 0.5)) {
    violations.push_back(fmt::format("poissons_ratio: found {}, expected a number in [0, 0.5)", nu));
  }
  check_positive("density_kg_m3", material.density_kg_m3);
  return violations;
}

LameParameters lame_parameters(double youngs_modulus_kpa, double poissons_ratio) {
  INCISE_REQUIRE(std::isfinite(youngs_modulus_kpa) && youngs_modulus_kpa > 0.0,
                 fmt::format("expected a Young's modulus above 0 kPa, found {}", youngs_modulus_kpa));
  INCISE_REQUIRE(poissons_ratio >= 0.0 && poissons_ratio < 0.5,
                 fmt::format("expected a Poisson's ratio in [0, 0.5), found {}", poissons_ratio));
  LameParameters lame;
  lame.lambda_kpa = youngs_modulus_kpa * poissons_ratio / ((1.0 + poissons_ratio) * (1.0 - 2.0 * poissons_ratio));
  lame.mu_kpa = youngs_modulus_kpa / (2.0 * (1.0 + poissons_ratio));
  return lame;
}

}  // namespace incise
