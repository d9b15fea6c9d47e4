#pragma once

#include "point_lattice.hpp"

#include <incise/cutting/carving.hpp>

#include <vector>

namespace incise {

/// Splits the tets whose points have come apart since state.split_step: into one tet for each connected part, with its
/// own corners wherever its tissue is not connected with the neighbours' (docs/decisions/0010-cutting-law.md). Changes
/// the splits and points of the state, and the length of all its lists.
/// @param model    on the split mesh of state.splits before the call.
/// @param lattice  points of the cut; the points of tets next to split ones are added.
/// @returns the tets whose corners changed or that were copied, and the copies, ascending; empty: nothing came apart.
[[nodiscard]] std::vector<TetId> split_parted_tets(const TissueModel& model, PointLattice& lattice, CutState& state);

}  // namespace incise
