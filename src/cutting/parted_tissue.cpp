#include "parted_tissue.hpp"

#include <cmath>
#include <limits>

namespace incise {

PartedTissue::PartedTissue(const TissueModel& whole, const PointLattice& lattice, std::span<const Vec3> from,
                           const CutState& state)
    : whole_(whole),
      from_(from),
      state_(state),
      split_(split_mesh(whole.mesh, state.splits)),
      lattice_(lattice),
      locator_(whole.mesh, from) {
  for (std::size_t i = 0; i < lattice_.size(); ++i) {
    const bool is_live = state.tissue.is_live[state.points.tet_of[i].index()] != 0;
    if (state.points.dose[i] >= 1.0 || !is_live || lattice_.volume_mm3(i) == 0.0) continue;
    near_node_[PointLattice::node_near(lattice_.rest_position(i))].push_back(i);
  }
}

std::optional<std::size_t> PartedTissue::nearest_point(const Vec3& rest, double within_mm) const {
  const PointLattice::Node middle = PointLattice::node_near(rest);
  const int reach = static_cast<int>(std::ceil(within_mm / PointLattice::kSpacingMm)) + 1;
  std::optional<std::size_t> nearest;
  double least = within_mm;
  const auto look_at = [&](const PointLattice::Node& node) {
    const auto found = near_node_.find(node);
    if (found == near_node_.end()) return;
    for (const std::size_t point : found->second) {
      const double apart = (lattice_.rest_position(point) - rest).norm();
      if (apart > least) continue;
      least = apart;
      nearest = point;
    }
  };
  // A point in shell s is at least s - 1 spacings away.
  for (int shell = 0; shell <= reach && (shell - 1) * PointLattice::kSpacingMm <= least; ++shell) {
    for (int k = -shell; k <= shell; ++k)
      for (int j = -shell; j <= shell; ++j) {
        const bool is_side = std::abs(k) == shell || std::abs(j) == shell;
        for (int i = -shell; i <= shell; i += is_side ? 1 : 2 * shell)
          look_at({middle[0] + i, middle[1] + j, middle[2] + k});
      }
  }
  return nearest;
}

std::optional<Vec3> PartedTissue::place_after(const Vec3& p, double tolerance_mm) const {
  if (const std::optional<Vec3> moved = displacement(p, tolerance_mm)) return p + *moved;
  std::optional<EmbeddedPoint> at = locator_.locate(p, tolerance_mm);
  if (!at) return std::nullopt;
  const Vec3 rest = position_of(*at, whole_.mesh, whole_.mesh.vertices);
  const auto [first, last] = lattice_.points_of(at->tet);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = first; i < last; ++i) {
    const double apart = (lattice_.rest_position(i) - rest).norm();
    if (apart >= least) continue;
    least = apart;
    at->tet = state_.points.tet_of[i];
  }
  return position_of(*at, split_, state_.tissue.positions);
}

std::optional<Vec3> PartedTissue::displacement(const Vec3& p, double tolerance_mm) const {
  const std::optional<EmbeddedPoint> at = locator_.locate(p, tolerance_mm);
  if (!at) return std::nullopt;
  const auto [first, last] = lattice_.points_of(at->tet);
  const Points& to = state_.tissue.positions;
  if (first == last) {  // the tool did not come near
    if (state_.tissue.is_live[at->tet.index()] == 0) return std::nullopt;
    return position_of(*at, split_, to) - position_of(*at, whole_.mesh, from_);
  }
  const Vec3 rest = position_of(*at, whole_.mesh, whole_.mesh.vertices);
  const std::optional<std::size_t> point = nearest_point(rest, tolerance_mm);
  if (!point) return std::nullopt;
  const TetId whole_tet = lattice_.tet_of(*point);
  EmbeddedPoint there{whole_tet, barycentric_at_rest(whole_, whole_tet, rest)};
  const Vec3 before = position_of(there, whole_.mesh, from_);
  there.tet = state_.points.tet_of[*point];
  return position_of(there, split_, to) - before;
}

}  // namespace incise
