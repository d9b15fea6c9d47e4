#include "point_lattice.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr std::size_t kLeastNodes = 4;  // of a tet, for them to represent its volume
// Off the planes in which meshes of blocks have their faces, so no node lies on a face.
const Vec3 kOriginMm(0.0371, 0.0613, 0.0887);
// Four-point quadrature of degree 2: (5 + 3 √5)/20 and (5 − √5)/20.
constexpr double kNear = 0.5854101966249685, kFar = 0.1381966011250105;

}  // namespace

std::array<double, 4> barycentric_at_rest(const TissueModel& model, TetId tet, const Vec3& rest) {
  const Vec3 from_origin = rest - vertex(model.mesh.vertices, model.mesh.tets[tet.index()][0]);
  std::array<double, 4> shares{1.0, 0.0, 0.0, 0.0};
  for (std::size_t c = 1; c < 4; ++c) {
    shares[c] = model.gradients[tet.index()][c].dot(from_origin);
    shares[0] -= shares[c];
  }
  return shares;
}

Vec3 PointLattice::rest_position(const Node& node) {
  return kOriginMm + kSpacingMm * Vec3(node[0], node[1], node[2]);
}

PointLattice::Node PointLattice::node_near(const Vec3& rest) {
  const Vec3 at = (rest - kOriginMm) / kSpacingMm;
  const auto nearest = [](double x) { return static_cast<std::int32_t>(std::lround(x)); };
  return {nearest(at.x()), nearest(at.y()), nearest(at.z())};
}

PointLattice::Node PointLattice::cell_of(const Vec3& rest) {
  const Eigen::Array3i low = ((rest - kOriginMm) / kSpacingMm).array().floor().cast<int>();
  return {low[0], low[1], low[2]};
}

PointLattice::Node PointLattice::corner_of(Node node, std::size_t corner, int by) {
  for (std::size_t a = 0; a < 3; ++a) node[a] += (corner >> a & 1U) != 0 ? by : 0;
  return node;
}

double PointLattice::corner_weight(std::size_t corner, const Vec3& t) {
  double weight = 1.0;
  for (std::size_t a = 0; a < 3; ++a) {
    const double along = t[static_cast<Eigen::Index>(a)];
    weight *= (corner >> a & 1U) != 0 ? along : 1.0 - along;
  }
  return weight;
}

PointLattice::PointLattice(const TissueModel& model, std::span<const TetId> tets)
    : model_(&model), first_(model.mesh.tets.size(), -1), count_(model.mesh.tets.size(), 0) {
  for (const TetId tet : tets) add(tet);
}

void PointLattice::add(TetId tet) {
  const Tet& corners = model_->mesh.tets[tet.index()];
  Box3 box;
  for (const VertexId v : corners) box.extend((vertex(model_->mesh.vertices, v) - kOriginMm) / kSpacingMm);
  const std::size_t first = shares_.size();
  const Eigen::Array3i low = box.min().array().ceil().cast<int>(), high = box.max().array().floor().cast<int>();
  for (int k = low[2]; k <= high[2]; ++k)
    for (int j = low[1]; j <= high[1]; ++j)
      for (int i = low[0]; i <= high[0]; ++i) {
        const std::array<double, 4> shares = barycentric_at_rest(*model_, tet, rest_position({i, j, k}));
        if (std::ranges::any_of(shares, [](double share) { return share < 0.0; })) continue;
        shares_.push_back(shares);
        nodes_.emplace_back(Node{i, j, k});
      }
  const std::size_t nodes = shares_.size() - first;
  if (nodes < kLeastNodes) {
    for (std::size_t c = 0; c < 4; ++c) {
      std::array<double, 4> shares;
      shares.fill(kFar);
      shares[c] = kNear;
      shares_.push_back(shares);
    }
  }
  tets_.resize(shares_.size(), tet);
  nodes_.resize(shares_.size());
  const double volume = model_->volumes_mm3[tet.index()];
  const bool has_own = nodes < kLeastNodes;
  volumes_.resize(first + nodes, has_own ? 0.0 : volume / static_cast<double>(nodes));
  volumes_.resize(shares_.size(), 0.25 * volume);
  added_.push_back(tet);
  first_[tet.index()] = static_cast<std::int64_t>(first);
  count_[tet.index()] = static_cast<std::int32_t>(shares_.size() - first);
}

std::pair<std::size_t, std::size_t> PointLattice::points_of(TetId tet) const {
  if (first_[tet.index()] < 0) return {0, 0};
  const auto first = static_cast<std::size_t>(first_[tet.index()]);
  return {first, first + static_cast<std::size_t>(count_[tet.index()])};
}

Vec3 PointLattice::position(std::size_t point, std::span<const Vec3> positions) const {
  const Tet& corners = model_->mesh.tets[tets_[point].index()];
  Vec3 sum = Vec3::Zero();
  for (std::size_t c = 0; c < 4; ++c) sum += shares_[point][c] * vertex(positions, corners[c]);
  return sum;
}

PointLattice::PointLattice(const TissueModel& split, const CutPoints& points, const MeshSplits& splits)
    : PointLattice(lattice_of(split, points)) {
  follow(split, points, splits);
}

void PointLattice::follow(const TissueModel& split, const CutPoints& points, const MeshSplits& splits) {
  model_ = &split;
  first_.resize(split.mesh.tets.size(), -1);
  count_.resize(split.mesh.tets.size(), 0);
  const std::size_t whole = split.mesh.tets.size() - splits.copies.size();
  for (std::size_t i = 0; i < splits.copies.size(); ++i) {
    first_[whole + i] = first_[splits.copies[i].whole.index()];
    count_[whole + i] = count_[splits.copies[i].whole.index()];
  }
  require_own_tets(points, splits, whole);
  tets_ = points.tet_of;
}

void PointLattice::require_own_tets(const CutPoints& points, const MeshSplits& splits, std::size_t whole) const {
  const std::size_t count = whole + splits.copies.size();
  const auto whole_of = [&](TetId t) { return t.index() < whole ? t : splits.copies[t.index() - whole].whole; };
  for (std::size_t i = 0; i < tets_.size(); ++i) {
    const TetId tet = points.tet_of[i];
    const bool is_own = tet.is_valid() && tet.index() < count && whole_of(tet) == whole_of(tets_[i]);
    INCISE_REQUIRE(is_own,
                   fmt::format("points: expected point {} in its tet or in a copy of it, found tet {}", i, tet.value));
  }
}

PointLattice lattice_of(const TissueModel& whole, const CutPoints& points) {
  for (const TetId tet : points.tets)
    INCISE_REQUIRE(tet.is_valid() && tet.index() < whole.mesh.tets.size(),
                   fmt::format("points: expected one of {} tets, found {}", whole.mesh.tets.size(), tet.value));
  PointLattice lattice(whole, points.tets);
  for (const std::size_t found : {points.tet_of.size(), points.dose.size(), points.is_held.size(),
                                  points.offset_mm.size(), points.parted_step.size(), points.parted_mm.size()}) {
    INCISE_REQUIRE(found == lattice.size(),
                   fmt::format("points: expected {} items in every list, found {}", lattice.size(), found));
  }
  return lattice;
}

}  // namespace incise
