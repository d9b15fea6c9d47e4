#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/names.hpp>
#include <incise/planning/robust_compensation.hpp>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// What to do with a specimen before the robot moves.
enum class Advice {
  Compensate,    ///< the expected gain of the corrected path exceeds its uncertainty
  CutAsPlanned,  ///< the simulation may be trusted, but the correction gains too little, or costs margin
  DoNotUse,      ///< do not trust the simulation of this specimen
};
inline constexpr std::array<std::string_view, 3> kAdviceNames{"compensate", "cut_as_planned", "do_not_use"};
[[nodiscard]] constexpr Names names_of(Advice) {
  return kAdviceNames;
}

/// How far a quantity of this specimen lies from the calibration's specimens.
struct SpecimenDistance {
  std::string name;
  double value = 0.0;
  double mean = 0.0;             ///< of the calibration's specimens; geometric for a logarithmic quantity
  double in_sd = 0.0;            ///< `value` minus mean, in standard deviations of the prediction for a next specimen
  bool is_better_below = false;  ///< a value below the mean is good for the specimen, however far
  double degrees = 4.0;          ///< degrees of freedom of that standard deviation: n + 3 for n specimens, >= 4
};
inline void describe(Visitor& v, SpecimenDistance& d) {
  v("name", d.name, "Name of the quantity.");
  v("value", d.value, "Value for this specimen.");
  v("calibrated_mean", d.mean, "Mean over the calibration's specimens; geometric for a logarithmic quantity.");
  v("in_sd", d.in_sd,
    "Value minus mean (of logarithms for a logarithmic quantity), in standard deviations of the prediction for a next "
    "specimen.");
  v.internal("is_better_below", d.is_better_below, "A value below the mean is in favour of the specimen.");
  v.internal("degrees", d.degrees, "Degrees of freedom of that standard deviation.");
}

/// Spread of a quantity between specimens that are alike.
struct UsualSpread {
  double sd = 0.0;  ///< usual standard deviation, > 0; of the logarithm for a logarithmic quantity
  bool is_logarithmic = false;
  bool is_better_below = false;  ///< see SpecimenDistance
};

/// Computes the distance of a quantity from the calibration's specimens. A few specimens hardly determine their spread,
/// so it is blended with the usual one, which counts as much as five specimens would: sd² = (4 usual² + Σ (x − mean)²)
/// / (4 + n − 1) · (1 + 1/n).
/// @throws InvalidArgument without specimens, for a usual spread not above 0, for numbers that are not finite, or not
/// above 0 for a logarithmic quantity.
[[nodiscard]] SpecimenDistance distance_from(std::string name, double value, std::span<const double> calibrated,
                                             const UsualSpread& usual);

/// Returns the probability that the calibration says nothing about a specimen, by its most unlike quantity. The prior
/// is kPriorUnlike. Distances of specimens that are alike follow Student's t (the spread is estimated, too); those of
/// other specimens follow one that is kUnlikeSpread times as wide. From twenty specimens the result is 0.005, 0.03,
/// 0.21, 0.73 and 0.97 at distances of 0, 2, 3, 4 and 5; from two, 0.10 and 0.26 at 3 and 4. Quantities that are better
/// below count only above the mean. Quantities are looked at one at a time. Source: [BoxTiao1968].
/// @return in (0, 1]; kPriorUnlike without distances; 1 if a distance is not finite.
[[nodiscard]] double probability_unlike(std::span<const SpecimenDistance> distances);

inline constexpr double kPriorUnlike = 0.05;   ///< share of specimens about which a calibration says nothing. Chosen.
inline constexpr double kUnlikeSpread = 10.0;  ///< how many times as widely these are spread. Chosen: far, either way.

/// Returns the probability that a correction makes the cut worse if the calibration says nothing about the specimen.
/// Its cut then errs as planned as others did, whatever its simulation predicts: mean error along the ring e ~ N(mean
/// of errors_mm, kUnlikeErrorSdMm²). The correction makes it worse if e + move_mm lies farther from 0 than e, so
/// farther moves are riskier.
/// @param move_mm    mean move of the cut by the correction, positive = away from the tumour.
/// @param errors_mm  mean signed errors of the calibration's cuts, as photographed. @return one half without any.
[[nodiscard]] double probability_worse_if_unlike(double move_mm, std::span<const double> errors_mm);

inline constexpr double kUnlikeErrorSdMm = 0.7;  ///< half of what a cut errs as planned. Chosen.

/// Evidence for the advice.
struct EligibilityEvidence {
  PathRisk intended, corrected;
  std::optional<CutGain> gain;              ///< absent: no scenario could be simulated along both paths …
  std::string no_gain_because;              ///< … because of this
  bool is_accepted = true;                  ///< whether its own simulation accepts the correction
  bool is_registered = true;                ///< whether a transform was found to which nothing objects
  double registration_rmse_mm = 0.0;        ///< of the simulated surface against the measured one
  std::vector<SpecimenDistance> distances;  ///< of every quantity that is known of specimen and calibration
  bool is_stiffness_compared = true;        ///< whether `distances` contains the stiffness
  std::vector<double> calibrated_error_mm;  ///< mean signed errors of the calibration's cuts
};

/// Rules for the advice. Every number is a choice; see docs/models/eligibility.md.
struct EligibilityRules {
  double least_gain_sds = 1.0;
  double most_p_worse = 0.15;
  double most_distance_sds = 3.0;
  double most_rmse_mm = 1.0;
  double most_unmeasured = 0.5;
  double most_p_close_margin = 0.05;
};
inline void describe(Visitor& v, EligibilityRules& r) {
  v("least_gain_sds", r.least_gain_sds, "The expected gain must be above this many of its standard deviations.",
    kNotNegative);
  v("most_p_worse", r.most_p_worse,
    "Greatest probability that the corrected cut is the worse one, for a specimen like the calibrated ones and "
    "overall.",
    {0.0, 1.0});
  v("most_distance_sds", r.most_distance_sds,
    "Greatest distance of any quantity from the calibrated specimens, in standard deviations.", kPositive);
  v({"most_rmse_mm", "Greatest rms distance of the registration.", "mm"}, r.most_rmse_mm, kPositive);
  v("most_unmeasured", r.most_unmeasured,
    "Greatest weight of the tissues in which the cut along the corrected path cannot be measured.", {0.0, 1.0});
  v("most_p_close_margin", r.most_p_close_margin,
    "Greatest probability of a close margin along the corrected path, where it is above the intended path's.",
    {0.0, 1.0, true, true});
}

/// Advice on a specimen, with its reasons.
struct Eligibility {
  Advice advice = Advice::DoNotUse;
  std::vector<std::string> reasons;  ///< each with its numbers; for the advice alone, at least one
  /// probability_unlike of the distances; at least kPriorUnlike if the stiffness is not among them; 1 if something
  /// other than a distance argues against the simulation.
  double p_unlike = 0.0;
  /// probability_worse_if_unlike of the gain's move; one half if something other than a distance argues against the
  /// simulation. Absent without a gain, or if the gain is not a number.
  std::optional<double> p_worse_if_unlike;
  /// Probability that the corrected cut is the worse one: p_worse of the gain, weighted by 1 − p_unlike, plus
  /// p_worse_if_unlike, weighted by p_unlike. Absent if p_worse_if_unlike is.
  std::optional<double> p_worse;
};

/// Judges the evidence by the rules. All reasons against the simulation come before any about the gain; a value that is
/// not a number is such a reason.
/// @throws InvalidArgument with every violation of the rules.
[[nodiscard]] Eligibility judge_eligibility(const EligibilityEvidence& evidence, const EligibilityRules& rules = {});

}  // namespace incise
