#pragma once

#include "point_lattice.hpp"

#include <incise/cutting/carving.hpp>

#include <vector>

namespace incise {

/// Splits the tets whose points have come apart since state.split_step: one for each part whose points hang together,
/// with corners of its own wherever its tissue does not hang together with that of its neighbours
/// (docs/decisions/0010-cutting-law.md). Changes splits and points of the state, and the length of all its lists.
/// @param model    on the mesh of state.splits as they are. @param lattice  its points; those of tets next to split
///                 ones are added.
/// @returns the tets that have other corners or copies now, and these copies, ascending; empty: nothing came apart.
[[nodiscard]] std::vector<TetId> split_parted_tets(const TissueModel& model, PointLattice& lattice, CutState& state);

}  // namespace incise
