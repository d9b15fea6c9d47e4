#pragma once

#include <incise/mechanics/tissue.hpp>

namespace incise {

/// Returns, per vertex, 1 along axes that may move, 0 along held ones and at vertices without a live tet.
[[nodiscard]] Points free_axes(const TissueModel& model, const TissueState& state);

/// Returns the force of each constraint on the tissue, mN: the force that balances its held axes, the push of a
/// support, or the sum of a traction. An axis that two constraints hold counts for the first.
[[nodiscard]] std::vector<Vec3> reactions(const TissueModel& model, const TissueState& state, Workers& workers);

}  // namespace incise
