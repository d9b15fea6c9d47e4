#pragma once

#include "point_lattice.hpp"

#include <incise/cutting/cut_points.hpp>
#include <incise/geometry/tet_mesh.hpp>

namespace incise {

/// The kerf of a cut by points: the tissue in which the dose, interpolated between the nodes of the lattice, is at
/// least 1. Nodes outside the body, and nodes near which the tool has not come, have a dose of 0.
class PointKerf {
 public:
  /// Keeps references to all arguments.
  /// @param lattice    the points on the whole mesh (lattice_of).
  /// @param positions  of the whole mesh's vertices in the configuration in which the kerf is measured, N x 3, mm.
  PointKerf(const TissueModel& model, const PointLattice& lattice, const CutPoints& points,
            std::span<const Vec3> positions);

  /// Returns the kerf as tets, clipped at dose 1, mm.
  [[nodiscard]] std::vector<std::array<Vec3, 4>> tets() const;
  /// Returns the closed surface of the kerf, mm.
  [[nodiscard]] TriMesh surface() const;

 private:
  struct Corner {
    double dose;
    Vec3 displacement;
    bool is_known;
  };
  [[nodiscard]] Corner corner(const PointLattice::Node& node) const;
  [[nodiscard]] double dose_of(std::size_t point) const;
  struct Cell {
    std::array<double, 8> doses;
    std::array<Vec3, 8> at;
  };
  /// The eight corners of a cell, x fastest. Corners that are not nodes of the tissue take the mean displacement of the
  /// others.
  [[nodiscard]] Cell cell(const PointLattice::Node& low) const;

  const TissueModel& model_;
  const CutPoints& points_;
  std::span<const Vec3> positions_;
  const PointLattice& lattice_;
  PointLattice::AtNodes<std::size_t> points_at_;
};

}  // namespace incise
