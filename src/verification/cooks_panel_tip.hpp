#pragma once

#include "verification/check.hpp"

namespace incise {

// Vertical displacement of the middle of the right edge of Cook's panel in plane strain under a small shear, mm.

/// By a slice of n x n cells of tets.
[[nodiscard]] double panel_tip_of_tets_mm(const CheckContext& context, const Material& material, int n);
/// By nine-node quadrilaterals, extrapolated from three meshes; uses E and ν only.
[[nodiscard]] double panel_reference_tip_mm(const Material& material);

}  // namespace incise
