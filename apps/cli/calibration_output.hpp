#pragma once

#include "options.hpp"

#include <incise/calibration/calibration.hpp>
#include <incise/storage/case_file.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace incise::cli {

/// Writes the table (table_1 of a grid, simulations of a fit; .csv and .tex), the figures, manifest.json and, last, calibration.json: where that is, all is.
/// @throws DataError if a file cannot be written.
void write_calibration(const std::filesystem::path& folder, const Calibration& calibration,
                       const std::vector<CaseFile>& cases, const std::vector<std::string>& specimen_ids,
                       const std::vector<std::filesystem::path>& inputs, const CommonOptions& options, double wall_s);

/// With --json the one object; else the table and what the data tell, for a person.
void print_calibration(const CommonOptions& options, const Calibration& calibration,
                       const std::filesystem::path& folder, double wall_s);

}  // namespace incise::cli
