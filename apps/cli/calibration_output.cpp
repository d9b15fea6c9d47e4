#include "calibration_output.hpp"

#include <incise/storage/calibration_file.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise::cli {
namespace {

std::string score_in_words(const Calibration& calibration) {
  if (!calibration.score_percent) return "no inner edge to score";
  const std::string score = fmt::format("{:.1f} % of the baseline", *calibration.score_percent);
  if (!calibration.fit) return score;
  const std::size_t specimens = calibration.specimens.size();
  return fmt::format("{} by the inner edges of {} of {} {}", score,
                     calibration.table.rows[*calibration.table.chosen].inner_specimens, specimens,
                     specimens == 1 ? "specimen" : "specimens");
}

/// Adds each row's stiffness, as a multiple of that of the (first) case, if the rows differ in it.
void add_stiffness(TextTable& table, const std::vector<ScoreRow>& rows) {
  const auto stiffness_of = [](const ScoreRow& row) { return row.setting.stiffness_of_case; };
  if (std::ranges::adjacent_find(rows, std::ranges::not_equal_to{}, stiffness_of) == rows.end()) return;
  constexpr std::ptrdiff_t kAfterDullness = 2;
  table.header.insert(table.header.begin() + kAfterDullness, "x stiffness");
  for (std::size_t i = 0; i < rows.size(); ++i)
    table.rows[i].insert(table.rows[i].begin() + kAfterDullness, fmt::format("{:.3g}", stiffness_of(rows[i])));
}

void print_estimate(const char* name, const ParameterEstimate& estimate) {
  fmt::print("{:<24} {:>8.3f} ± {:.3f}   {:.3f} to {:.3f}\n", name, estimate.mean, estimate.sd, estimate.low,
             estimate.high);
}

}  // namespace

void print_calibration(const Calibration& calibration, const std::filesystem::path& folder) {
  TextTable table = calibration_table_rounded(calibration);
  add_stiffness(table, calibration.table.rows);
  const auto print_row = [](const std::vector<std::string>& cells) {
    for (const std::string& cell : cells) fmt::print("{:>16}", cell);
    fmt::print("\n");
  };
  print_row(table.header);
  for (const auto& row : table.rows) print_row(row);
  fmt::print("\nbaseline {:.3f} mm; the table's scores are of mid-lines, as in the paper\n",
             calibration.table.baseline_mm);
  for (const LeftOutSpecimen& one : calibration.left_out) fmt::print("left out: {}: {}\n", one.name, one.reason);
  if (calibration.fit) {
    fmt::print("\n{:<24} {:>8} ± sd      {:.0f} % interval\n", "", "mean", 100.0 * DragFitSettings{}.credible);
    print_estimate("drag length mm", calibration.fit->drag_length_mm);
    print_estimate("ln stiffness factor", calibration.fit->ln_stiffness);
    print_estimate("bias mm", calibration.fit->bias_mm);
    fmt::print("\n");
    for (const std::string& sentence : calibration.identifiability->sentences) fmt::print("{}\n", sentence);
  }
  if (calibration.chosen) {
    fmt::print("\nchosen: {:.3g} mm/s x {:.3g}, {}\n", calibration.chosen->speed_mm_s, calibration.chosen->dullness,
               score_in_words(calibration));
  }
  fmt::print("all results: {}\n", (folder / "calibration.json").string());
}

}  // namespace incise::cli
