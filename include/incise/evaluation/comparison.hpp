#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/names.hpp>
#include <incise/core/problem.hpp>
#include <incise/evaluation/block_bootstrap.hpp>
#include <incise/evaluation/effect_size.hpp>
#include <incise/evaluation/statistics.hpp>

#include <string>
#include <vector>

namespace incise {

/// The errors of one specimen's incision, in the order of the contour.
struct MeasuredSpecimen {
  std::string name;
  std::vector<double> signed_error_mm;  ///< at evenly spaced points, at least 3
  bool is_ring = true;
};

/// The error that is compared.
enum class ErrorMeasure { Absolute, Signed };
inline constexpr std::array<std::string_view, 2> kErrorMeasureNames{"absolute", "signed"};
[[nodiscard]] constexpr Names names_of(ErrorMeasure) {
  return kErrorMeasureNames;
}

struct ComparisonSettings {
  ErrorMeasure measure = ErrorMeasure::Absolute;
  bool is_paired = false;
  double alpha = 0.05;
  double power = 0.8;
  BootstrapSettings bootstrap;
};
inline void describe(Visitor& v, ComparisonSettings& s) {
  v("measure", s.measure, "Which errors are compared.");
  v("paired", s.is_paired,
    "Whether before[i] and after[i] are the same specimen; otherwise the specimens are unrelated.");
  v("alpha", s.alpha, "Significance level; confidence intervals are at 1 - alpha.", {0.0, 1.0, true, true});
  v("power", s.power,
    "Power that the next experiment should have: the probability of detecting the effect; more than alpha.",
    {0.0, 1.0, true, true});
  describe(v, s.bootstrap);
}

/// Returns every violation; empty if valid.
[[nodiscard]] std::vector<Problem> validate(const ComparisonSettings& settings);

/// One incision in a comparison.
struct SpecimenRow {
  std::string name;
  bool is_after = false;
  SampleMoments error_mm;  ///< of the error that is compared
  ContourCorrelation correlation;
};

/// A t-test with its name, as written to JSON.
struct NamedTest {
  std::string name;
  TTest test;
};

inline void describe(Visitor& v, NamedTest& t) {
  v.derived("test", t.name, "Name of the test.");
  describe(v, t.test);
}

/// Describes `test` under `field`, together with its name; the name is not read back.
inline void describe_test(Visitor& v, const Field& field, const char* name, TTest& test) {
  NamedTest named{name, test};
  v(field, named);
  test = named.test;
}

/// Tests by contour point, as in the paper: the points of all specimens are pooled, as if each were a specimen.
struct PooledTests {
  SampleMoments before, after;
  TTest student;  ///< the paper's
  TTest welch;
  std::optional<EffectSize> effect;
  BootstrapTest bootstrap;          ///< the same test, but with the correlation of neighbours on a contour
  double n_effective_before = 0.0;  ///< sum of ContourCorrelation::n_effective; 1 for a contour without spread
  double n_effective_after = 0.0;
};

inline void describe(Visitor& v, PooledTests& t) {
  v.derived("test", std::string("student, pooled by point"), "Name of the test.");
  describe(v, t.student);
  v.derived("n_before", t.before.n, "Number of points before.");
  v.derived("n_after", t.after.n, "Number of points after.");
  describe_test(v, {"welch", "Test with a variance for each side."}, "welch, pooled by point", t.welch);
  v("effect", t.effect, "Effect size; absent if it cannot be computed.");
  v("n_effective_before", t.n_effective_before,
    "Number of independent values that carry as much information as the points before.");
  v("n_effective_after", t.n_effective_after,
    "Number of independent values that carry as much information as the points after.");
  v("block_bootstrap", t.bootstrap,
    "Block bootstrap of the same difference, which keeps the correlation of neighbours on a contour.");
}

/// Tests by specimen: each specimen counts once, by its mean error.
struct SpecimenTests {
  SampleMoments before, after;
  TTest student;
  TTest welch;
  std::optional<TTest> paired;  ///< only for pairs of specimens
  std::optional<EffectSize> effect;
  /// Fewest specimens in each group (or pairs) for which a test at ComparisonSettings::alpha detects the effect found
  /// here with ComparisonSettings::power. Absent without an effect, and as in fewest_specimens.
  std::optional<std::size_t> fewest;
  [[nodiscard]] const TTest& main() const { return paired ? *paired : welch; }
};

inline void describe(Visitor& v, SpecimenTests& t) {
  v.derived("test", std::string(t.paired ? "paired, by specimen" : "welch, by specimen"), "Name of the main test.");
  if (!v.sets()) {
    TTest main = t.main();
    describe(v, main);
  }
  v.derived("n_before", t.before.n, "Number of specimens before.");
  v.derived("n_after", t.after.n, "Number of specimens after.");
  v.derived("mean_before_mm", t.before.mean, "Mean of the specimens' mean errors before.");
  v.derived("mean_after_mm", t.after.mean, "Mean of the specimens' mean errors after.");
  describe_test(v, {"student", "Test with a common variance."}, "student, by specimen", t.student);
  describe_test(v, {"welch", "Test with a variance for each side."}, "welch, by specimen", t.welch);
  std::optional<NamedTest> paired;
  if (t.paired) paired = NamedTest{"paired, by specimen", *t.paired};
  v("paired", paired, "Test of pairs; absent if the specimens are not pairs.");
  t.paired = paired ? std::optional(paired->test) : std::nullopt;
  v("effect", t.effect, "Effect size; absent if it cannot be computed.");
  v("fewest_specimens", t.fewest,
    "Fewest specimens in each group, or pairs, that detect this effect with the probability `power`.");
}

/// Result of compare: the errors of incisions before and after a change.
struct Comparison {
  std::vector<SpecimenRow> rows;  ///< before, then after, in the order of the input
  PooledTests points;
  SpecimenTests specimens;
};

/// Compares the errors of incisions before and after a change, by point and by specimen.
/// @pre at least one specimen on each side; pairs: as many before as after (InvalidArgument).
/// @throws InvalidArgument with every violation of the settings, and for errors that are too few or not finite.
/// Source: [Paper, III-A.1] for the test by point. The other tests depart from the paper, because the points of one
/// incision are not independent and a new patient is a new specimen, not a new point.
[[nodiscard]] Comparison compare(std::span<const MeasuredSpecimen> before, std::span<const MeasuredSpecimen> after,
                                 const ComparisonSettings& settings = {});

}  // namespace incise
