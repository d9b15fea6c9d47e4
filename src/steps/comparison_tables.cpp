#include <incise/steps/comparison_tables.hpp>

#include <fmt/format.h>

namespace incise::steps {
namespace {

std::string number(const std::optional<double>& value, int places) {
  return value ? fmt::format("{:.{}f}", *value, places) : "-";
}

/// Small p-values are written with an exponent.
std::string p_text(const std::optional<double>& p) {
  if (!p) return "-";
  return *p < 1e-4 ? fmt::format("{:.1e}", *p) : fmt::format("{:.4f}", *p);
}

std::string interval_text(const std::optional<Interval>& interval) {
  return interval ? fmt::format("{:.3f} to {:.3f}", interval->low, interval->high) : "-";
}

void add_test(TextTable& table, const TTest& test, const std::string& name) {
  table.rows.push_back({name, number(test.t, 3), number(test.df, 2), p_text(test.p), number(test.difference, 3),
                        interval_text(test.confidence), std::string(to_string(test.verdict))});
}

}  // namespace

TextTable result_table(const CutComparison& comparison) {
  TextTable table;
  table.header = {"side",
                  "specimen",
                  "outcome",
                  "points",
                  "mean ± sd mm",
                  "Hu score",
                  "Hu score of the ideal",
                  "centroid shift mm"};
  for (const ComparedRow& row : comparison.rows) {
    table.rows.push_back({row.side, row.name, std::string(to_string(row.outcome)), std::to_string(row.n_points),
                          row.sd_mm ? number(row.mean_mm, 2) + " ± " + number(row.sd_mm, 2) : "-",
                          number(row.hu_score, 3), number(row.hu_score_ideal, 3), number(row.centroid_shift_mm, 2)});
  }
  return table;
}

TextTable test_table(const CutComparison& comparison) {
  TextTable table;
  table.header = {"test", "t", "df", "p", "difference mm", "confidence interval mm", "verdict"};
  if (const auto& points = comparison.points) {
    add_test(table, points->student, "Student, pooled by point");
    add_test(table, points->welch, "Welch, pooled by point");
    const BootstrapTest& b = points->bootstrap;
    add_test(table,
             {.verdict = b.verdict,
              .difference = b.difference,
              .standard_error = b.standard_error,
              .p = b.p,
              .confidence = b.confidence},
             "block bootstrap along the contours");
  }
  if (const auto& specimens = comparison.specimens) {
    add_test(table, specimens->student, "Student, by specimen");
    add_test(table, specimens->welch, "Welch, by specimen");
    if (specimens->paired) add_test(table, *specimens->paired, "paired, by specimen");
  }
  return table;
}

}  // namespace incise::steps
