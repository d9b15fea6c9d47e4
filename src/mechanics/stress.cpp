#include "mechanics/elastic_response.hpp"
#include "mechanics/rotation.hpp"

#include <incise/mechanics/statics.hpp>

#include <cmath>

namespace incise {

std::vector<double> von_mises_kpa(const TissueModel& model, const TissueState& state) {
  std::vector<double> stress(model.mesh.tets.size(), 0.0);
  for (std::size_t tet = 0; tet < stress.size(); ++tet) {
    if (state.is_live[tet] == 0) continue;
    const Mat3 f = deformation_gradient(model, state.positions, tet);
    const Mat3 s = nearest_rotation(f, state.rotations[tet]).transpose() * f;
    // The deviator of σ = 2μ ε + λ tr ε I is 2μ dev ε, whatever frame it is seen in.
    const Mat3 strain = 0.5 * (s + s.transpose()) - Mat3::Identity();
    const Mat3 deviator = strain - strain.trace() / 3.0 * Mat3::Identity();
    stress[tet] = std::sqrt(1.5) * 2.0 * model.lame[tet].mu_kpa * deviator.norm();
  }
  return stress;
}

}  // namespace incise
