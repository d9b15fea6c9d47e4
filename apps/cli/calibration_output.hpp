#pragma once

#include <incise/steps/case_steps.hpp>

#include <filesystem>

namespace incise::cli {

/// Prints the table, and which parameters the data identify.
void print_calibration(const Calibration& calibration, const std::filesystem::path& folder);

}  // namespace incise::cli
