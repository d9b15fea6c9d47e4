#pragma once

#include "virtual_bench/relaxation.hpp"

#include <incise/mechanics/tissue.hpp>
#include <incise/virtual_bench/bench_cut.hpp>

#include <array>
#include <span>
#include <vector>

namespace incise {

/// The needle: a straight rod from its tip up along its axis.
struct Electrode {
  static constexpr double kLengthMm = 25.0;     // Paper, II-B.2
  static constexpr double kDragReachMm = 1.25;  // coagulum and wet tissue cling this far from the axis
  static constexpr double kSteamReachMm = 1.2;  // and steam tears this far

  Vec3 tip_mm = Vec3::Zero();
  Vec3 axis = -Vec3::UnitZ();

  [[nodiscard]] double distance_mm(const Vec3& p) const;
};

/// (1 - (d/reach)²)², 0 beyond the reach: smooth, 1 on the axis.
[[nodiscard]] double kernel(double distance_mm, double reach_mm);

/// The four points at which a tet's integrals are taken (exact for quadratic functions), as barycentric weights.
[[nodiscard]] const std::array<std::array<double, 4>, 4>& quadrature();

/// Live tets with a quadrature point within the electrode's reach; ascending.
[[nodiscard]] std::vector<std::size_t> tets_in_reach(const TetMesh& mesh, const TissueState& state,
                                                     const Electrode& electrode, double extra_mm);

/// A tet's point in space.
[[nodiscard]] Vec3 point_in(const TetMesh& mesh, std::span<const Vec3> positions, std::size_t tet,
                            const std::array<double, 4>& weights);

}  // namespace incise
