#pragma once

#include <incise/cutting/carving.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace incise {

/// A vertex on the line between two of lower number.
struct BetweenVertex {
  VertexId a, b;
  double share;  ///< of b, [0, 1]
};

/// The tissue of a cut for pictures: what is left of it and what is gone, each as tets. After a cut by whole tets these
/// are the tets of its mesh. After a cut by points, tets through which the kerf's border runs are divided there: each
/// piece moves with the tet of the split mesh that it is a part of.
struct DividedMesh {
  std::vector<BetweenVertex> between;     ///< vertices that follow those of the split mesh
  std::vector<Tet> tets;                  ///< M
  std::vector<TetId> split_tet;           ///< per tet: that of the split mesh which it is, or is a piece of
  std::vector<std::uint8_t> skin_faces;   ///< per tet: bit f is set where face f lies on the skin of the uncut body
  std::vector<std::int32_t> gone_step;    ///< per tet: in which it went, 0: before the first; -1: it is left
  std::vector<RemovalCause> gone_cause;   ///< per tet that is gone: why

  /// Of all vertices. @param split  of those of the split mesh, N x 3.
  [[nodiscard]] Points positions(std::span<const Vec3> split) const;
  /// Of each tet, 1 where it was left after a step.
  [[nodiscard]] std::vector<std::uint8_t> is_left(int step) const;
};

/// The border of the kerf is where the dose is 1, linear in the pieces that halves of edges make of a tet: of a kerf
/// narrower than half an edge some of the wall may be missing. O(M log M).
/// @param whole  the model before the cut. @param state  of a cut of it, at any moment.
/// @throws InvalidArgument for points or splits of another mesh.
[[nodiscard]] DividedMesh divide_at_kerf(const TissueModel& whole, const CutState& state);

}  // namespace incise
