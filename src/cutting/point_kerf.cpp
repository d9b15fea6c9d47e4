#include "point_kerf.hpp"

#include "dose_field.hpp"
#include "tet_clip.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/iso_surface.hpp>

#include <algorithm>
#include <set>

namespace incise {
namespace {

/// The six tets of Kuhn's division of a cell, by its corners (bit a of a number: one step along axis a).
constexpr std::array<std::array<std::size_t, 4>, 6> kKuhn{
    {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}}};

struct DosedPlace {
  Vec3 at;
  double dose;
};

/// The part of a tet in which the dose, linear in it, is at least 1.
void add_part(const std::array<Vec3, 4>& at, const std::array<double, 4>& dose,
              std::vector<std::array<Vec3, 4>>& tets) {
  std::vector<DosedPlace> inside, outside;
  for (std::size_t c = 0; c < 4; ++c) (dose[c] >= 1.0 ? inside : outside).push_back({at[c], dose[c]});
  const auto crossing = [](const DosedPlace& from, const DosedPlace& to) {
    return DosedPlace{from.at + (1.0 - from.dose) / (to.dose - from.dose) * (to.at - from.at), 1.0};
  };
  clip_tet(inside, outside, crossing, [&](const std::array<DosedPlace, 4>& tet) {
    tets.push_back({tet[0].at, tet[1].at, tet[2].at, tet[3].at});
  });
}

}  // namespace

PointKerf::PointKerf(const TissueModel& model, const PointLattice& lattice, const CutPoints& points,
                     std::span<const Vec3> positions)
    : model_(model), points_(points), positions_(positions), lattice_(lattice) {
  points_at_.reserve(lattice_.size());
  for (std::size_t i = 0; i < lattice_.size(); ++i) {
    if (lattice_.node_of(i)) points_at_.emplace(*lattice_.node_of(i), i);
  }
}

PointKerf::Corner PointKerf::corner(const PointLattice::Node& node) const {
  const auto found = points_at_.find(node);
  if (found == points_at_.end()) return {0.0, Vec3::Zero(), false};
  const std::size_t point = found->second;
  return {dose_of(point), lattice_.position(point, positions_) - lattice_.position(point, model_.mesh.vertices), true};
}

double PointKerf::dose_of(std::size_t point) const {
  return std::min(DoseField::kMostDose, points_.dose[point]);
}

PointKerf::Cell PointKerf::cell(const PointLattice::Node& low) const {
  Cell cell;
  std::array<Corner, 8> corners;
  Vec3 mean = Vec3::Zero();
  int known = 0;
  for (std::size_t c = 0; c < 8; ++c) {
    corners[c] = corner(PointLattice::corner_of(low, c));
    cell.doses[c] = corners[c].dose;
    if (!corners[c].is_known) continue;
    mean += corners[c].displacement;
    ++known;
  }
  if (known > 0) mean /= known;
  for (std::size_t c = 0; c < 8; ++c) {
    cell.at[c] = PointLattice::rest_position(PointLattice::corner_of(low, c)) +
                 (corners[c].is_known ? corners[c].displacement : mean);
  }
  return cell;
}

std::vector<std::array<Vec3, 4>> PointKerf::tets() const {
  std::set<PointLattice::Node> cells;
  for (const auto& [node, point] : points_at_) {
    if (points_.dose[point] < 1.0) continue;
    for (std::size_t c = 0; c < 8; ++c) cells.insert(PointLattice::corner_of(node, c, -1));
  }
  // The list is long: it does not grow as it is filled.
  constexpr std::array<std::size_t, 5> kParts{0, 1, 3, 3, 1};  // of a tet with so many corners in the kerf
  std::size_t count = 0;
  for (const PointLattice::Node& low : cells) {
    std::array<bool, 8> is_in;
    for (std::size_t c = 0; c < 8; ++c) {
      const auto found = points_at_.find(PointLattice::corner_of(low, c));
      is_in[c] = found != points_at_.end() && dose_of(found->second) >= 1.0;
    }
    for (const auto& tet : kKuhn)
      count += kParts[static_cast<std::size_t>(std::ranges::count_if(tet, [&](std::size_t c) { return is_in[c]; }))];
  }
  std::vector<std::array<Vec3, 4>> result;
  result.reserve(count);
  for (const PointLattice::Node& low : cells) {
    const auto [doses, at] = cell(low);
    for (const auto& [a, b, c, d] : kKuhn)
      add_part({at[a], at[b], at[c], at[d]}, {doses[a], doses[b], doses[c], doses[d]}, result);
  }
  INCISE_ASSERT(result.size() == count);
  return result;
}

TriMesh PointKerf::surface() const {
  Box3 box;
  for (const auto& [node, point] : points_at_) {
    if (points_.dose[point] < 1.0) continue;
    box.extend(Vec3(node[0], node[1], node[2]));
  }
  if (box.isEmpty()) return {};
  GrayVolume doses;
  const Eigen::Array3i low = box.min().array().cast<int>() - 1, size = box.max().array().cast<int>() + 2 - low;
  doses.grid.size = {size[0], size[1], size[2]};
  doses.grid.origin_mm = low.matrix().cast<double>();
  doses.voxels.assign(doses.grid.voxel_count(), 0.0F);
  for (const auto& [node, point] : points_at_) {
    if (!doses.grid.contains(node[0] - low[0], node[1] - low[1], node[2] - low[2])) continue;
    doses.voxels[doses.grid.offset(node[0] - low[0], node[1] - low[1], node[2] - low[2])] =
        static_cast<float>(std::min(DoseField::kMostDose, points_.dose[point]));
  }
  TriMesh surface = iso_surface(doses, 1.0);
  for (Vec3& v : surface.vertices) {
    const Vec3 floor = v.array().floor();
    const PointLattice::Node node{static_cast<int>(floor.x()), static_cast<int>(floor.y()),
                                  static_cast<int>(floor.z())};
    const std::array<Vec3, 8> at = cell(node).at;
    const Vec3 t = v - floor;
    Vec3 sum = Vec3::Zero();
    for (std::size_t c = 0; c < 8; ++c) sum += PointLattice::corner_weight(c, t) * at[c];
    v = sum;
  }
  return surface;
}

}  // namespace incise
