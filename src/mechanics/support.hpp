#pragma once

#include "mechanics/holder_contact.hpp"

#include <incise/mechanics/tissue.hpp>

namespace incise {

/// A support pushes back with the pressure of the tissue's Young's modulus at this depth, so that pressures of up to E
/// stay within it. What lies deeper is worth a warning.
inline constexpr double kPenetrationAtModulusMm = 0.05;

/// How point p lies to a support: to its plane, or to the holder in its place.
[[nodiscard]] SupportGap support_gap(const SupportPlane& support, const Vec3& p);

/// For each vertex of each support, in order: 1 where it is at or behind the surface.
[[nodiscard]] std::vector<std::uint8_t> support_contacts(const TissueModel& model, const TissueState& state);

/// Depth of the vertex that lies deepest behind one support, mm (0: none does).
[[nodiscard]] double penetration_mm(const SupportPlane& support, const TissueState& state);

}  // namespace incise
