#pragma once

#include <incise/cutting/carving.hpp>

#include <string>
#include <vector>

namespace incise {

/// Checks whether the points, the splits and the steps of the record of a loaded state fit a model.
/// @returns the first problem, as a sentence; empty: there is none.
[[nodiscard]] std::string find_problem(const TissueModel& whole, const CutState& state);

/// Checks the invariants of a cut, which hold after every step:
///
/// - balance: the rest volumes and masses of live and recorded tets add up to those of the uncut body, to rounding
/// - record: holds each tet that is not live once, with its rest volume, and no live tet; steps ascend; no step or time
///   is later than the state's; within a step: tets whose dose was full, then loose fragments, each in ascending order
/// - positions: finite at all vertices of live tets
/// - dose: finite; the part from tearing lies between 0 and the dose
/// - bonds: on live tets only, ascending, with finite offsets
/// - points: every list has one item per point; doses are finite and not negative, and at least 1 exactly where the
///   point is parted; the share of its stiffness that a tet retains lies in (0, 1]
///
/// @returns one sentence per kind of violation, which names the first case; empty: all invariants hold.
/// O(vertices + tets + removals + bonds + points).
/// @throws InvalidArgument if the state's lists do not fit the model's mesh.
[[nodiscard]] std::vector<std::string> cut_invariants(const TissueModel& whole, const CutState& state);

}  // namespace incise
