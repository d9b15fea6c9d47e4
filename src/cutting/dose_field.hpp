#pragma once

#include "point_lattice.hpp"

#include <optional>

namespace incise {

/// The dose of a cut by points as a function of the place at rest, interpolated between the nodes of the lattice.
class DoseField {
 public:
  /// Higher doses count as this one. Otherwise a high dose on one side would shift the kerf's border to the node on the
  /// other.
  static constexpr double kMostDose = 2.0;

  /// Keeps a reference to `points`.
  DoseField(const PointLattice& lattice, const CutPoints& points);

  /// Returns the dose at a place: trilinear between those corners of its cell that are nodes of the lattice; 0 if none
  /// is.
  [[nodiscard]] double at(const Vec3& rest) const;
  /// Returns the step in which the nearest parted node parted; nullopt: none lies within 0.5 mm.
  [[nodiscard]] std::optional<std::int32_t> parted_step_near(const Vec3& rest) const;

 private:
  const CutPoints& points_;
  PointLattice::AtNodes<std::size_t> point_at_;
};

}  // namespace incise
