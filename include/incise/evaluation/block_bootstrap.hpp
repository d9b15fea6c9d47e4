#pragma once

#include <incise/core/describe.hpp>
#include <incise/evaluation/t_tests.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace incise {

/// Values at points evenly spaced along a contour, in its order.
struct ContourValues {
  std::vector<double> values;
  bool is_ring = true;  ///< the last point is the first one's neighbour
};

/// Correlation between neighbouring values on a contour.
struct ContourCorrelation {
  /// Points in a block: enough for blocks to be nearly independent. 1 for independent points. At most min(3√n, n/3),
  /// rounded up, which is too short for an error that varies once round the ring.
  std::size_t block = 1;
  double standard_error = 0.0;  ///< of the mean, from the means of blocks of this length; in the values' unit
  /// Number of independent values that would give this standard error; about n for independent points. Absent if all
  /// values are equal.
  std::optional<double> n_effective;
};

/// Computes the block length for the circular bootstrap from the autocovariance, and what follows from it. On a ring,
/// the autocovariance wraps round. O(n^1.5). Source: [PolitisWhite2004] as corrected in [PattonPolitisWhite2009].
/// @throws InvalidArgument for fewer than 3 values or a value that is not finite.
[[nodiscard]] ContourCorrelation contour_correlation(const ContourValues& contour);

struct BootstrapSettings {
  int replicates = 9999;
  std::uint64_t seed = 1;
  double level = 0.95;
};
inline void describe(Visitor& v, BootstrapSettings& s) {
  v("replicates", s.replicates, "Replicates of the block bootstrap.", {99.0, 1e6});
  v("seed", s.seed, "Seed of the draws; the same seed gives the same result, bit for bit.");
  v("level", s.level, "Level of the confidence interval.", {0.0, 1.0, true, true});
}

/// Result of a two-tailed test of "the means over all points are equal" by circular block bootstrap
/// [PolitisRomano1992]. It is about these contours only: whether their difference exceeds chance along a contour. It
/// says nothing about other specimens.
struct BootstrapTest {
  TestVerdict verdict = TestVerdict::TooFew;
  double difference = 0.0;  ///< after minus before, of the means over all points
  std::optional<double> standard_error;
  std::optional<double>
      p;  ///< (1 + replicates at least as far from the difference as that is from 0) / (1 + replicates)
  std::optional<Interval> confidence;  ///< of the difference: percentiles of the replicates
  int replicates = 0;                  ///< as in the settings
  std::uint64_t seed = 0;
};
inline void describe(Visitor& v, BootstrapTest& t) {
  v("p", t.p, "Two-tailed p; absent without spread.");
  v({"difference_mm", "Difference of the means over all points, after minus before.", "mm"}, t.difference);
  v({"standard_error_mm", "Standard error of the difference.", "mm"}, t.standard_error);
  describe_interval(v, {"confidence_mm", "Confidence interval of the difference: percentiles of the replicates.", "mm"},
                    t.confidence);
  v("verdict", t.verdict, "Whether the test could be made.");
  v("replicates", t.replicates, "Number of draws.");
  v("seed", t.seed, "Seed of the draws.");
}

/// Tests whether the mean over all points differs between `before` and `after`. In each replicate, every contour is
/// redrawn from its blocks, which wrap round. Serial: the same seed gives the same result, bit for bit. O(replicates ·
/// points / block).
/// @pre at least one contour on each side, 3 values on each, all finite, valid settings (InvalidArgument).
[[nodiscard]] BootstrapTest block_bootstrap_test(std::span<const ContourValues> before,
                                                 std::span<const ContourValues> after,
                                                 const BootstrapSettings& settings = {});

}  // namespace incise
