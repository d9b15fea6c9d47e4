#pragma once

#include "point_lattice.hpp"

#include <incise/cutting/cut_points.hpp>
#include <incise/geometry/tet_mesh.hpp>

#include <unordered_map>

namespace incise {

/// The kerf of a cut by points: where the dose, trilinear between the nodes of the lattice, is at least 1. Nodes
/// outside the body, or that the tool did not come near, have none.
class PointKerf {
 public:
  /// @param positions  of the configuration in which the kerf is looked at, mm.
  PointKerf(const TissueModel& model, const CutPoints& points, std::span<const Vec3> positions);

  /// The kerf in tets, cut where the dose is 1 on their edges.
  [[nodiscard]] std::vector<std::array<Vec3, 4>> tets() const;
  /// Its surface, closed.
  [[nodiscard]] TriMesh surface() const;

 private:
  struct Corner {
    double dose;
    Vec3 displacement;
    bool is_known;
  };
  [[nodiscard]] Corner corner(const PointLattice::Node& node) const;
  struct Cell {
    std::array<double, 8> doses;
    std::array<Vec3, 8> at;
  };
  /// The eight corners of a cell, x fastest; those that are not known are displaced as the others on average.
  [[nodiscard]] Cell cell(const PointLattice::Node& low) const;

  const TissueModel& model_;
  const CutPoints& points_;
  std::span<const Vec3> positions_;
  PointLattice lattice_;
  std::unordered_map<PointLattice::Node, std::size_t, PointLattice::NodeHash> points_at_;
};

}  // namespace incise
