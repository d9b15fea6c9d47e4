#include <incise/storage/calibration_file.hpp>

#include <fmt/format.h>

namespace incise {
namespace {

constexpr int kFullDigits = 6;
constexpr int kScoreDigits = 4;

std::string cell_text(const std::optional<double>& value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : std::string();
}

std::optional<double> part_of(const std::optional<Summary>& summary, double Summary::*part) {
  return summary ? std::optional(*summary.*part) : std::nullopt;
}

/// Returns mean, sd and greatest error of one run; nothing for a failure, whose numbers are no errors of a resection.
std::optional<Summary> errors_of(const CalibrationRun& run) {
  return run.is_failure() ? std::nullopt : run.paper_abs_error_mm;
}

std::string mean_and_sd(const std::optional<double>& mean, const std::optional<double>& sd) {
  return mean && sd ? fmt::format("{:.1f} ± {:.1f}", *mean, *sd) : std::string("-");
}

}  // namespace

TextTable calibration_table(const Calibration& calibration) {
  TextTable table;
  table.header = {"speed_mm_s", "dullness", "drag_length_mm"};
  for (std::size_t s = 1; s <= calibration.specimens.size(); ++s) {
    for (const char* column : {"outcome", "stiffness_of_case", "mean_mm", "sd_mm", "max_mm", "signed_error_mm"}) {
      table.header.push_back(fmt::format("s{}_{}", s, column));
    }
  }
  for (const char* column : {"mean_mm", "sd_mm", "max_mm", "signed_error_mm", "inner_signed_error_mm", "failure",
                             "inner_edge_specimens", "inner_edge_score_percent", "score_percent"}) {
    table.header.emplace_back(column);
  }
  for (const ScoreRow& row : calibration.table.rows) {
    const RunSetting& setting = row.setting;
    std::vector<std::string> cells{
        fmt::format("{}", setting.speed_mm_s), fmt::format("{}", setting.dullness),
        fmt::format("{:.4f}", setting.speed_mm_s * setting.dullness * calibration.reference_step_s)};
    for (const CalibratedSpecimen& specimen : calibration.specimens) {
      const CalibrationRun& run = specimen.runs[row.run];
      const std::optional<Summary> errors = errors_of(run);
      cells.emplace_back(run.is_failure() && run.outcome == Outcome::Success ? "failure" : to_string(run.outcome));
      cells.push_back(fmt::format("{:.6g}", run.setting.stiffness_of_case));
      cells.push_back(cell_text(part_of(errors, &Summary::mean), kFullDigits));
      cells.push_back(cell_text(part_of(errors, &Summary::sd), kFullDigits));
      cells.push_back(cell_text(part_of(errors, &Summary::max), kFullDigits));
      cells.push_back(cell_text(part_of(run.signed_error_mm, &Summary::mean), kFullDigits));
    }
    for (const auto& value :
         {row.mean_abs_mm, row.sd_abs_mm, row.max_abs_mm, row.mean_signed_mm, row.mean_inner_signed_mm}) {
      cells.push_back(cell_text(value, kFullDigits));
    }
    cells.emplace_back(row.is_failure ? "yes" : "no");
    cells.push_back(fmt::format("{}", row.inner_specimens));
    cells.push_back(cell_text(row.inner_percent, kScoreDigits));
    cells.push_back(cell_text(row.percent, kScoreDigits));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

TextTable calibration_table_rounded(const Calibration& calibration) {
  TextTable table;
  table.header = {"speed mm/s", "dullness"};
  for (const CalibratedSpecimen& specimen : calibration.specimens) table.header.push_back(specimen.name + " mm");
  for (const char* column : {"all mm", "max mm", "score %"}) table.header.emplace_back(column);
  for (const ScoreRow& row : calibration.table.rows) {
    std::vector<std::string> cells{fmt::format("{:.3g}", row.setting.speed_mm_s),
                                   fmt::format("{:.3g}", row.setting.dullness)};
    for (const CalibratedSpecimen& specimen : calibration.specimens) {
      const std::optional<Summary> errors = errors_of(specimen.runs[row.run]);
      cells.push_back(errors ? mean_and_sd(errors->mean, errors->sd) : "Failure");
    }
    cells.push_back(row.is_failure ? "-" : mean_and_sd(row.mean_abs_mm, row.sd_abs_mm));
    cells.push_back(row.max_abs_mm ? fmt::format("{:.1f}", *row.max_abs_mm) : "-");
    cells.push_back(fmt::format("{:.1f}", row.percent));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace incise
