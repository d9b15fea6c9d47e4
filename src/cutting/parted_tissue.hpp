#pragma once

#include "point_lattice.hpp"

#include <incise/cutting/carving.hpp>
#include <incise/geometry/surface_query.hpp>

#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace incise {

/// Where a cut by points has left the tissue: beside its kerf, with the part to which the nearest point belongs that is
/// not parted.
class PartedTissue {
 public:
  /// @param from  positions of the whole mesh in the configuration that places are given in, mm. Keeps references.
  PartedTissue(const TissueModel& whole, std::span<const Vec3> from, const CutState& state);

  /// From there to the state's. @param tolerance_mm  places may lie this far outside the body, and, in a tet that the
  /// tool came near, from tissue that is not parted. @returns nullopt where there is none.
  [[nodiscard]] std::optional<Vec3> displacement(const Vec3& p, double tolerance_mm) const;

  /// Where a place lies then; one whose tissue is parted, with its nearest point. @returns nullopt outside the
  /// body.
  [[nodiscard]] std::optional<Vec3> place_after(const Vec3& p, double tolerance_mm) const;

 private:
  [[nodiscard]] std::optional<std::size_t> nearest_point(const Vec3& rest, double within_mm) const;

  const TissueModel& whole_;
  std::span<const Vec3> from_;
  const CutState& state_;
  TetMesh split_;
  PointLattice lattice_;
  TetLocator locator_;
  std::unordered_map<PointLattice::Node, std::vector<std::size_t>, PointLattice::NodeHash>
      near_node_;  // points that are not parted
};

}  // namespace incise
