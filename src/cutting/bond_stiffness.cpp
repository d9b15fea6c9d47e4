#include "bond_stiffness.hpp"

#include <cmath>

namespace incise {

double resolved_bond_stiffness(double kappa_kpa_mm2, double mu_kpa, double edge_mm) {
  // The positive root, in a form without cancellation for fine meshes.
  return 2.0 * kappa_kpa_mm2 / (1.0 + std::sqrt(1.0 + kappa_kpa_mm2 * edge_mm * edge_mm / (3.0 * mu_kpa)));
}

}  // namespace incise
