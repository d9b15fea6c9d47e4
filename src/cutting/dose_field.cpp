#include "dose_field.hpp"

#include <algorithm>

namespace incise {

DoseField::DoseField(const PointLattice& lattice, const CutPoints& points) : points_(points) {
  for (std::size_t i = 0; i < lattice.size(); ++i) {
    if (lattice.node_of(i)) point_at_.emplace(*lattice.node_of(i), i);
  }
}

double DoseField::at(const Vec3& rest) const {
  const PointLattice::Node low = PointLattice::cell_of(rest);
  const Vec3 t = (rest - PointLattice::rest_position(low)) / PointLattice::kSpacingMm;
  double sum = 0.0, weights = 0.0;
  for (std::size_t c = 0; c < 8; ++c) {
    const auto found = point_at_.find(PointLattice::corner_of(low, c));
    if (found == point_at_.end()) continue;
    const double weight = PointLattice::corner_weight(c, t);
    sum += weight * std::min(kMostDose, points_.dose[found->second]);
    weights += weight;
  }
  return weights > 0.0 ? sum / weights : 0.0;
}

std::optional<std::int32_t> DoseField::parted_step_near(const Vec3& rest) const {
  constexpr int kReach = 3;
  double least = 0.5 * 0.5;
  std::optional<std::int32_t> step;
  const PointLattice::Node middle = PointLattice::node_near(rest);
  for (int k = -kReach; k <= kReach; ++k)
    for (int j = -kReach; j <= kReach; ++j)
      for (int i = -kReach; i <= kReach; ++i) {
        const PointLattice::Node node{middle[0] + i, middle[1] + j, middle[2] + k};
        const auto found = point_at_.find(node);
        if (found == point_at_.end() || points_.parted_step[found->second] < 0) continue;
        const double apart = (PointLattice::rest_position(node) - rest).squaredNorm();
        if (apart > least) continue;
        least = apart;
        step = points_.parted_step[found->second];
      }
  return step;
}

}  // namespace incise
