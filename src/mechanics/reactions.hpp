#pragma once

#include <incise/mechanics/tissue.hpp>

namespace incise {

/// Returns, per vertex, 1 along axes that may move, 0 along held ones and at vertices without a live tet.
[[nodiscard]] Points free_axes(const TissueModel& model, const TissueState& state);

/// Returns the norm of vectors on the free axes. @param is_free  free_axes().
[[nodiscard]] double free_norm(std::span<const Vec3> vectors, std::span<const Vec3> is_free);

/// Returns a force far below any that deforms the body, but above rounding, mN: 1e-6 E L², L the diagonal of its box.
[[nodiscard]] double negligible_force_mn(const TissueModel& model);

/// Returns the force of each constraint on the tissue, mN: the force that balances its held axes, the push of a
/// support, or the sum of a traction. An axis that two constraints hold counts for the first.
[[nodiscard]] std::vector<Vec3> reactions(const TissueModel& model, const TissueState& state, Workers& workers);

}  // namespace incise
