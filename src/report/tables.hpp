#pragma once

#include <incise/report/report_data.hpp>

#include <span>
#include <string>

namespace incise {

/// Returns `text` with a capital first letter, if that letter is ASCII.
[[nodiscard]] std::string with_capital(std::string text);

/// Returns the verdict and the three numbers of each incision, side by side; unknown values are stated in words.
[[nodiscard]] std::string answer_table(std::span<const ReportIncision> incisions);

/// HTML tables; each is empty text when there are no rows.
[[nodiscard]] std::string evaluation_table(std::span<const ReportMeasure> measures);
[[nodiscard]] std::string stage_table(std::span<const ReportStage> stages);
[[nodiscard]] std::string check_table(std::span<const ReportCheck> checks);
/// Name, value and unit; without a header.
[[nodiscard]] std::string value_table(std::span<const ReportValue> values);
[[nodiscard]] std::string file_table(std::span<const ReportFile> files);
/// With its title as a heading; cells that are numbers are right-aligned.
[[nodiscard]] std::string free_table(const ReportTable& table);

}  // namespace incise
