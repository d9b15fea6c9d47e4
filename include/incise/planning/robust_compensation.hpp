#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/names.hpp>
#include <incise/evaluation/t_tests.hpp>
#include <incise/planning/converging_compensation.hpp>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace incise {

/// One way in which the real tissue may respond.
struct CutScenario {
  double weight = 1.0;   ///< > 0; only ratios count
  double bias_mm = 0.0;  ///< expected error of the real cut less that of the simulated one, positive = farther out
};

/// Cuts along a path in every scenario and measures the cuts: one entry for each scenario, in order; nullopt: no
/// contour to measure.
using MeasureScenarios = std::function<std::vector<std::optional<PathErrors>>(const ToolPath&)>;

/// Expected error of a real cut beyond its scenario, at the waypoints of the intended path, and its uncertainty. It is
/// assumed to be the same along every path of one specimen, including the reading of its photograph.
struct CutResidual {
  std::vector<double> mean_mm;     ///< per waypoint
  Eigen::MatrixXd covariance_mm2;  ///< between waypoints: scale of the distribution, its diagonal above 0
  std::size_t degrees = 0;         ///< of freedom of Student's distribution, above 2; 0: normal
};

struct RobustSettings {
  SafeRegion region;
  double target_mm = 5.0;
  double kerf_allowance_mm = 0.5;
  double max_probability = 0.05;
  double smoothing_mm = 1.5;
  double shift_lags = 0.15;
  double spread_lags = 1.0;
  double trust_mm = 4.0;
  int rounds = 2;
  int samples = 4000;
  std::uint64_t seed = 1;
};
inline void describe(Visitor& v, RobustSettings& s) {
  v("region", s.region, "Where waypoints may be moved to.");
  v({"target_mm", "Intended distance of the measured contour from the edge.", "mm"}, s.target_mm, kPositive);
  v({"kerf_allowance_mm",
     "Part of the target that is not tissue: the electrode's radius for a mid-line, 0 for an inner edge.", "mm"},
    s.kerf_allowance_mm, kNotNegative);
  v("max_probability", s.max_probability,
    "Greatest probability of less tissue than the region's close margin anywhere along the cut.",
    {0.0, 1.0, true, true});
  describe_blur(v, s.smoothing_mm, s.shift_lags, s.spread_lags);
  v({"trust_mm", "Greatest distance of a waypoint from the corrected path.", "mm"}, s.trust_mm, kPositive);
  v("rounds", s.rounds, "Greatest number of times that the path is chosen and cut in every scenario.", {1.0});
  v("samples", s.samples, "Number of residuals over which probabilities are counted.", {100.0});
  v("seed", s.seed, "Seed of these residuals.");
}

/// Expected errors and risk of a path, from cuts along it in every scenario.
struct PathRisk {
  double expected_abs_error_mm = 0.0;  ///< mean over scenarios, residuals and the path
  /// Middle 80 and 95 % of scenarios and residuals, of the mean |error| along the path of one cut, mm; absent: nothing
  /// was measured.
  std::optional<Interval> abs_error_80, abs_error_95;
  double p_close_margin = 0.0;     ///< probability that somewhere less tissue is left than the close margin
  double unmeasured_weight = 0.0;  ///< share of the scenarios whose cut had nothing to measure; left out of the rest
  /// Returns p_close_margin if every scenario that could not be measured is counted as too close.
  [[nodiscard]] double p_close_bound() const { return unmeasured_weight + (1.0 - unmeasured_weight) * p_close_margin; }
};
inline void describe(Visitor& v, PathRisk& r) {
  const auto if_measured = [&r](double value) {
    return r.unmeasured_weight < 1.0 ? std::optional(value) : std::nullopt;
  };
  v.derived("expected_abs_error_mm", if_measured(r.expected_abs_error_mm),
            "Mean |error| over scenarios, residuals and the path.");
  describe_interval(v, {"abs_error_80_mm", "Middle 80 % of the mean absolute error along one cut.", "mm"},
                    r.abs_error_80);
  describe_interval(v, {"abs_error_95_mm", "Middle 95 % of the same.", "mm"}, r.abs_error_95);
  v.derived("p_close_margin", if_measured(r.p_close_margin),
            "Probability that somewhere less tissue is left than the close margin.");
  v("unmeasured_weight", r.unmeasured_weight, "Share of the scenarios whose cut left nothing to measure.", {0.0, 1.0});
}

enum class RobustOutcome {
  Met,        ///< the path keeps the probability in the scenarios' own cuts; those without a measure count as too close
  NotMet,     ///< no path that was tried does; the best of them is returned
  NoMeasure,  ///< no scenario could be measured along the intended, or none along the corrected path
};
inline constexpr std::array<std::string_view, 3> kRobustOutcomeNames{"met", "not_met", "no_measure"};
[[nodiscard]] constexpr Names names_of(RobustOutcome) {
  return kRobustOutcomeNames;
}

/// Result of compensate_robust.
struct RobustCompensation {
  ToolPath path;
  std::vector<double> offset_mm;         ///< per waypoint, from the intended place, mm, positive = away from the tumour
  std::vector<std::uint8_t> is_limited;  ///< per waypoint: 1 where the safe region cut its move short
  RobustOutcome outcome = RobustOutcome::NoMeasure;
  PathRisk intended, corrected, robust;
  std::size_t simulations = 0;  ///< scenarios times paths
};

/// Chooses the robust path: among smooth paths inside the safe region, the one that minimises the expected |error| over
/// the scenarios subject to P(tissue beside the tumour < close margin anywhere) <= max_probability. Scenarios are cut
/// along the intended, the corrected and the chosen path; between these, errors respond to moves as
/// compensate_converging assumes. See docs/models/compensation.md.
/// @param corrected_offset_mm  per waypoint, mm: the offsets of the path with which the iteration ended.
/// @throws InvalidArgument with every violation of the settings, without scenarios, for weights that are not above 0, a
/// residual that does not fit the path or an open path; CaseError if the intended path fails check_path.
[[nodiscard]] RobustCompensation compensate_robust(const ToolPath& intended,
                                                   const std::vector<double>& corrected_offset_mm,
                                                   const SurfaceQuery& surface,
                                                   const std::vector<CutScenario>& scenarios,
                                                   const MeasureScenarios& measure, const CutResidual& residual,
                                                   const RobustSettings& settings = {});

/// Expected gain of a correction, mm: mean |error| along the intended path minus that along the corrected one. Only
/// scenarios that could be measured along both paths count.
struct CutGain {
  double mean_mm = 0.0;
  double sd_mm = 0.0;  ///< over scenarios and residuals; both cuts of one specimen have the same residual
  std::optional<Interval> interval_80, interval_95;  ///< the middle 80 and 95 %, likewise
  double p_worse = 0.0;                              ///< probability that the gain is below 0
  double move_mm =
      0.0;  ///< by which the correction moves the cut, mean along it and over scenarios; positive: outwards
};

/// Risks of the intended and the corrected path, and the gain.
struct PathOutlook {
  PathRisk intended, corrected;
  std::optional<CutGain> gain;  ///< absent: no scenario could be measured along both
};

/// Estimates the risks of both paths and the expected gain of the second, without looking for a better path.
/// @throws as compensate_robust.
[[nodiscard]] PathOutlook foresee_paths(const ToolPath& intended, const std::vector<double>& corrected_offset_mm,
                                        const SurfaceQuery& surface, const std::vector<CutScenario>& scenarios,
                                        const MeasureScenarios& measure, const CutResidual& residual,
                                        const RobustSettings& settings = {});

}  // namespace incise
