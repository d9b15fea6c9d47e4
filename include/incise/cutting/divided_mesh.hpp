#pragma once

#include <incise/cutting/carving.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace incise {

/// A vertex on the straight line between two vertices of lower number: a + share (b - a).
struct BetweenVertex {
  VertexId a, b;
  double share;  ///< of b, [0, 1]
};

/// The remaining and the removed tissue of a cut as tets, for pictures. After a cut by whole tets these are the tets of
/// the mesh. After a cut by points, each tet that the kerf's border crosses is divided there, and each piece moves with
/// the tet of the split mesh to which it belongs.
struct DividedMesh {
  std::vector<BetweenVertex> between;     ///< vertices, numbered after those of the split mesh
  std::vector<Tet> tets;                  ///< M
  std::vector<TetId> split_tet;           ///< M: the tet of the split mesh that the tet equals or is a piece of
  std::vector<std::uint8_t> skin_faces;   ///< M: bit f is set where face f lies on the skin of the uncut body
  std::vector<std::int32_t> gone_step;    ///< M: the step in which it was removed; 0: before the first; -1: it remains
  std::vector<RemovalCause> gone_cause;   ///< M: cause of the removal; meaningless for a tet that remains

  /// Returns the positions of all vertices, mm.
  /// @param split  positions of the split mesh's vertices, N x 3, mm.
  [[nodiscard]] Points positions(std::span<const Vec3> split) const;
  /// Returns one flag per tet: 1 if it remains after the given step.
  [[nodiscard]] std::vector<std::uint8_t> is_left(int step) const;
};

/// Divides the mesh of a cut by points along the border of the kerf, where the dose is 1; leaves the mesh of a cut by
/// whole tets undivided. The dose is linear in the eight pieces that the middles of a tet's edges define, so a kerf
/// narrower than half an edge may lack parts of its wall. O(M log M).
/// @param whole  the model of the whole mesh.
/// @param state  of a cut in that model, after any step.
/// @throws InvalidArgument for points, splits or (in a cut by points) removals of another mesh.
[[nodiscard]] DividedMesh divide_at_kerf(const TissueModel& whole, const CutState& state);

}  // namespace incise
