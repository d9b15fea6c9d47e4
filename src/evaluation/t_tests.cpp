#include <incise/core/error.hpp>
#include <incise/evaluation/statistics.hpp>
#include <incise/evaluation/t_tests.hpp>

#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace incise {
namespace {

void require_sample(const SampleMoments& sample, const char* name) {
  INCISE_REQUIRE(sample.n >= 1, fmt::format("{}: expected at least 1 value", name));
  INCISE_REQUIRE(std::isfinite(sample.mean), fmt::format("{}: the mean is not finite", name));
  INCISE_REQUIRE(std::isfinite(sample.sd) && sample.sd >= 0.0,
                 fmt::format("{}: found a standard deviation of {}, expected 0 or more", name, sample.sd));
}

void require_level(double level) {
  INCISE_REQUIRE(level > 0.0 && level < 1.0, fmt::format("found a level of {}, expected one in (0, 1)", level));
}

/// Sum of squared deviations; one value has none, whatever `sd` says.
double squares(const SampleMoments& sample) {
  return sample.n < 2 ? 0.0 : static_cast<double>(sample.n - 1) * sample.sd * sample.sd;
}

TTest tested(double difference, double standard_error, double df, double level) {
  TTest test{.verdict = TestVerdict::NoSpread, .difference = difference, .standard_error = standard_error, .df = df};
  if (!(standard_error > 0.0)) return test;
  test.verdict = TestVerdict::Tested;
  test.t = difference / standard_error;
  test.p = two_tailed_p(*test.t, df);
  const boost::math::students_t distribution(df);
  const double reach = boost::math::quantile(boost::math::complement(distribution, 0.5 * (1.0 - level)));
  test.confidence = Interval{difference - reach * standard_error, difference + reach * standard_error};
  return test;
}

}  // namespace

SampleMoments moments_of(std::span<const double> values) {
  const Summary summary = summarize(values);
  // Equal values may differ from their mean by rounding, which is no spread.
  const double sd = summary.min == summary.max ? 0.0 : summary.sd;
  return {.n = values.size(), .mean = summary.min == summary.max ? summary.min : summary.mean, .sd = sd};
}

double two_tailed_p(double t, double df) {
  INCISE_REQUIRE(std::isfinite(t), "expected a finite t");
  INCISE_REQUIRE(df > 0.0 && std::isfinite(df), fmt::format("found {} degrees of freedom, expected more than 0", df));
  const boost::math::students_t distribution(df);
  return 2.0 * boost::math::cdf(boost::math::complement(distribution, std::abs(t)));
}

TTest student_t_test(const SampleMoments& before, const SampleMoments& after, double level) {
  require_sample(before, "before");
  require_sample(after, "after");
  require_level(level);
  const double difference = after.mean - before.mean;
  if (before.n + after.n < 3) return {.verdict = TestVerdict::TooFew, .difference = difference};
  const auto n_before = static_cast<double>(before.n);
  const auto n_after = static_cast<double>(after.n);
  const double df = n_before + n_after - 2.0;
  const double variance = (squares(before) + squares(after)) / df;
  return tested(difference, std::sqrt(variance * (1.0 / n_before + 1.0 / n_after)), df, level);
}

TTest welch_t_test(const SampleMoments& before, const SampleMoments& after, double level) {
  require_sample(before, "before");
  require_sample(after, "after");
  require_level(level);
  const double difference = after.mean - before.mean;
  if (before.n < 2 || after.n < 2) return {.verdict = TestVerdict::TooFew, .difference = difference};
  const double part_before = before.sd * before.sd / static_cast<double>(before.n);
  const double part_after = after.sd * after.sd / static_cast<double>(after.n);
  const double sum = part_before + part_after;
  if (!(sum > 0.0)) return {.verdict = TestVerdict::NoSpread, .difference = difference, .standard_error = 0.0};
  const double df = sum * sum /
                    (part_before * part_before / static_cast<double>(before.n - 1) +
                     part_after * part_after / static_cast<double>(after.n - 1));
  return tested(difference, std::sqrt(sum), df, level);
}

TTest paired_t_test(std::span<const double> before, std::span<const double> after, double level) {
  INCISE_REQUIRE(before.size() == after.size(),
                 fmt::format("found {} values before and {} after, expected pairs", before.size(), after.size()));
  require_level(level);
  std::vector<double> differences;
  for (std::size_t i = 0; i < before.size(); ++i) differences.push_back(after[i] - before[i]);
  const SampleMoments moments = moments_of(differences);
  if (moments.n < 2) return {.verdict = TestVerdict::TooFew, .difference = moments.mean};
  const auto n = static_cast<double>(moments.n);
  return tested(moments.mean, moments.sd / std::sqrt(n), n - 1.0, level);
}

std::optional<std::size_t> fewest_for_significance(const SampleMoments& before, const SampleMoments& after,
                                                   double alpha) {
  require_level(alpha);
  const auto p_for = [&](std::size_t n) {
    return student_t_test({n, before.mean, before.sd}, {n, after.mean, after.sd}).p.value_or(1.0);
  };
  constexpr std::size_t kMost = 10'000'000;
  std::size_t low = 1;  // too few, unless there is no spread at all
  std::size_t high = 2;
  while (p_for(high) >= alpha) {
    if (high == kMost) return std::nullopt;
    low = high;
    high = std::min(2 * high, kMost);
  }
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (p_for(middle) < alpha ? high : low) = middle;
  }
  return high;
}

}  // namespace incise
