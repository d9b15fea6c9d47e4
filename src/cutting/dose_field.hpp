#pragma once

#include "point_lattice.hpp"

#include <optional>
#include <unordered_map>

namespace incise {

/// The dose of a cut by points between the nodes of its lattice, at rest.
class DoseField {
 public:
  /// What a dose counts for at most: where it is high on one side, the kerf's border does not move to the other node.
  static constexpr double kMostDose = 2.0;

  /// Both are kept by reference.
  DoseField(const PointLattice& lattice, const CutPoints& points);

  /// Trilinear in the corners of a place's cell that are nodes of the tissue; where none is, 0.
  [[nodiscard]] double at(const Vec3& rest) const;
  /// The step in which the nearest parted node went; nothing: none lies within 0.5 mm.
  [[nodiscard]] std::optional<std::int32_t> parted_step_near(const Vec3& rest) const;

 private:
  const CutPoints& points_;
  std::unordered_map<PointLattice::Node, std::size_t, PointLattice::NodeHash> point_at_;
};

}  // namespace incise
