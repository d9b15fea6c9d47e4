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

/// Barycentric coordinates, in a tet at rest, of a place at rest, mm; outside the tet some are below 0.
[[nodiscard]] std::array<double, 4> barycentric_at_rest(const TissueModel& model, TetId tet, const Vec3& rest);

/// The points that carry a cut: the nodes of a cubic lattice in the tissue at rest, each in the tet that holds it. A
/// tet with fewer than four nodes has four points of its own in their place, which are no nodes.
class PointLattice {
 public:
  using Node = std::array<std::int32_t, 3>;
  struct NodeHash {
    std::size_t operator()(const Node& node) const {
      std::size_t hash = 0;
      for (const std::int32_t i : node) hash = 1000003 * hash + static_cast<std::size_t>(i);
      return hash;
    }
  };
  static constexpr double kSpacingMm = 0.2;

  PointLattice(const TissueModel& model, std::span<const TetId> tets);
  /// The points that a cut has met, on the split mesh of the cut's state (split_model).
  /// @throws InvalidArgument where the lists of its points do not have one item for each of them.
  PointLattice(const TissueModel& split, const CutPoints& points, const MeshSplits& splits);

  /// Goes over to another split mesh of the same whole one, with the same points.
  void follow(const TissueModel& split, const CutPoints& points, const MeshSplits& splits);

  /// @param whole  tets of the whole mesh. @throws InvalidArgument for a point that is given to a tet that it does not
  /// lie in.
  void require_own_tets(const CutPoints& points, const MeshSplits& splits, std::size_t whole) const;

  /// Adds the points of a tet that is not split.
  void add(TetId tet);

  [[nodiscard]] std::size_t size() const { return shares_.size(); }
  /// Whether a cut has met these points, and each moves with the tet that it does here.
  [[nodiscard]] bool is_of(const CutPoints& points) const { return added_ == points.tets && tets_ == points.tet_of; }
  /// The points of a tet are those of [first, second) whose tet_of it is; the others are of its copies. Empty where it
  /// was not added.
  [[nodiscard]] std::pair<std::size_t, std::size_t> points_of(TetId tet) const;
  /// With which a point moves.
  [[nodiscard]] TetId tet_of(std::size_t point) const { return tets_[point]; }
  /// Barycentric coordinates of a point in its tet.
  [[nodiscard]] const std::array<double, 4>& shares(std::size_t point) const { return shares_[point]; }
  /// The rest volume that a point stands for, mm³; those of a tet add up to its own. 0: a node of a tet that has points
  /// of its own.
  [[nodiscard]] double volume_mm3(std::size_t point) const { return volumes_[point]; }
  [[nodiscard]] Vec3 position(std::size_t point, std::span<const Vec3> positions) const;
  [[nodiscard]] Vec3 rest_position(std::size_t point) const { return position(point, model_->mesh.vertices); }

  /// Nothing for a tet's own point.
  [[nodiscard]] const std::optional<Node>& node_of(std::size_t point) const { return nodes_[point]; }
  [[nodiscard]] static Vec3 rest_position(const Node& node);
  [[nodiscard]] static Node node_near(const Vec3& rest);
  /// The node of lowest coordinates of the cell that holds a place at rest.
  [[nodiscard]] static Node cell_of(const Vec3& rest);

 private:
  const TissueModel* model_;
  std::vector<TetId> added_;         // in that order
  std::vector<std::int64_t> first_;  // per tet: its first point; -1: not added
  std::vector<std::int32_t> count_;  // per tet
  std::vector<std::array<double, 4>> shares_;
  std::vector<TetId> tets_;
  std::vector<double> volumes_;
  std::vector<std::optional<Node>> nodes_;
};

/// The points that a cut has met, in the whole mesh, each with the tet of its rest position.
/// @throws InvalidArgument where the lists do not have one item for each of them.
[[nodiscard]] PointLattice lattice_of(const TissueModel& whole, const CutPoints& points);

}  // namespace incise
