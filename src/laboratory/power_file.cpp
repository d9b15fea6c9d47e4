#include <incise/core/error.hpp>
#include <incise/laboratory/power_file.hpp>

#include <fmt/format.h>

namespace incise {
namespace {

/// Refuses impossible lengths and speeds: a wrong unit would set the robot's speed.
void require_possible(const TimedCut& cut, const std::filesystem::path& file, std::size_t line) {
  if (!(cut.length_mm >= kShortestTimedCutMm && cut.length_mm <= kLongestTimedCutMm)) {
    throw DataError(file, fmt::format("line {}, column length_mm", line), fmt::format("{}", cut.length_mm),
                    fmt::format("{} to {} mm", kShortestTimedCutMm, kLongestTimedCutMm));
  }
  const double speed_mm_s = cut.length_mm / cut.time_s;
  if (speed_mm_s >= kSlowestCutMmS && speed_mm_s <= kFastestCutMmS) return;
  throw DataError(file, fmt::format("line {}, column time_s", line),
                  fmt::format("{} mm in {} s: {:.4g} mm/s", cut.length_mm, cut.time_s, speed_mm_s),
                  fmt::format("{} to {} mm/s", kSlowestCutMmS, kFastestCutMmS));
}

void add_rows(TextTable& table, const char* series, const std::vector<PowerCut>& cuts) {
  for (const PowerCut& cut : cuts) {
    table.rows.push_back({series, cut.specimen, fmt::format("{}", cut.power_w), fmt::format("{}", cut.speed_mm_s),
                          std::string(to_string(cut.outcome)), number_cell(cut.bulge_mm),
                          number_cell(cut.thermal_width_mm), number_cell(cut.mean_abs_error_mm), cut.problem});
  }
}

}  // namespace

TextTable power_table(const PowerSeries& series) {
  TextTable table;
  table.header = {"series",   "specimen",         "power_w",           "speed_mm_s", "outcome",
                  "bulge_mm", "thermal_width_mm", "mean_abs_error_mm", "problem"};
  add_rows(table, "power", series.cuts);
  add_rows(table, "speed", series.speed_cuts);
  return table;
}

std::vector<TimedCut> read_timed_cuts(const std::filesystem::path& file) {
  const std::vector<std::string> names{"length_mm", "time_s"};
  const auto columns = read_csv_columns(file, names);
  const std::vector<std::size_t> lines = read_csv_text(file).lines;
  std::vector<TimedCut> cuts;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (columns[k][i] > 0.0) continue;
      throw DataError(file, fmt::format("line {}, column {}", lines[i], names[k]), fmt::format("{}", columns[k][i]),
                      "a number above 0");
    }
    cuts.push_back({columns[0][i], columns[1][i]});
    require_possible(cuts.back(), file, lines[i]);
  }
  if (cuts.empty()) throw DataError(file, "", "no rows", "at least one timed cut");
  return cuts;
}

}  // namespace incise
