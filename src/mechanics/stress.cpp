#include "mechanics/law_response.hpp"
#include "mechanics/rotation.hpp"

#include <incise/mechanics/statics.hpp>

#include <cmath>

namespace incise {
namespace {

/// Returns the Cauchy stress P Fᵀ / J; for the corotational law P Rᵀ, its stress in the rotated frame, for small
/// strains and unchanged areas. P Rᵀ also serves for inverted tets, which have no Cauchy stress.
Mat3 stress_of(MaterialModel model, const Mat3& piola, const Mat3& f, const Mat3& guess) {
  const double j = f.determinant();
  if (model == MaterialModel::StableNeoHookean && j > 0.0) return piola * f.transpose() / j;
  return piola * nearest_rotation(f, guess).transpose();
}

}  // namespace

std::vector<double> von_mises_kpa(const TissueModel& model, const TissueState& state) {
  const std::vector<Mat3> piola = law_stresses_kpa(model, state);
  std::vector<double> result(model.mesh.tets.size(), 0.0);
  for (std::size_t tet = 0; tet < result.size(); ++tet) {
    if (state.is_live[tet] == 0) continue;
    const Mat3 f = deformation_gradient(model, state.positions, tet);
    const Mat3 stress = stress_of(model.material.model, piola[tet], f, state.rotations[tet]);
    const Mat3 symmetric = 0.5 * (stress + stress.transpose());
    const Mat3 deviator = symmetric - symmetric.trace() / 3.0 * Mat3::Identity();
    result[tet] = std::sqrt(1.5) * deviator.norm();
  }
  return result;
}

}  // namespace incise
