#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/outcome.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace incise {

/// Measurements of one specimen, cut at one power and one speed.
struct PowerCut {
  std::string specimen;
  double power_w = 0.0;                     ///< of the generator, > 0
  double speed_mm_s = 0.0;                  ///< of the tool, > 0
  Outcome outcome = Outcome::NotConverged;  ///< Success: the ring is closed
  std::string problem;                      ///< why there is no cut at all; empty: there is one
  std::optional<double> bulge_mm;           ///< height of the skin ahead of the tool above the uncut surface, >= 0
  std::optional<double> thermal_width_mm;   ///< how far beside the tool's axis heat damaged tissue, >= 0
  std::optional<double> mean_abs_error_mm;  ///< of the inner edge; absent: the ring is open
};
inline void describe(Visitor& v, PowerCut& c) {
  v("specimen", c.specimen, "Name of the specimen.");
  v("power_w", c.power_w, "Power of the generator.", kPositive);
  v("speed_mm_s", c.speed_mm_s, "Speed of the tool.", kPositive);
  v("outcome", c.outcome, "success: the ring is closed.");
  v("problem", c.problem, "Why there is no cut at all; empty: there is one.");
  v.derived("closed_loop", c.outcome == Outcome::Success, "Whether the ring is closed.");
  v("bulge_mm", c.bulge_mm, "Height of the skin ahead of the tool above the uncut surface.", kNotNegative);
  v("thermal_width_mm", c.thermal_width_mm, "How far beside the tool's axis heat damaged tissue.", kNotNegative);
  v("mean_abs_error_mm", c.mean_abs_error_mm, "Mean |error| of the inner edge; absent: the ring is open.",
    kNotNegative);
}

/// Greatest acceptable bulge and thermal width. The paper judged both by eye.
struct PowerLimits {
  double bulge_limit_mm = 1.2;
  double damage_limit_mm = 1.0;
};
inline void describe(Visitor& v, PowerLimits& l) {
  v({"bulge_limit_mm",
     "Greatest height of the skin ahead of the tool, averaged over a cut. Chosen so that the bench's series agrees with "
     "what the paper judged by eye.",
     "mm"},
    l.bulge_limit_mm, kPositive);
  v({"damage_limit_mm",
     "Greatest distance beside the tool's axis at which heat may damage tissue: the electrode's diameter, beyond which "
     "the rim is visibly discoloured.",
     "mm"},
    l.damage_limit_mm, kPositive);
}

/// The reasons against one power.
struct PowerVerdict {
  double power_w = 0.0;
  std::optional<double> greatest_bulge_mm;  ///< over the specimens; absent: measured on none
  std::optional<double> greatest_thermal_width_mm;
  std::vector<std::string> reasons;  ///< empty: this power fits
};
inline void describe(Visitor& v, PowerVerdict& p) {
  v({"power_w", "Power of the generator.", "W"}, p.power_w);
  v.derived("fits", p.reasons.empty(), "Whether this power keeps both limits.");
  v({"greatest_bulge_mm", "Greatest bulge over the specimens; absent: measured on none.", "mm"}, p.greatest_bulge_mm);
  v({"greatest_thermal_width_mm", "Greatest thermal width over the specimens; absent: measured on none.", "mm"},
    p.greatest_thermal_width_mm);
  v("reasons", p.reasons, "Reasons against this power; none: it fits.");
}

/// Which power to cut with.
struct PowerChoice {
  std::optional<double> chosen_w;    ///< absent: no power fits
  std::vector<PowerVerdict> powers;  ///< ascending
};

/// Chooses the lowest power at which every ring is closed and no specimen's bulge or thermal width exceeds its limit (a
/// value equal to its limit is accepted). Each power is judged by itself: a lower power is not assumed to bulge more.
/// @param cuts  every specimen once at every power, all at one speed, in any order; a closed ring has a bulge and a
/// width.
/// @throws InvalidArgument for cuts that break these rules, for numbers that are not finite or out of range, and for
/// invalid limits.
/// Source: [Paper, II-B.3]: "the lowest effective power", four tongues, judged by eye.
[[nodiscard]] PowerChoice choose_power(std::span<const PowerCut> cuts, const PowerLimits& limits);

}  // namespace incise
