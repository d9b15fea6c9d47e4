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

/// How much the neighbours on a contour tell the same thing twice.
struct ContourCorrelation {
  /// Points in a block: long enough for blocks to be nearly independent. 1 for independent points; at most
  /// min(3√n, n/3), which an error that varies once round the ring would exceed.
  std::size_t block = 1;
  double standard_error = 0.0;  ///< of the mean, from the means of blocks of this length
  /// Independent values that would give this standard error; about n for independent points. Absent without spread.
  std::optional<double> n_effective;
};

/// Block length for the circular bootstrap, from the autocovariance: [PolitisWhite2004] as corrected in
/// [PattonPolitisWhite2009]; on a ring the autocovariance goes round. @pre at least 3 values, all finite. O(n^1.5).
[[nodiscard]] ContourCorrelation contour_correlation(const ContourValues& contour);

struct BootstrapSettings {
  int replicates = 9999;
  std::uint64_t seed = 1;
  double level = 0.95;
};
inline void describe(Visitor& v, BootstrapSettings& s) {
  v("replicates", s.replicates, "Replicates of the block bootstrap.", {99.0, 1e6});
  v("seed", s.seed, "Same seed: same result, bit for bit.");
  v("level", s.level, "Of the interval.", {0.0, 1.0, true, true});
}

/// Two-tailed test of "the means over all points are equal" for these very contours, from circular block bootstrap
/// [PolitisRomano1992]. It asks whether the points say more than chance along a contour would; it does not make
/// specimens of them.
struct BootstrapTest {
  TestVerdict verdict = TestVerdict::TooFew;
  double difference = 0.0;  ///< after minus before, of the means over all points
  std::optional<double> standard_error;
  std::optional<double>
      p;  ///< (1 + replicates that stray from the difference as far as it is from 0) / (1 + replicates)
  std::optional<Interval> confidence;  ///< percentiles of the replicates
  int replicates = 0;                  ///< as it was asked for
  std::uint64_t seed = 0;
};
inline void describe(Visitor& v, BootstrapTest& t) {
  v("p", t.p, "Two-tailed; absent without spread.");
  v({"difference_mm", "Of the means over all points, after minus before.", "mm"}, t.difference);
  v({"standard_error_mm", "Of the difference.", "mm"}, t.standard_error);
  describe_interval(v, {"confidence_mm", "Percentiles of the replicates.", "mm"}, t.confidence);
  v("verdict", t.verdict, "Whether the test could say anything.");
  v("replicates", t.replicates, "Draws.");
  v("seed", t.seed, "Of the draws.");
}

/// Draws each contour anew from its own blocks, which wrap round. One random engine, contours in order: serial.
/// @pre at least one contour on each side, 3 values on each, all finite. O(replicates · points / block).
[[nodiscard]] BootstrapTest block_bootstrap_test(std::span<const ContourValues> before,
                                                 std::span<const ContourValues> after,
                                                 const BootstrapSettings& settings = {});

}  // namespace incise
