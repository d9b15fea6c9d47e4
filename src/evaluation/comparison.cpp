#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/evaluation/comparison.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace {

/// One side of the comparison, in the forms that the tests need.
struct ComparedSide {
  std::vector<ContourValues> contours;
  std::vector<double> pooled;
  std::vector<double> means;  ///< by specimen
  double n_effective = 0.0;
};

ComparedSide side_of(std::span<const MeasuredSpecimen> specimens, ErrorMeasure measure, bool is_after,
             std::vector<SpecimenRow>& rows) {
  ComparedSide side;
  for (const MeasuredSpecimen& specimen : specimens) {
    INCISE_REQUIRE(specimen.signed_error_mm.size() >= 3,
                   fmt::format("specimen \"{}\": found errors at {} points, expected at least 3", specimen.name,
                               specimen.signed_error_mm.size()));
    ContourValues contour{.values = specimen.signed_error_mm, .is_ring = specimen.is_ring};
    if (measure == ErrorMeasure::Absolute) {
      for (double& value : contour.values) value = std::abs(value);
    }
    SpecimenRow row{.name = specimen.name, .is_after = is_after};
    row.error_mm = moments_of(contour.values);
    row.correlation = contour_correlation(contour);
    side.means.push_back(row.error_mm.mean);
    // A contour without spread counts as one independent value.
    side.n_effective += row.correlation.n_effective.value_or(1.0);
    side.pooled.insert(side.pooled.end(), contour.values.begin(), contour.values.end());
    side.contours.push_back(std::move(contour));
    rows.push_back(std::move(row));
  }
  return side;
}

PooledTests pooled_tests(const ComparedSide& before, const ComparedSide& after, const ComparisonSettings& settings) {
  const double level = 1.0 - settings.alpha;
  PooledTests tests{.before = moments_of(before.pooled), .after = moments_of(after.pooled)};
  tests.student = student_t_test(tests.before, tests.after, level);
  tests.welch = welch_t_test(tests.before, tests.after, level);
  tests.effect = hedges_g(tests.before, tests.after, level);
  BootstrapSettings bootstrap = settings.bootstrap;
  bootstrap.level = level;
  tests.bootstrap = block_bootstrap_test(before.contours, after.contours, bootstrap);
  tests.n_effective_before = before.n_effective;
  tests.n_effective_after = after.n_effective;
  return tests;
}

SpecimenTests specimen_tests(const ComparedSide& before, const ComparedSide& after, const ComparisonSettings& settings) {
  const double level = 1.0 - settings.alpha;
  SpecimenTests tests{.before = moments_of(before.means), .after = moments_of(after.means)};
  tests.student = student_t_test(tests.before, tests.after, level);
  tests.welch = welch_t_test(tests.before, tests.after, level);
  if (settings.is_paired) {
    tests.paired = paired_t_test(before.means, after.means, level);
    tests.effect = hedges_g_paired(before.means, after.means, level);
  } else {
    tests.effect = hedges_g(tests.before, tests.after, level);
  }
  if (tests.effect) {
    const TestDesign design = settings.is_paired ? TestDesign::Paired : TestDesign::Unpaired;
    tests.fewest = fewest_specimens(tests.effect->hedges_g, design, settings.power, settings.alpha);
  }
  return tests;
}

}  // namespace

std::vector<Problem> validate(const ComparisonSettings& settings) {
  std::vector<Problem> violations = problems_of(settings);
  Expect{violations}(settings.power > settings.alpha, "power", settings.power, "more than alpha");
  return violations;
}

Comparison compare(std::span<const MeasuredSpecimen> before, std::span<const MeasuredSpecimen> after,
                   const ComparisonSettings& settings) {
  require_none(validate(settings));
  INCISE_REQUIRE(!before.empty() && !after.empty(), "expected at least one specimen before and one after");
  INCISE_REQUIRE(!settings.is_paired || before.size() == after.size(),
                 fmt::format("found {} specimens before and {} after, expected pairs", before.size(), after.size()));
  Comparison comparison;
  const ComparedSide first = side_of(before, settings.measure, false, comparison.rows);
  const ComparedSide second = side_of(after, settings.measure, true, comparison.rows);
  comparison.points = pooled_tests(first, second, settings);
  comparison.specimens = specimen_tests(first, second, settings);
  return comparison;
}

}  // namespace incise
