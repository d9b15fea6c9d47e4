#pragma once

#include <incise/core/error.hpp>
#include <incise/mechanics/statics.hpp>
#include <incise/verification/verification.hpp>

#include <functional>

namespace incise {

/// Context of a check. The monitor only passes on a request to stop.
struct CheckContext {
  Workers& workers;
  Monitor& monitor;
};

/// The solver gave up: the check has no value. Caught by run_checks.
class NotSolved : public Error {
 public:
  using Error::Error;
};

/// Tolerances of the equilibrium, relative to loads or reactions. At small strains, rounding of the positions prevents
/// a tighter one.
inline constexpr double kTightTolerance = 1e-10;
inline constexpr double kSmallStrainTolerance = 1e-7;

/// Returns the static equilibrium, nearly to rounding. @throws NotSolved, with the outcome; Cancelled.
[[nodiscard]] StaticResult solved(const CheckContext& context, const TissueModel& model,
                                  const TissueState* start = nullptr, double relative_tolerance = kTightTolerance);

/// Requires that the finest mesh is close by itself: an extrapolated value means little if its meshes are far off.
/// @param relative_error  of the finest mesh. @throws NotSolved above `bound`; the check then fails.
void require_small_error(double relative_error, double bound);

/// Returns the mean first Piola stress, kPa, of a body in equilibrium from the forces that hold it: P = (1/V) Σ t ⊗ X
/// over its vertices (theorem of mean stress). Uses only nodal forces, so it tests what the solver uses.
[[nodiscard]] Mat3 mean_stress_kpa(const CheckContext& context, const TissueModel& model, const TissueState& state);

/// Returns "corotational", "stable Neo-Hookean, averaged volume", …
[[nodiscard]] std::string law_text(const Material& material);

/// Returns a check with its fixed texts, expected value and tolerance; the caller fills in the rest.
[[nodiscard]] VerificationCheck described(std::string what, std::string source, std::string unit, double expected,
                                          double tolerance);

/// Returns the line y = y_0 (x_0 / x)^order through the first point of a curve: errors that shrink with this order.
[[nodiscard]] LineSeries line_of_order(const LineSeries& errors, double order, std::string name);

/// Returns "4 cells: 1.23 % off, 8 cells: …" for relative errors on meshes of x cells.
[[nodiscard]] std::string errors_text(const LineSeries& errors, const char* cells);

/// Returns the vertical displacement, mm, of the middle of the right edge of Cook's panel in plane strain under a small
/// shear, computed with one layer of n x n cells of tets.
[[nodiscard]] double panel_tip_of_tets_mm(const CheckContext& context, const Material& material, int n);
/// Returns the same, computed with nine-node quadrilaterals, extrapolated from three meshes; uses only E and ν of the
/// material.
[[nodiscard]] double panel_reference_tip_mm(const Material& material);

// The checks, one file each.
VerificationCheck patch_test(const CheckContext& context, const Material& material);
VerificationCheck uniaxial_stretch(const CheckContext& context, const Material& material);
VerificationCheck equibiaxial_stretch(const CheckContext& context, const Material& material);
VerificationCheck simple_shear(const CheckContext& context, const Material& material);
VerificationCheck cantilever_rate(const CheckContext& context);
VerificationCheck cantilever_tip(const CheckContext& context);
VerificationCheck cooks_membrane_rate(const CheckContext& context);
VerificationCheck thick_sphere_rate(const CheckContext& context);
VerificationCheck thick_sphere_displacement(const CheckContext& context);
VerificationCheck elastica_tip(const CheckContext& context);
VerificationCheck locking_of_the_standard_tet(const CheckContext& context, MaterialModel model);
VerificationCheck no_locking_when_averaged(const CheckContext& context, MaterialModel model);
VerificationCheck vibration_period(const CheckContext& context);
VerificationCheck relaxation_of_one_prony_term(const CheckContext& context);
VerificationCheck vertex_order(const CheckContext& context);
VerificationCheck support_penetration(const CheckContext& context);
VerificationCheck support_balance(const CheckContext& context);
VerificationCheck support_pull(const CheckContext& context);

struct CheckEntry {
  std::string name;
  std::function<VerificationCheck(const CheckContext&)> run;
};
/// Returns every check, in the order in which they run.
[[nodiscard]] const std::vector<CheckEntry>& check_table();

}  // namespace incise
