#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/planning/eligibility.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>

namespace incise {
namespace {

/// The usual spread counts as this number of specimens, less one.
constexpr double kUsualWeight = 4.0;

/// Reasons not to trust the simulation of this specimen, apart from its distance to the calibrated ones.
std::vector<std::string> failings(const EligibilityEvidence& e, const EligibilityRules& rules) {
  std::vector<std::string> reasons;
  if (!e.is_registered) reasons.emplace_back("the registration was refused: the specimen's position is not known");
  if (!(e.registration_rmse_mm <= rules.most_rmse_mm)) {
    reasons.push_back(fmt::format("the simulated surface lies {:.2f} mm (rms) from the measured one, above {} mm",
                                  e.registration_rmse_mm, rules.most_rmse_mm));
  }
  if (!(e.corrected.unmeasured_weight <= rules.most_unmeasured)) {
    reasons.push_back(fmt::format(
        "along the corrected path the ring stays open in {:.0f} % of the tissues that the calibration expects, above "
        "{:.0f} %",
        100.0 * e.corrected.unmeasured_weight, 100.0 * rules.most_unmeasured));
  }
  if (!e.gain) reasons.push_back(fmt::format("the gain cannot be predicted: {}", e.no_gain_because));
  if (e.gain && !(std::isfinite(e.gain->mean_mm) && std::isfinite(e.gain->sd_mm)))
    reasons.emplace_back("the expected gain is not a number");
  return reasons;
}

/// Reasons by quantities that lie outside the calibrated range.
std::vector<std::string> far_quantities(const EligibilityEvidence& e, const EligibilityRules& rules) {
  std::vector<std::string> reasons;
  for (const SpecimenDistance& d : e.distances) {
    if (std::abs(d.in_sd) <= rules.most_distance_sds || (d.is_better_below && d.in_sd < 0.0)) continue;
    reasons.push_back(fmt::format("{}: {:.4g} is {:.1f} standard deviations {} the calibration's {:.4g}, beyond {}",
                                  d.name, d.value, std::abs(d.in_sd), d.in_sd < 0.0 ? "below" : "above", d.mean,
                                  rules.most_distance_sds));
  }
  return reasons;
}

/// Student's density at t over that of the same distribution widened by kUnlikeSpread.
double likeness(double t, double degrees) {
  const double far = t / kUnlikeSpread;
  return kUnlikeSpread *
         std::exp(0.5 * (degrees + 1.0) * (std::log1p(far * far / degrees) - std::log1p(t * t / degrees)));
}

/// Part of a message: the share of tissues that p_worse leaves out because the corrected path's ring stays open; empty:
/// none.
std::string open_rings(const EligibilityEvidence& e) {
  if (!(e.corrected.unmeasured_weight > 0.0)) return {};
  return fmt::format("; also, its ring stays open in {:.0f} % of the tissues that the calibration expects",
                     100.0 * e.corrected.unmeasured_weight);
}

/// Reasons against the correction, if the simulation may be trusted.
std::vector<std::string> doubts(const EligibilityEvidence& e, double p_worse, const EligibilityRules& rules) {
  std::vector<std::string> reasons;
  const CutGain& gain = *e.gain;
  if (!e.is_accepted)
    reasons.emplace_back(
        "the correction is not accepted: its own simulated cut fails, is no nearer to the target, or has a mean "
        "error of the electrode's radius or more");
  if (!(gain.mean_mm > rules.least_gain_sds * gain.sd_mm)) {
    reasons.push_back(
        fmt::format("the expected gain of {:.2f} mm is not above {} of its standard deviation of {:.2f} mm",
                    gain.mean_mm, rules.least_gain_sds, gain.sd_mm));
  }
  if (!(p_worse <= rules.most_p_worse)) {
    reasons.push_back(fmt::format("the corrected cut is the worse one with a probability of {:.2f}, above {}{}",
                                  p_worse, rules.most_p_worse, open_rings(e)));
  }
  const double p = e.corrected.p_close_bound();
  if (!(p <= rules.most_p_close_margin) && !(p <= e.intended.p_close_bound())) {
    reasons.push_back(fmt::format(
        "along the corrected path a margin is too close somewhere with a probability of {:.3f}, above {} and above "
        "the {:.3f} as planned",
        p, rules.most_p_close_margin, e.intended.p_close_bound()));
  }
  return reasons;
}

}  // namespace

SpecimenDistance distance_from(std::string name, double value, std::span<const double> calibrated,
                               const UsualSpread& usual) {
  INCISE_REQUIRE(!calibrated.empty(), fmt::format("{}: expected at least one specimen to compare with", name));
  INCISE_REQUIRE(usual.sd > 0.0, fmt::format("{}: expected a usual spread above 0, found {}", name, usual.sd));
  const auto place = [&](double x) {
    INCISE_REQUIRE(std::isfinite(x) && (!usual.is_logarithmic || x > 0.0),
                   fmt::format("{}: expected a number above 0, found {}", name, x));
    return usual.is_logarithmic ? std::log(x) : x;
  };
  const auto n = static_cast<double>(calibrated.size());
  double mean = 0.0;
  for (const double x : calibrated) mean += place(x) / n;
  double squares = kUsualWeight * usual.sd * usual.sd;
  for (const double x : calibrated) squares += std::pow(place(x) - mean, 2);
  const double sd = std::sqrt(squares / (kUsualWeight + n - 1.0) * (1.0 + 1.0 / n));
  return {std::move(name),
          value,
          usual.is_logarithmic ? std::exp(mean) : mean,
          (place(value) - mean) / sd,
          usual.is_better_below,
          kUsualWeight + n - 1.0};
}

double probability_unlike(std::span<const SpecimenDistance> distances) {
  if (distances.empty()) return kPriorUnlike;
  double most = 0.0;
  for (const SpecimenDistance& d : distances) {
    if (!std::isfinite(d.in_sd)) return 1.0;
    const double off = d.is_better_below ? std::max(0.0, d.in_sd) : d.in_sd;
    most = std::max(most, kPriorUnlike / (kPriorUnlike + (1.0 - kPriorUnlike) * likeness(off, d.degrees)));
  }
  return most;
}

double probability_worse_if_unlike(double move_mm, std::span<const double> errors_mm) {
  if (errors_mm.empty()) return 0.5;
  const double mean = std::accumulate(errors_mm.begin(), errors_mm.end(), 0.0) / static_cast<double>(errors_mm.size());
  const double outward = move_mm < 0.0 ? -1.0 : 1.0;
  // |e + move| > |e| where e lies beyond -move / 2 on the side that the correction moves to.
  const double spare = -0.5 * std::abs(move_mm) - outward * mean;
  return 0.5 * std::erfc(spare / (kUnlikeErrorSdMm * std::numbers::sqrt2));
}

Eligibility judge_eligibility(const EligibilityEvidence& evidence, const EligibilityRules& rules) {
  require_none(problems_of(rules));
  Eligibility judged;
  judged.reasons = failings(evidence, rules);
  judged.p_unlike = judged.reasons.empty() ? probability_unlike(evidence.distances) : 1.0;
  if (!evidence.is_stiffness_compared) judged.p_unlike = std::max(judged.p_unlike, kPriorUnlike);
  if (evidence.gain && std::isfinite(evidence.gain->mean_mm) && std::isfinite(evidence.gain->sd_mm)) {
    judged.p_worse_if_unlike = judged.reasons.empty()
                                   ? probability_worse_if_unlike(evidence.gain->move_mm, evidence.calibrated_error_mm)
                                   : 0.5;
    judged.p_worse = (1.0 - judged.p_unlike) * evidence.gain->p_worse + judged.p_unlike * *judged.p_worse_if_unlike;
  }
  std::ranges::move(far_quantities(evidence, rules), std::back_inserter(judged.reasons));
  if (!judged.reasons.empty()) return judged;  // do not use
  // A specimen that may be unlike is never a better candidate for correction: its distance must not lift a doubt.
  judged.reasons = doubts(evidence, std::max(*judged.p_worse, evidence.gain->p_worse), rules);
  if (!judged.reasons.empty()) {
    judged.advice = Advice::CutAsPlanned;
    return judged;
  }
  judged.advice = Advice::Compensate;
  judged.reasons = {fmt::format(
      "the expected gain is {:.2f} ± {:.2f} mm; the corrected cut is the worse one with a probability of {:.2f}{}",
      evidence.gain->mean_mm, evidence.gain->sd_mm, *judged.p_worse, open_rings(evidence))};
  return judged;
}

}  // namespace incise
