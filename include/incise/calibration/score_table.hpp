#pragma once

#include <incise/calibration/calibration_run.hpp>

#include <optional>
#include <span>
#include <vector>

namespace incise {

/// Errors of a photographed incision, mm: |distance − (margin − electrode radius)|.
struct PhotographedErrors {
  double mean_mm = 0.0;
  double max_mm = 0.0;
};

/// Scores of one pair of speed and dullness over all specimens.
struct ScoreRow {
  RunSetting setting;                          ///< stiffness_of_case: of the first specimen
  std::size_t run = 0;                         ///< its place in each specimen's list of runs
  std::optional<double> mean_abs_mm;           ///< mean of the specimens' means; absent: all failed
  std::optional<double> sd_abs_mm;             ///< mean of the specimens' standard deviations
  std::optional<double> max_abs_mm;            ///< greatest of any specimen that did not fail
  std::optional<double> mean_signed_mm;        ///< of the mid-line against the margin, mean of the specimens' means
  std::optional<double> mean_inner_signed_mm;  ///< of the inner edge against margin less radius, likewise
  bool is_failure = false;                     ///< at least one specimen failed
  double percent = 0.0;                        ///< of the baseline; 0 for a failure
  std::size_t inner_specimens = 0;             ///< specimens that did not fail and whose plug came free at the skin
  std::optional<double> inner_percent;         ///< score of their inner edges against their own photographs
};

/// The paper's Table I.
struct ScoreTable {
  double baseline_mm = 0.0;  ///< 0.75 mean + 0.25 max of the photographed errors
  std::vector<ScoreRow> rows;
  std::optional<std::size_t> chosen;  ///< the row nearest to 100 %; absent: all failed
};

/// Returns the photographs' score, mm: from the mean of the specimens' means and the greatest of all errors. @throws
/// InvalidArgument without any.
[[nodiscard]] double baseline_mm(std::span<const PhotographedErrors> photographs);

/// Scores settings as the paper does (III-A.2): 0.75 · mean + 0.25 · max of the absolute error over the specimens, as a
/// percentage of the photographs' score; a setting with which any specimen failed scores 0 %. The mean is that of the
/// specimens' means, the max the greatest of all (the paper does not say how it combines two specimens). Like the
/// paper, `percent` measures simulated mid-lines against margin less radius and compares them with photographed inner
/// edges. `inner_percent` compares inner edges with inner edges, of those specimens alone that have both.
/// @param runs  by specimen: the n-th of each specimen belongs to the n-th row.  @param photographs  by specimen.
/// @throws InvalidArgument for empty lists, lists of different lengths, a baseline that is not above 0, or a run that
/// is no failure and has no errors.
[[nodiscard]] ScoreTable score_table(const std::vector<std::vector<CalibrationRun>>& runs,
                                     std::span<const PhotographedErrors> photographs);

}  // namespace incise
