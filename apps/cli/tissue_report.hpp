#pragma once

#include <incise/report/report_data.hpp>

#include <filesystem>

namespace incise::cli {

/// Adds to a report what `register` and `replay` left in their folders: their figures and numbers. An empty path: nothing of that kind.
/// @throws DataError if a folder holds no such results.
void add_on_tissue(const std::filesystem::path& registration, const std::filesystem::path& replay, ReportData& data);

}  // namespace incise::cli
