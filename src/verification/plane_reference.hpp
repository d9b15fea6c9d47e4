#pragma once

namespace incise {

/// Linear elasticity of Cook's panel (clamped on the left, shear traction on the right, 1 mm thick) with n x n
/// nine-node quadrilaterals. Shares no code with the tets, so it is an independent reference for them.
struct PanelProblem {
  double youngs_modulus_kpa = 70.0;
  double poissons_ratio = 0.3;
  double traction_kpa = 1.0;    ///< upwards, on the right edge
  bool is_plane_strain = true;  ///< false: plane stress
};
/// Returns the vertical displacement of the middle of the right edge, mm. @throws InvalidArgument if n < 1.
[[nodiscard]] double panel_tip_mm(const PanelProblem& problem, int n);

}  // namespace incise
