#pragma once

#include <incise/cutting/cut_points.hpp>
#include <incise/mechanics/tissue.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace incise {

/// Returns the barycentric coordinates of a place at rest, mm, in a tet at rest; outside the tet some are below 0.
[[nodiscard]] std::array<double, 4> barycentric_at_rest(const TissueModel& model, TetId tet, const Vec3& rest);

/// The points of a cut by points: the nodes of a cubic lattice in the tissue at rest, each in the tet that contains it.
/// For a tet with fewer than four nodes, four points of its own, which are not nodes, represent its volume instead.
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
  template <class Value>
  using AtNodes = std::unordered_map<Node, Value, NodeHash>;
  static constexpr double kSpacingMm = 0.2;

  /// The points of the given tets. Keeps a reference to the model.
  PointLattice(const TissueModel& model, std::span<const TetId> tets);
  /// The points of a cut, on the split mesh of its state (split_model). Keeps a reference to `split`.
  /// @throws InvalidArgument if the lists of `points` do not have one item per point, or name other tets.
  PointLattice(const TissueModel& split, const CutPoints& points, const MeshSplits& splits);

  /// Replaces the split mesh by another one of the same whole mesh, with the same points.
  void follow(const TissueModel& split, const CutPoints& points, const MeshSplits& splits);

  /// Checks that each point moves with the tet in which it lies, or a copy of that tet.
  /// @param whole  number of tets of the whole mesh.
  /// @throws InvalidArgument naming the first point that does not.
  void require_own_tets(const CutPoints& points, const MeshSplits& splits, std::size_t whole) const;

  /// Adds the points of a tet that is not split.
  void add(TetId tet);

  [[nodiscard]] std::size_t size() const { return shares_.size(); }
  /// Whether these are the points of a cut, and each moves with the same tet.
  [[nodiscard]] bool is_of(const CutPoints& points) const { return added_ == points.tets && tets_ == points.tet_of; }
  /// Returns the range [first, second) of the points of a tet and all its copies; tet_of() says to which of these a
  /// point belongs. Empty if the tet was not added.
  [[nodiscard]] std::pair<std::size_t, std::size_t> points_of(TetId tet) const;
  /// Returns the tet with which a point moves.
  [[nodiscard]] TetId tet_of(std::size_t point) const { return tets_[point]; }
  /// Returns the barycentric coordinates of a point in its tet.
  [[nodiscard]] const std::array<double, 4>& shares(std::size_t point) const { return shares_[point]; }
  /// Returns the rest volume that a point represents, mm³; the volumes of a tet's points add up to the tet's. 0: a node
  /// of a tet that has points of its own.
  [[nodiscard]] double volume_mm3(std::size_t point) const { return volumes_[point]; }
  [[nodiscard]] Vec3 position(std::size_t point, std::span<const Vec3> positions) const;
  [[nodiscard]] Vec3 rest_position(std::size_t point) const { return position(point, model_->mesh.vertices); }

  /// Returns the node at a point; nullopt for a tet's own point.
  [[nodiscard]] const std::optional<Node>& node_of(std::size_t point) const { return nodes_[point]; }
  [[nodiscard]] static Vec3 rest_position(const Node& node);
  /// Returns the node nearest to a place at rest, mm.
  [[nodiscard]] static Node node_near(const Vec3& rest);
  /// Returns the node with the lowest coordinates of the cell that contains a place at rest, mm.
  [[nodiscard]] static Node cell_of(const Vec3& rest);
  /// Returns the node `by` steps away along each axis whose bit is set in `corner` (bit a: axis a); with 1, a corner of
  /// the cell whose lowest node is `node`.
  [[nodiscard]] static Node corner_of(Node node, std::size_t corner, int by = 1);
  /// Returns the trilinear weight of a corner of a cell at a place in it. @param t  from the lowest corner, in
  /// spacings.
  [[nodiscard]] static double corner_weight(std::size_t corner, const Vec3& t);

 private:
  const TissueModel* model_;
  std::vector<TetId> added_;         // in order of addition
  std::vector<std::int64_t> first_;  // per tet: its first point; -1: not added
  std::vector<std::int32_t> count_;  // per tet
  std::vector<std::array<double, 4>> shares_;
  std::vector<TetId> tets_;
  std::vector<double> volumes_;
  std::vector<std::optional<Node>> nodes_;
};

/// Returns the points of a cut on the whole mesh, each in the tet that contains it at rest.
/// @throws InvalidArgument if the lists of `points` do not have one item per point, or name tets out of range.
[[nodiscard]] PointLattice lattice_of(const TissueModel& whole, const CutPoints& points);

}  // namespace incise
