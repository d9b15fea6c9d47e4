#pragma once

namespace incise {

/// Linear elasticity of Cook's panel (clamped on the left, shear traction on the right, 1 mm thick) with n x n
/// nine-node quadrilaterals: shares no code with the tets, so that it can judge them.
struct PanelProblem {
  double youngs_modulus_kpa = 70.0;
  double poissons_ratio = 0.3;
  double traction_kpa = 1.0;    ///< upwards, on the right edge
  bool is_plane_strain = true;  ///< else plane stress
};
/// Vertical displacement of the middle of the right edge, mm.
[[nodiscard]] double panel_tip_mm(const PanelProblem& problem, int n);

}  // namespace incise
