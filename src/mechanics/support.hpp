#pragma once

#include "mechanics/holder_contact.hpp"

#include <incise/mechanics/tissue.hpp>

namespace incise {

/// Depth at which the pressure of a support equals the tissue's Young's modulus E: pressures up to E penetrate no
/// deeper. A greater depth gives a warning.
inline constexpr double kPenetrationAtModulusMm = 0.05;

/// Returns the position of point p (mm) relative to a support: to its plane, or to its holder if it has one.
[[nodiscard]] SupportGap support_gap(const SupportPlane& support, const Vec3& p);

/// Returns, for each vertex of each support in order, 1 if it is at or behind the surface, otherwise 0.
[[nodiscard]] std::vector<std::uint8_t> support_contacts(const TissueModel& model, const TissueState& state);

/// Returns the depth of the deepest vertex behind one support, mm; 0: none is behind it.
[[nodiscard]] double penetration_mm(const SupportPlane& support, const TissueState& state);

}  // namespace incise
