#pragma once

#include "mechanics/holder_contact.hpp"

#include <incise/mechanics/tissue.hpp>

namespace incise {

/// How point p lies to a support: to its plane, or to the holder in its place.
[[nodiscard]] SupportGap support_gap(const SupportPlane& support, const Vec3& p);

/// For each vertex of each support, in order: 1 where it is at or behind the surface.
[[nodiscard]] std::vector<std::uint8_t> support_contacts(const TissueModel& model, const TissueState& state);

}  // namespace incise
