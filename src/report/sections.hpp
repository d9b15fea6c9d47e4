#pragma once

#include "report/slices.hpp"

#include <incise/report/report_data.hpp>

#include <array>
#include <string>

namespace incise {

// The parts of the page as HTML. Each says in a sentence when its data are missing.

[[nodiscard]] std::string page_header(const ReportData& data);
/// The first screen: the verdict in a line, the contours side by side, the three numbers.
[[nodiscard]] std::string answer_section(const ReportData& data);
/// The verdict's reasons and the notices, worst first.
[[nodiscard]] std::string findings_section(const ReportData& data);
/// Empty without caveats.
[[nodiscard]] std::string caveats_section(const ReportData& data);
[[nodiscard]] std::string scan_section(const ReportData& data, const std::array<SlicePlane, 3>& planes);
/// @param mesh_is_shown  false when the mesh is absent or too large for the page.
[[nodiscard]] std::string mesh_section(const ReportData& data, bool mesh_is_shown);
[[nodiscard]] std::string cut_section(const ReportData& data);
[[nodiscard]] std::string error_section(const ReportData& data);
[[nodiscard]] std::string kerf_section(const ReportData& data);
[[nodiscard]] std::string program_section(const ReportData& data);
/// Empty without pictures.
[[nodiscard]] std::string tissue_section(const ReportData& data);
[[nodiscard]] std::string record_section(const ReportData& data);
[[nodiscard]] std::string page_footer();

}  // namespace incise
