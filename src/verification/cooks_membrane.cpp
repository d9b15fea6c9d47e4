// Cook's membrane: a tapered panel, clamped on the left and sheared on the right; it bends, shears and has a singular
// corner.
#include "verification/bodies.hpp"
#include "verification/check.hpp"
#include "verification/closed_forms.hpp"
#include "verification/convergence.hpp"
#include "verification/plane_reference.hpp"

#include <incise/core/units.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace {

constexpr double kPanelTraction = 2e-3;  // kPa, upwards: strains near 1e-4, where linear elasticity applies
constexpr double kPanelRateTolerance = 0.1;
const std::vector<int> kPanelCells{16, 32, 64};
constexpr int kReferenceCells = 32;  // quadratic elements each way; the coarser two of its meshes have 8 and 16

}  // namespace

double panel_tip_of_tets_mm(const CheckContext& context, const Material& material, int n) {
  const TissueModel model = make_tissue_model(
      cooks_panel(n), material,
      {FixedConstraint{plane_across(0, 0.0), {true, true, false}}, symmetry_across(2), symmetry_across(2, 1.0),
       TractionConstraint{plane_across(0, 48.0), Vec3(0, kPanelTraction, 0)}});
  const Region tip = BoxRegion{Box3(Vec3(48.0 - 1e-6, 52.0 - 1e-6, -1.0), Vec3(48.0 + 1e-6, 52.0 + 1e-6, 2.0))};
  return mean_displacement(model, solved(context, model, nullptr, kSmallStrainTolerance).state, tip)[1];
}

double panel_reference_tip_mm(const Material& material) {
  const PanelProblem problem{.youngs_modulus_kpa = material.youngs_modulus_kpa,
                             .poissons_ratio = material.poissons_ratio,
                             .traction_kpa = kPanelTraction};
  return extrapolated(panel_tip_mm(problem, kReferenceCells / 4), panel_tip_mm(problem, kReferenceCells / 2),
                      panel_tip_mm(problem, kReferenceCells));
}

VerificationCheck cooks_membrane_rate(const CheckContext& context) {
  const Material material{.poissons_ratio = 0.3};
  // The upper left corner: 90 degrees plus the slope of the upper edge. Its energy converges with twice the exponent.
  const double angle = 0.5 * units::kPi + std::atan(16.0 / 48.0);
  const double exponent = corner_exponent(angle, material.poissons_ratio);
  VerificationCheck check = described(
      "Cook's membrane, plane strain, ν = 0.3: observed order of convergence of the tip displacement",
      "at least twice the exponent of the clamped-free corner (Williams 1952); tip by nine-node quadrilaterals", "-",
      2.0 * exponent, kPanelRateTolerance);
  // On meshes as coarse as these the smooth part of the error, of order 2, still outweighs the corner's.
  check.criterion = Criterion::AtLeast;
  const double expected = panel_reference_tip_mm(material);
  LineSeries marks{"tip displacement", {}, {}, false};
  for (const int n : kPanelCells) {
    marks.add(n, std::abs(1.0 - panel_tip_of_tets_mm(context, material, n) / expected));
  }
  check.note = errors_text(marks, "cells");
  check.found = observed_rate(marks.y[marks.y.size() - 2], marks.y.back());
  const std::string name = fmt::format("order {:.2f}, the least to be seen", 2.0 * exponent);
  const LineSeries slope = line_of_order(marks, 2.0 * exponent, name);
  check.plot = {"Cook's membrane", "cells each way", "relative error of the tip", true, true, {slope, marks}};
  return check;
}

}  // namespace incise
