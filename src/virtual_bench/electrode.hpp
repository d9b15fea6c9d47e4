#pragma once

#include <incise/mechanics/tissue.hpp>

#include <array>
#include <span>
#include <vector>

namespace incise {

/// The needle: a straight segment from its tip against its axis, which points from shaft to tip.
struct Electrode {
  static constexpr double kLengthMm = 25.0;     // Paper, II-B.2
  static constexpr double kDragReachMm = 1.25;  // coagulum and wet tissue stick to it up to this distance from the axis
  static constexpr double kSteamReachMm = 1.2;  // steam tears tissue up to this distance from the axis

  Vec3 tip_mm = Vec3::Zero();
  Vec3 axis = -Vec3::UnitZ();

  /// Returns the distance of a point from the segment, mm.
  [[nodiscard]] double distance_mm(const Vec3& p) const;
};

/// Returns (1 - (d/reach)²)², 0 beyond the reach: smooth, 1 on the axis.
[[nodiscard]] double kernel(double distance_mm, double reach_mm);

/// Returns the four quadrature points of a tet (exact for quadratic functions), as barycentric weights.
[[nodiscard]] const std::array<std::array<double, 4>, 4>& quadrature();

/// Returns the live tets with a quadrature point within kDragReachMm + `extra_mm` of the electrode; ascending.
[[nodiscard]] std::vector<std::size_t> tets_in_reach(const TetMesh& mesh, const TissueState& state,
                                                     const Electrode& electrode, double extra_mm);

/// Returns the position of a point of a tet, mm, from its barycentric weights.
[[nodiscard]] Vec3 point_in(const TetMesh& mesh, std::span<const Vec3> positions, std::size_t tet,
                            const std::array<double, 4>& weights);

}  // namespace incise
