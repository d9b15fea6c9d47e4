#include "virtual_bench/electrode.hpp"

#include <algorithm>

namespace incise {

double Electrode::distance_mm(const Vec3& p) const {
  const double up = std::clamp(-(p - tip_mm).dot(axis), 0.0, kLengthMm);
  return (p - (tip_mm - up * axis)).norm();
}

double kernel(double distance_mm, double reach_mm) {
  if (distance_mm >= reach_mm) return 0.0;
  const double inside = 1.0 - distance_mm * distance_mm / (reach_mm * reach_mm);
  return inside * inside;
}

const std::array<std::array<double, 4>, 4>& quadrature() {
  constexpr double a = 0.58541019662496845446;  // (5 + 3 sqrt 5) / 20
  constexpr double b = 0.13819660112501051518;  // (5 - sqrt 5) / 20
  static constexpr std::array<std::array<double, 4>, 4> kPoints{
      {{a, b, b, b}, {b, a, b, b}, {b, b, a, b}, {b, b, b, a}}};
  return kPoints;
}

Vec3 point_in(const TetMesh& mesh, std::span<const Vec3> positions, std::size_t tet,
              const std::array<double, 4>& weights) {
  Vec3 p = Vec3::Zero();
  for (std::size_t a = 0; a < 4; ++a) p += weights[a] * positions[mesh.tets[tet][a].index()];
  return p;
}

std::vector<std::size_t> tets_in_reach(const TetMesh& mesh, const TissueState& state, const Electrode& electrode,
                                       double extra_mm) {
  const double reach = Electrode::kDragReachMm + extra_mm;
  std::vector<std::size_t> found;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (state.is_live[t] == 0) continue;
    // The distance of one corner excludes most of the body: a quadrature point lies within the tet's size of it.
    const Vec3& corner = state.positions[mesh.tets[t][0].index()];
    if (electrode.distance_mm(corner) > reach + 3.0) continue;
    const bool is_in_reach = std::ranges::any_of(quadrature(), [&](const auto& weights) {
      return !(electrode.distance_mm(point_in(mesh, state.positions, t, weights)) > reach);
    });
    if (is_in_reach) found.push_back(t);
  }
  return found;
}

}  // namespace incise
