#include <incise/core/error.hpp>
#include <incise/evaluation/effect_size.hpp>

#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

using boost::math::cdf;
using boost::math::complement;

/// P(T <= t) for the noncentral distribution.
double lower_tail(double df, double shift, double t) {
  if (shift == 0.0) return cdf(boost::math::students_t(df), t);
  return cdf(boost::math::non_central_t(df, shift), t);
}

/// The noncentrality for which the observed t has the given lower tail, which falls as the noncentrality grows.
double shift_with_tail(double df, double t, double tail) {
  double low = t - 1.0;
  double high = t + 1.0;
  while (lower_tail(df, low, t) < tail) low -= 2.0 * (high - low);
  while (lower_tail(df, high, t) > tail) high += 2.0 * (high - low);
  for (int k = 0; k < 80 && high - low > 1e-12 * (1.0 + std::abs(low)); ++k) {
    const double middle = 0.5 * (low + high);
    (lower_tail(df, middle, t) > tail ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Factor that removes the bias of d for few values.
double small_sample_factor(double df) {
  return std::exp(std::lgamma(0.5 * df) - std::lgamma(0.5 * (df - 1.0))) / std::sqrt(0.5 * df);
}

/// @param per_d  t = d * per_d
std::optional<EffectSize> effect_of(const TTest& test, double per_d, double level) {
  // Beyond this t, the noncentral distribution cannot be computed in double precision, and the effect is beyond doubt.
  constexpr double kFarthestT = 300.0;
  if (!test.t || !test.df || *test.df < 2.0 || std::abs(*test.t) > kFarthestT) return std::nullopt;
  EffectSize effect;
  effect.cohens_d = *test.t / per_d;
  const double factor = small_sample_factor(*test.df);
  effect.hedges_g = factor * effect.cohens_d;
  const double tail = 0.5 * (1.0 - level);
  effect.confidence = {factor * shift_with_tail(*test.df, *test.t, 1.0 - tail) / per_d,
                       factor * shift_with_tail(*test.df, *test.t, tail) / per_d};
  return effect;
}

}  // namespace

std::optional<EffectSize> hedges_g(const SampleMoments& before, const SampleMoments& after, double level) {
  const auto n_before = static_cast<double>(before.n);
  const auto n_after = static_cast<double>(after.n);
  return effect_of(student_t_test(before, after, level), std::sqrt(n_before * n_after / (n_before + n_after)), level);
}

std::optional<EffectSize> hedges_g_paired(std::span<const double> before, std::span<const double> after, double level) {
  return effect_of(paired_t_test(before, after, level), std::sqrt(static_cast<double>(before.size())), level);
}

double t_test_power(double effect, std::size_t n, TestDesign design, double alpha) {
  INCISE_REQUIRE(std::isfinite(effect), "expected a finite effect");
  INCISE_REQUIRE(n >= 2, fmt::format("found n = {}, expected at least 2", n));
  INCISE_REQUIRE(alpha > 0.0 && alpha < 1.0, fmt::format("found alpha = {}, expected one in (0, 1)", alpha));
  const auto count = static_cast<double>(n);
  const double df = design == TestDesign::Paired ? count - 1.0 : 2.0 * count - 2.0;
  // For a two-tailed test, the sign of the effect does not matter.
  const double shift = std::abs(effect) * std::sqrt(design == TestDesign::Paired ? count : 0.5 * count);
  const double border = boost::math::quantile(complement(boost::math::students_t(df), 0.5 * alpha));
  if (shift == 0.0) return alpha;
  // So far out, the series of the noncentral distribution loses its digits, and the power is 1 to rounding.
  if (shift > border + 40.0) return 1.0;
  const boost::math::non_central_t distribution(df, shift);
  return cdf(complement(distribution, border)) + cdf(distribution, -border);
}

std::optional<std::size_t> fewest_specimens(double effect, TestDesign design, double power, double alpha) {
  INCISE_REQUIRE(power > alpha && power < 1.0, fmt::format("found a power of {}, expected one in (alpha, 1)", power));
  constexpr std::size_t kMost = 1'000'000;
  if (effect == 0.0) return std::nullopt;
  const auto suffices = [&](std::size_t n) { return t_test_power(effect, n, design, alpha) >= power; };
  if (suffices(2)) return 2;
  std::size_t low = 2;
  std::size_t high = 4;
  while (!suffices(high)) {
    if (high == kMost) return std::nullopt;
    low = high;
    high = std::min(2 * high, kMost);
  }
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (suffices(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace incise
