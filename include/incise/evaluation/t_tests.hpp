#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/names.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace incise {

/// What a t-test needs of a sample; `sd` is the sample standard deviation (n - 1).
struct SampleMoments {
  std::size_t n = 0;
  double mean = 0.0;
  double sd = 0.0;  ///< not read where n = 1
};

/// @pre at least one value, all finite.
[[nodiscard]] SampleMoments moments_of(std::span<const double> values);

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// An interval as a list of its two ends.
inline void describe_interval(Visitor& v, const Field& field, std::optional<Interval>& interval) {
  std::optional<std::array<double, 2>> ends;
  if (interval) ends = {interval->low, interval->high};
  v(field, ends);
  if (!v.sets()) return;
  interval.reset();
  if (ends) interval = Interval{(*ends)[0], (*ends)[1]};
}

/// Whether a test could say anything.
enum class TestVerdict {
  Tested,
  TooFew,    ///< not enough values to know their spread: one specimen has none
  NoSpread,  ///< no value differs from the others of its sample, so that t has no denominator
};
inline constexpr std::array<std::string_view, 3> kTestVerdictNames{"tested", "too_few", "no_spread"};
[[nodiscard]] constexpr Names names_of(TestVerdict) {
  return kTestVerdictNames;
}

/// A two-tailed test of "the two means are equal". All differences are after minus before: negative = smaller after.
struct TTest {
  TestVerdict verdict = TestVerdict::TooFew;
  double difference = 0.0;  ///< of the means
  std::optional<double> standard_error;
  std::optional<double> df;            ///< absent where there are too few values
  std::optional<double> t;             ///< difference / standard_error; absent unless tested
  std::optional<double> p;             ///< (0, 1]; absent unless tested
  std::optional<Interval> confidence;  ///< of the difference, at the level asked for; absent unless tested
};

inline void describe(Visitor& v, TTest& t) {
  v("t", t.t, "Difference over its standard error; absent unless tested.");
  v("df", t.df, "Degrees of freedom; absent where there are too few values.");
  v("p", t.p, "Two-tailed; absent unless tested.");
  v({"difference_mm", "Of the means, after minus before.", "mm"}, t.difference);
  v({"standard_error_mm", "Of the difference.", "mm"}, t.standard_error);
  describe_interval(v, {"confidence_mm", "Interval of the difference.", "mm"}, t.confidence);
  v("verdict", t.verdict, "Whether the test could say anything.");
}

/// Two samples that share one variance. Source: [Student1908]; needs n_before + n_after >= 3.
/// @pre n >= 1, sd >= 0, all finite; level in (0, 1).
[[nodiscard]] TTest student_t_test(const SampleMoments& before, const SampleMoments& after, double level = 0.95);

/// Two samples, each with a variance of its own: degrees of freedom after Satterthwaite. Source: [Welch1947]; needs
/// 2 values in each. @pre as student_t_test.
[[nodiscard]] TTest welch_t_test(const SampleMoments& before, const SampleMoments& after, double level = 0.95);

/// The same things measured twice: a test of the differences after[i] - before[i]. Needs 2 pairs.
/// @pre equally long, at least one pair, all finite.
[[nodiscard]] TTest paired_t_test(std::span<const double> before, std::span<const double> after, double level = 0.95);

/// Probability that |T| >= |t| for Student's distribution. @pre df > 0, t finite.
[[nodiscard]] double two_tailed_p(double t, double df);

/// Fewest values in each of two samples of equal size for which student_t_test would find the means of `before` and
/// `after` to differ at level `alpha`: what a published "p < 0.001" silently claims about n. `n` of the samples is not
/// read. Absent where the means are equal or more than 10^7 would be needed.
/// @pre alpha in (0, 1).
[[nodiscard]] std::optional<std::size_t> fewest_for_significance(const SampleMoments& before,
                                                                 const SampleMoments& after, double alpha);

}  // namespace incise
