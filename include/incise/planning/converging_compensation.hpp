#pragma once

#include <incise/core/defaults.hpp>
#include <incise/core/describe.hpp>
#include <incise/core/verdict.hpp>
#include <incise/planning/plan_path.hpp>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

namespace incise {

/// Measured errors of a cut along a path.
struct PathErrors {
  Points places;                        ///< N, mm, the path's frame: points of the measured contour, evenly spaced
  std::vector<double> signed_error_mm;  ///< N: positive = farther from the tumour than intended
  /// Mean distance, mm, that tissue was dragged along the path when it was cut, >= 0 (see TissueDrag).
  double lag_mm = 0.0;
  bool is_success = true;  ///< the cut succeeded: ring closed in every planned layer, negative margin
  /// Depth that the kerf lacks, mean over the path, mm, >= 0, against the least depth accepted without a caution.
  double shortfall_mm = 0.0;
  int open_layers = 0;     ///< planned layers in which the ring stayed open, >= 0
  /// Verdict on this cut by what another path may mend: distance to the tumour, margin, layers, depth, and whether the
  /// simulation ended soundly.
  VerdictStatus verdict = VerdictStatus::Ok;
};
inline void describe(Visitor& v, PathErrors& e) {
  v("places_mm", e.places, "Where the measured contour lies, evenly spaced.");
  v("signed_error_mm", e.signed_error_mm,
    "Signed error at each of these places; positive: farther from the tumour than intended.");
  v("lag_mm", e.lag_mm, "How far ahead the tissue was dragged when it was cut.");
  v("is_success", e.is_success, "Whether the cut succeeded.");
  v("shortfall_mm", e.shortfall_mm,
    "Depth that the kerf lacks, against the least depth accepted without a caution; mean.");
  v("open_layers", e.open_layers, "Planned layers in which the ring stayed open.");
  v("verdict", e.verdict, "Verdict on what another path may mend.");
}

/// Cuts along a path, in simulation or in a test's stand-in for tissue, and measures the cut; nullopt: no contour to
/// measure.
using MeasureCut = std::function<std::optional<PathErrors>(const ToolPath&)>;

/// Where waypoints may lie; see the glossary, safe region.
struct SafeRegion {
  double close_margin_mm = kCloseMarginMm;
  double electrode_radius_mm = kElectrodeRadiusMm;
  double max_offset_mm = 3.8;
  double rim_clearance_mm = 1.0;
  Vec3 approach = -Vec3::UnitZ();
  AxisMode axis_mode = AxisMode::Approach;
};
inline void describe(Visitor& v, SafeRegion& r) {
  v({"close_margin_mm", "A waypoint leaves at least this much tissue beside the tumour edge.", "mm"}, r.close_margin_mm,
    kPositive);
  v({"electrode_radius_mm", "Radius of the tool.", "mm"}, r.electrode_radius_mm, kNotNegative);
  v({"max_offset_mm",
     "Greatest distance of a waypoint from its intended place; a program whose course is 4 mm off is not exported.",
     "mm"},
    r.max_offset_mm, kPositive);
  v({"rim_clearance_mm", "Least distance of a waypoint from the surface's rim.", "mm"}, r.rim_clearance_mm,
    kNotNegative);
  v.direction("approach", r.approach, "Direction into the tissue.");
  v("tool_axis", r.axis_mode, "How the tool is held at a waypoint.");
}

struct ConvergenceSettings {
  SafeRegion region;
  int simulations = 4;
  int more_simulations = 0;
  double more_move_mm = 0.1;
  double floor_mm = 0.0;
  double tolerance_mm = 0.05;
  double smoothing_mm = 1.5;
  double relaxation = 1.0;
  double shift_lags = 0.15;
  double spread_lags = 1.0;
  int memory = 2;
  double trust_mm = 4.0;
  double least_move_mm = 0.01;
  std::vector<double> bias_mm;
  double simulated_share = 1.0;
  std::vector<double> residual_mm;
};
/// The cut responds to a blurred path of the tool (see PathErrors::lag_mm). Describes the settings of this response,
/// which both methods of compensation share.
inline void describe_blur(Visitor& v, double& smoothing_mm, double& shift_lags, double& spread_lags) {
  v({"smoothing_mm", "Standard deviation of the Gaussian by which errors are averaged along the path.", "mm"},
    smoothing_mm, kPositive);
  v("shift_lags", shift_lags,
    "Distance ahead, in lags, of the part of the tool's path to which a place of the cut responds.", kNotNegative);
  v("spread_lags", spread_lags,
    "Standard deviation of that response along the path, in lags; if both are 0, a place responds to its own waypoint "
    "alone.",
    kNotNegative);
}
inline void describe(Visitor& v, ConvergenceSettings& s) {
  v("region", s.region, "Where waypoints may be moved to.");
  v("simulations", s.simulations,
    "Greatest number of simulations, including the first (as intended) and the verifying one.", {2.0});
  v("more_simulations", s.more_simulations,
    "Greatest number of further simulations while the nearest pass has an open layer or a verdict against it: it is "
    "moved by more_move_mm, out and in, then by twice that.",
    kNotNegative);
  v({"more_move_mm",
     "First move of each waypoint in more_simulations: enough that other tissue holds the piece at the seam, far "
     "less than the electrode's radius.",
     "mm"},
    s.more_move_mm, kPositive);
  v({"floor_mm", "Mean |error| that the mesh alone causes, in tissue that cannot move.", "mm"}, s.floor_mm,
    kNotNegative);
  v({"tolerance_mm", "Converged if the mean |error| is within this of floor_mm.", "mm"}, s.tolerance_mm, kPositive);
  v("relaxation", s.relaxation, "Share of the error that a plain step corrects.", {0.0, 1.0, true});
  describe_blur(v, s.smoothing_mm, s.shift_lags, s.spread_lags);
  v("memory", s.memory, "Number of earlier passes that Anderson acceleration uses; 0: plain steps.", kNotNegative);
  v({"trust_mm", "Greatest move of a waypoint in one pass; halved after a pass that made the cut worse.", "mm"},
    s.trust_mm, kPositive);
  v({"least_move_mm", "Passes that would move no waypoint by more than this are not made.", "mm"}, s.least_move_mm,
    kNotNegative);
  v({"bias_mm",
     "Expected error of the real cut minus that of the simulated one, positive: farther out; none, one for the whole "
     "path, or one per waypoint. Added to what is measured.",
     "mm"},
    s.bias_mm);
  v("simulated_share", s.simulated_share,
    "Expected error of a real cut along the intended path per simulated error (with its bias), waypoint by waypoint. "
    "The difference between the two is expected of every pass: a path and its cut move together.",
    {-1.0, 3.0});
  v({"residual_mm", "Error expected beyond that; none, or one per waypoint.", "mm"}, s.residual_mm);
}

/// One pass of the iteration: a path and its simulated cut.
struct CompensationPass {
  std::vector<double> offset_mm;  ///< per waypoint: distance from its intended place, positive = away from the tumour
  std::vector<double> error_mm;   ///< per waypoint: signed, averaged along the path; empty: nothing was measured
  std::vector<std::uint8_t> is_limited;       ///< per waypoint: 1 where the safe region cut its move short
  std::vector<std::uint8_t> is_interpolated;  ///< per waypoint: 1 where nothing was measured (its neighbours were used)
  std::vector<double> along_mm;  ///< per measured point: its place on the intended path, arc length from the start
  std::vector<double> point_error_mm;       ///< per measured point: signed error, with bias, share and residual
  std::optional<double> mean_abs_error_mm;  ///< of all measured points; absent: nothing was measured
  std::optional<double> max_abs_error_mm;
  std::optional<double> smooth_error_mm;  ///< mean of |error_mm|: the part that moving waypoints can correct
  double lag_mm = 0.0;
  double shortfall_mm = 0.0;                  ///< see PathErrors
  int open_layers = 0;                        ///< likewise
  VerdictStatus verdict = VerdictStatus::Ok;  ///< likewise
  double max_move_mm = 0.0;                   ///< greatest move of a waypoint from the pass that this one was made from
  bool is_success = false;
  /// Returns the cost by which passes are compared, mm: mean |error| plus missing depth. @pre measured.
  [[nodiscard]] double cost_mm() const { return mean_abs_error_mm.value() + shortfall_mm; }
};
inline void describe(Visitor& v, CompensationPass& p) {
  v("offset_mm", p.offset_mm, "Distance of each waypoint from its intended place; positive: outwards.");
  v("error_mm", p.error_mm, "Error at each waypoint, averaged along the path.");
  v("is_limited", p.is_limited, "For each waypoint: whether the safe region cut its move short.");
  v.derived("limited_waypoints", std::count(p.is_limited.begin(), p.is_limited.end(), 1),
            "Number of waypoints whose move the safe region cut short.");
  v("is_interpolated", p.is_interpolated, "For each waypoint: whether nothing was measured there.");
  v.bulk("along_mm", p.along_mm, "Place of each measured point on the intended path.");
  v.bulk("point_error_mm", p.point_error_mm, "Signed error of each measured point, with the bias.");
  v("mean_abs_error_mm", p.mean_abs_error_mm, "Mean |error| of all measured points.");
  v("max_abs_error_mm", p.max_abs_error_mm, "Greatest |error| of all measured points.");
  v("smooth_error_mm", p.smooth_error_mm, "Mean of |error_mm|.");
  v("lag_mm", p.lag_mm, "Lag of the tissue when it was cut.");
  v("shortfall_mm", p.shortfall_mm, "Depth that the kerf lacks.");
  v("open_layers", p.open_layers, "Planned layers in which the ring stayed open.");
  v("verdict", p.verdict, "Verdict on what another path may mend.");
  v("max_move_mm", p.max_move_mm, "Greatest move of a waypoint from the pass that this one was made from.");
  v("success", p.is_success, "Whether the cut succeeded.");
}

enum class CompensationOutcome {
  Converged,    ///< mean |error| within the tolerance of the floor, and the cut sound
  BudgetSpent,  ///< all simulations made; the last one is the best, but not within the tolerance
  BestKept,     ///< all simulations made; an earlier one was better and is returned
  AtRest,       ///< no next path: its moves are below least_move_mm, held by the safe region, or cannot be cut
  NoMeasure,    ///< the cut along the intended path has nothing to measure
};
inline constexpr std::array<std::string_view, 5> kCompensationOutcomeNames{"converged", "budget_spent", "best_kept",
                                                                           "at_rest", "no_measure"};
[[nodiscard]] constexpr Names names_of(CompensationOutcome) {
  return kCompensationOutcomeNames;
}

/// Result of compensate_converging.
struct ConvergedCompensation {
  ToolPath path;                         ///< of the best pass
  std::vector<CompensationPass> passes;  ///< one per simulation, in order; the first: the intended path
  /// Index of the best pass: one that succeeded if there is any, then fewest open layers, best verdict, least cost_mm.
  std::size_t best = 0;
  CompensationOutcome outcome = CompensationOutcome::NoMeasure;
  /// Fraction of the mean |error| that remains after a pass: geometric mean from the first pass to the best one; absent
  /// if the first is the best.
  std::optional<double> contraction;
  [[nodiscard]] const CompensationPass& result() const { return passes.at(best); }
};
inline void describe(Visitor& v, ConvergedCompensation& c) {
  v.bulk("path", c.path, "Path of the best pass.");
  v("compensation_outcome", c.outcome, "How the compensation ended.");
  v.derived("simulations", c.passes.size(), "Number of simulations.");
  v("best_pass", c.best, "Index of the best pass.");
  v("contraction", c.contraction, "Fraction of the error that remains after each pass, geometric mean.");
  v("history", c.passes, "The passes, one for each simulation, in order.");
}

/// Moves the waypoints of a path over the surface, pass by pass, until the cut lies where it was intended. Each pass
/// attributes errors to the place where the tool cut them (they lag behind it), averages them along the path and
/// corrects them along the normal of the tumour edge. Steps are accelerated (Anderson) and kept inside a trust region
/// and the safe region. The best pass is returned; its path has been cut. See docs/models/compensation.md.
/// @param intended  closed path on the surface, at the intended distance, with its tumor_edge.
/// @throws InvalidArgument listing every violation of the settings, or for an open path, no tumour edge, or a bias or
/// residual that does not fit the path; CaseError if the intended path fails check_path or touches the tumour edge.
/// Exceptions of `measure` pass through.
[[nodiscard]] ConvergedCompensation compensate_converging(const ToolPath& intended, const SurfaceQuery& surface,
                                                          const MeasureCut& measure,
                                                          const ConvergenceSettings& settings = {});

}  // namespace incise
