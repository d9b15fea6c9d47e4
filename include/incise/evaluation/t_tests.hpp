#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/names.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace incise {

/// Size, mean and spread of a sample, the input of a t-test.
struct SampleMoments {
  std::size_t n = 0;
  double mean = 0.0;
  double sd = 0.0;  ///< sample standard deviation (n - 1); not used if n = 1
};

/// Computes the moments of a sample. @throws InvalidArgument without values, or for one that is not finite.
[[nodiscard]] SampleMoments moments_of(std::span<const double> values);

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Describes an interval as a list of its two ends.
inline void describe_interval(Visitor& v, const Field& field, std::optional<Interval>& interval) {
  std::optional<std::array<double, 2>> ends;
  if (interval) ends = {interval->low, interval->high};
  v(field, ends);
  if (!v.sets()) return;
  interval.reset();
  if (ends) interval = Interval{(*ends)[0], (*ends)[1]};
}

/// Whether a test could be made.
enum class TestVerdict {
  Tested,
  TooFew,    ///< too few values to estimate their spread
  NoSpread,  ///< all values of each sample are equal, so the denominator of t is 0
};
inline constexpr std::array<std::string_view, 3> kTestVerdictNames{"tested", "too_few", "no_spread"};
[[nodiscard]] constexpr Names names_of(TestVerdict) {
  return kTestVerdictNames;
}

/// Result of a two-tailed test of "the two means are equal". All differences are after minus before: negative = smaller
/// after.
struct TTest {
  TestVerdict verdict = TestVerdict::TooFew;
  double difference = 0.0;  ///< of the means
  std::optional<double> standard_error;
  std::optional<double> df;            ///< degrees of freedom; absent for too few values
  std::optional<double> t;             ///< difference / standard_error; absent unless tested
  std::optional<double> p;             ///< (0, 1]; absent unless tested
  std::optional<Interval> confidence;  ///< of the difference, at the given level; absent unless tested
};

inline void describe(Visitor& v, TTest& t) {
  v("t", t.t, "Difference over its standard error; absent unless tested.");
  v("df", t.df, "Degrees of freedom; absent if there are too few values.");
  v("p", t.p, "Two-tailed p; absent unless tested.");
  v({"difference_mm", "Difference of the means, after minus before.", "mm"}, t.difference);
  v({"standard_error_mm", "Standard error of the difference.", "mm"}, t.standard_error);
  describe_interval(v, {"confidence_mm", "Confidence interval of the difference.", "mm"}, t.confidence);
  v("verdict", t.verdict, "Whether the test could be made.");
}

/// Student's t-test of two samples with a common variance. TooFew unless n_before + n_after >= 3. Source:
/// [Student1908].
/// @param level  of the confidence interval, (0, 1).
/// @pre n >= 1, sd >= 0, all finite (InvalidArgument).
[[nodiscard]] TTest student_t_test(const SampleMoments& before, const SampleMoments& after, double level = 0.95);

/// Welch's t-test of two samples with separate variances, with Satterthwaite's degrees of freedom. TooFew unless each
/// sample has 2 values. Source: [Welch1947]. @pre as student_t_test.
[[nodiscard]] TTest welch_t_test(const SampleMoments& before, const SampleMoments& after, double level = 0.95);

/// Paired t-test of the differences after[i] - before[i]. TooFew for a single pair.
/// @pre equally long, at least one pair, all finite (InvalidArgument).
[[nodiscard]] TTest paired_t_test(std::span<const double> before, std::span<const double> after, double level = 0.95);

/// Returns the probability that |T| >= |t| for Student's distribution with `df` degrees of freedom. @pre df > 0, t
/// finite.
[[nodiscard]] double two_tailed_p(double t, double df);

/// Returns the fewest values in each of two samples of equal size for which student_t_test finds p < `alpha` for these
/// means and standard deviations: the n that a published "p < 0.001" implies. `n` of the samples is not used. Absent if
/// the means are equal, without spread, and if more than 10 000 000 values would be needed.
/// @pre alpha in (0, 1) (InvalidArgument).
[[nodiscard]] std::optional<std::size_t> fewest_for_significance(const SampleMoments& before,
                                                                 const SampleMoments& after, double alpha);

}  // namespace incise
