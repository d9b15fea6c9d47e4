#pragma once

#include <incise/cutting/cut_points.hpp>
#include <incise/mechanics/tissue.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace incise {

/// The points that carry a cut: the nodes of a cubic lattice in the tissue at rest, each in the tet that holds it. A
/// tet with fewer than four nodes has four points of its own in their place, which are no nodes.
class PointLattice {
 public:
  using Node = std::array<std::int32_t, 3>;
  static constexpr double kSpacingMm = 0.2;

  PointLattice(const TissueModel& model, std::span<const TetId> tets);

  /// Adds the points of a tet.
  void add(TetId tet);

  [[nodiscard]] std::size_t size() const { return shares_.size(); }
  /// The points of a tet are [first, second); none where it was not added.
  [[nodiscard]] std::pair<std::size_t, std::size_t> points_of(TetId tet) const;
  /// Barycentric coordinates of a point in its tet.
  [[nodiscard]] const std::array<double, 4>& shares(std::size_t point) const { return shares_[point]; }
  /// The rest volume that a point stands for, mm³; those of a tet add up to its own. 0: a node of a tet that has points
  /// of its own.
  [[nodiscard]] double volume_mm3(std::size_t point) const { return volumes_[point]; }
  [[nodiscard]] Vec3 position(std::size_t point, std::span<const Vec3> positions) const;

  /// Nothing for a tet's own point.
  [[nodiscard]] const std::optional<Node>& node_of(std::size_t point) const { return nodes_[point]; }
  [[nodiscard]] static Vec3 rest_position(const Node& node);

 private:
  const TissueModel& model_;
  std::vector<std::int64_t> first_;  // per tet: its first point; -1: not added
  std::vector<std::int32_t> count_;  // per tet
  std::vector<std::array<double, 4>> shares_;
  std::vector<TetId> tets_;
  std::vector<double> volumes_;
  std::vector<std::optional<Node>> nodes_;
};

/// The points that a cut has met. @throws InvalidArgument where its lists do not have one item for each of them.
[[nodiscard]] PointLattice lattice_of(const TissueModel& model, const CutPoints& points);

}  // namespace incise
