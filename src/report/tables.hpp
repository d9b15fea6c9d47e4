#pragma once

#include <incise/report/report_data.hpp>

#include <span>
#include <string>

namespace incise {

/// With a capital as its first letter, where that is one of ASCII.
[[nodiscard]] std::string with_capital(std::string text);

/// The verdict and the three numbers of each incision, side by side; what is not known is said in words.
[[nodiscard]] std::string answer_table(std::span<const ReportIncision> incisions);

/// HTML tables; each is empty text when there are no rows.
[[nodiscard]] std::string evaluation_table(std::span<const ReportMeasure> measures);
[[nodiscard]] std::string stage_table(std::span<const ReportStage> stages);
[[nodiscard]] std::string check_table(std::span<const ReportCheck> checks);
/// Name, value and unit; without a header.
[[nodiscard]] std::string value_table(std::span<const ReportValue> values);
[[nodiscard]] std::string file_table(std::span<const ReportFile> files);
/// With its title as a heading; right-aligned where a cell reads as a number.
[[nodiscard]] std::string free_table(const ReportTable& table);

}  // namespace incise
