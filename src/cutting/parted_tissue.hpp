#pragma once

#include "point_lattice.hpp"

#include <incise/cutting/carving.hpp>
#include <incise/geometry/surface_query.hpp>

#include <optional>
#include <span>
#include <vector>

namespace incise {

/// The displacement of tissue by a cut by points. Near the kerf, a place moves with the tet of the nearest point that
/// is not parted.
class PartedTissue {
 public:
  /// Keeps references to all arguments.
  /// @param lattice  the points on the whole mesh (lattice_of).
  /// @param from     positions of the whole mesh's vertices in the configuration in which places are given, N x 3, mm.
  PartedTissue(const TissueModel& whole, const PointLattice& lattice, std::span<const Vec3> from,
               const CutState& state);

  /// Returns the displacement of a place from that configuration to the state's, mm.
  /// @param tolerance_mm  greatest distance of the place from the body and, in a tet near which the tool has come, from
  ///                      a point that is not parted.
  /// @returns nullopt if there is no such tissue.
  [[nodiscard]] std::optional<Vec3> displacement(const Vec3& p, double tolerance_mm) const;

  /// Returns the position of a place in the state, mm. A place without displacement() moves with the nearest point of
  /// its tet, parted or not.
  /// @returns nullopt farther than `tolerance_mm` from the body.
  [[nodiscard]] std::optional<Vec3> place_after(const Vec3& p, double tolerance_mm) const;

 private:
  [[nodiscard]] std::optional<std::size_t> nearest_point(const Vec3& rest, double within_mm) const;

  const TissueModel& whole_;
  std::span<const Vec3> from_;
  const CutState& state_;
  TetMesh split_;
  const PointLattice& lattice_;
  TetLocator locator_;
  PointLattice::AtNodes<std::vector<std::size_t>> near_node_;  // points that are not parted
};

}  // namespace incise
