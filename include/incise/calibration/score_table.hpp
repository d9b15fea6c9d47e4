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

/// One pair of speed and dullness, all specimens together.
struct ScoreRow {
  RunSetting setting;                          ///< stiffness_of_case: of the first specimen
  std::size_t run = 0;                         ///< its place in each specimen's list of runs
  std::optional<double> mean_abs_mm;           ///< mean of the specimens' means; absent: all failed
  std::optional<double> sd_abs_mm;             ///< mean of the specimens' standard deviations
  std::optional<double> max_abs_mm;            ///< greatest of any specimen that did not fail
  std::optional<double> mean_signed_mm;        ///< of the mid-line against the margin, mean of the specimens' means
  std::optional<double> mean_inner_signed_mm;  ///< of the inner edge against margin less radius, likewise
  bool is_failure = false;                     ///< one specimen at least failed
  double percent = 0.0;                        ///< of the baseline; 0 for a failure
  std::size_t inner_specimens = 0;             ///< that did not fail and whose plug came free at the skin
  std::optional<double> inner_percent;         ///< of the inner edges and the photographs of those, like against like
};

/// The paper's Table I.
struct ScoreTable {
  double baseline_mm = 0.0;  ///< 0.75 mean + 0.25 max of the photographed errors
  std::vector<ScoreRow> rows;
  std::optional<std::size_t> chosen;  ///< the row nearest to 100 %; absent: all failed
};

/// The photographs' score: mean of the specimens' means, greatest of all. @pre at least one.
[[nodiscard]] double baseline_mm(std::span<const PhotographedErrors> photographs);

/// Scores settings as the paper does (III-A.2): 0.75 · mean + 0.25 · max of the absolute error over the specimens, as
/// per cent of the photographs'; a setting with which any specimen failed scores 0 %. Mean: of the specimens' means;
/// max: the greatest (the paper does not say how it joins two specimens). Like the paper it holds simulated mid-lines
/// against margin less radius and compares that with photographs of inner edges; `inner_percent` compares like with
/// like, and where only some specimens have an inner edge those with their own photographs.
/// @param runs  by specimen: the n-th of each specimen belongs to the n-th row.  @param photographs  by specimen.
/// @throws InvalidArgument for lists of different length, without any, or a baseline that is not above 0.
[[nodiscard]] ScoreTable score_table(const std::vector<std::vector<CalibrationRun>>& runs,
                                     std::span<const PhotographedErrors> photographs);

}  // namespace incise
