#include <incise/calibration/score_table.hpp>
#include <incise/core/error.hpp>
#include <incise/evaluation/registration_score.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

/// Sums over the specimens that did not fail.
struct RowSums {
  double mean = 0.0, sd = 0.0, greatest = 0.0, mean_signed = 0.0, inner = 0.0;
  double inner_abs = 0.0, inner_greatest = 0.0;
  double count = 0.0, inner_count = 0.0;

  /// Adds a run. Returns whether its inner edge is in the sums, too.
  bool add(const CalibrationRun& run) {
    if (run.is_failure()) return false;
    INCISE_REQUIRE(run.paper_abs_error_mm && run.signed_error_mm, "expected errors of every run that did not fail");
    count += 1.0;
    mean += run.paper_abs_error_mm->mean;
    sd += run.paper_abs_error_mm->sd;
    greatest = std::max(greatest, run.paper_abs_error_mm->max);
    mean_signed += run.signed_error_mm->mean;
    if (!run.inner_signed_error_mm || !run.inner_abs_error_mm) return false;
    inner_count += 1.0;
    inner += run.inner_signed_error_mm->mean;
    inner_abs += run.inner_abs_error_mm->mean;
    inner_greatest = std::max(inner_greatest, run.inner_abs_error_mm->max);
    return true;
  }
};

/// Scores the inner edges against the photographs of the specimens that have one. Leaves the score absent if none has.
void score_inner_edges(ScoreRow& row, const RowSums& sums, const std::vector<PhotographedErrors>& photographs) {
  row.inner_specimens = photographs.size();
  if (photographs.empty()) return;
  row.mean_inner_signed_mm = sums.inner / sums.inner_count;
  const double score = registration_score_mm(sums.inner_abs / sums.inner_count, sums.inner_greatest);
  row.inner_percent = registration_percent(score, baseline_mm(photographs));
}

ScoreRow row_of(const std::vector<std::vector<CalibrationRun>>& runs, std::size_t number,
                std::span<const PhotographedErrors> photographs, double baseline) {
  ScoreRow row;
  row.setting = runs.front()[number].setting;
  row.run = number;
  RowSums sums;
  std::vector<PhotographedErrors> of_inner_edges;
  for (std::size_t s = 0; s < runs.size(); ++s) {
    const CalibrationRun& run = runs[s][number];
    row.is_failure = row.is_failure || run.is_failure();
    if (sums.add(run)) of_inner_edges.push_back(photographs[s]);
  }
  if (sums.count > 0.0) {
    row.mean_abs_mm = sums.mean / sums.count;
    row.sd_abs_mm = sums.sd / sums.count;
    row.max_abs_mm = sums.greatest;
    row.mean_signed_mm = sums.mean_signed / sums.count;
  }
  std::optional<double> score;
  if (!row.is_failure) score = registration_score_mm(*row.mean_abs_mm, *row.max_abs_mm);
  row.percent = registration_percent(score, baseline);
  score_inner_edges(row, sums, of_inner_edges);
  return row;
}

}  // namespace

double baseline_mm(std::span<const PhotographedErrors> photographs) {
  INCISE_REQUIRE(!photographs.empty(), "expected at least one photograph");
  double mean = 0.0;
  double greatest = 0.0;
  for (const PhotographedErrors& errors : photographs) {
    mean += errors.mean_mm / static_cast<double>(photographs.size());
    greatest = std::max(greatest, errors.max_mm);
  }
  return registration_score_mm(mean, greatest);
}

ScoreTable score_table(const std::vector<std::vector<CalibrationRun>>& runs,
                       std::span<const PhotographedErrors> photographs) {
  INCISE_REQUIRE(!runs.empty() && !runs.front().empty(), "expected at least one specimen and one run");
  for (const auto& list : runs) {
    INCISE_REQUIRE(list.size() == runs.front().size(),
                   fmt::format("expected {} runs for each specimen, found {}", runs.front().size(), list.size()));
  }
  INCISE_REQUIRE(photographs.size() == runs.size(),
                 fmt::format("expected {} photographs, found {}", runs.size(), photographs.size()));
  ScoreTable table;
  table.baseline_mm = baseline_mm(photographs);
  for (std::size_t i = 0; i < runs.front().size(); ++i) {
    table.rows.push_back(row_of(runs, i, photographs, table.baseline_mm));
  }
  const auto off = [](const ScoreRow& row) { return row.is_failure ? HUGE_VAL : std::abs(row.percent - 100.0); };
  const auto best = std::min_element(table.rows.begin(), table.rows.end(),
                                     [&off](const ScoreRow& a, const ScoreRow& b) { return off(a) < off(b); });
  if (!best->is_failure) table.chosen = static_cast<std::size_t>(best - table.rows.begin());
  return table;
}

}  // namespace incise
