#pragma once

#include "verification/check.hpp"

namespace incise {

// Vertical displacement, mm, of the middle of the right edge of Cook's panel in plane strain under a small shear.

/// Computed with one layer of n x n cells of tets.
[[nodiscard]] double panel_tip_of_tets_mm(const CheckContext& context, const Material& material, int n);
/// Computed with nine-node quadrilaterals, extrapolated from three meshes; uses only E and ν of the material.
[[nodiscard]] double panel_reference_tip_mm(const Material& material);

}  // namespace incise
