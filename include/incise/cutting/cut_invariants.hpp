#pragma once

#include <incise/cutting/carving.hpp>

#include <string>
#include <vector>

namespace incise {

/// What is wrong with the points and splits of a state that came from elsewhere; empty: they are of this model.
[[nodiscard]] std::string find_problem(const TissueModel& whole, const CutState& state);

/// What has to hold of a cut at every step, whatever the tool did:
///
/// - balance: rest volume and mass of the live tets and of those in the record add up to the uncut body's, to rounding
/// - record: every tet that is not live is in it once, with its rest volume, and no live one is; steps ascend, and none is
///   ahead of the state, nor is a time; within a step: what was touched long enough, then loose fragments, each ascending
/// - positions: of vertices with a live tet, mm: finite
/// - dose: finite; what tearing contributed is between 0 and the whole
/// - bonds: on live tets only, ascending, with finite offsets
/// - points: as many of everything as their tets have; doses finite and not negative, at least 1 where parted and nowhere
///   else; what is left of a tet's stiffness in (0, 1]
///
/// @returns every kind of violation, one sentence each with the first offender; empty: all hold.
/// O(vertices + tets + removals + bonds + points).
/// @throws InvalidArgument when the state's lists do not fit the model's mesh.
[[nodiscard]] std::vector<std::string> cut_invariants(const TissueModel& whole, const CutState& state);

}  // namespace incise
