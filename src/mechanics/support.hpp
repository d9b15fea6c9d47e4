#pragma once

#include <incise/mechanics/tissue.hpp>

namespace incise {

/// For each vertex of each support plane, in order: 1 where it is at or behind the plane.
[[nodiscard]] std::vector<std::uint8_t> support_contacts(const TissueModel& model, const TissueState& state);

}  // namespace incise
