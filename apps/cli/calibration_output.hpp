#pragma once

#include <incise/steps/case_steps.hpp>

#include <filesystem>

namespace incise::cli {

/// The table and what the data tell, for a person.
void print_calibration(const Calibration& calibration, const std::filesystem::path& folder);

}  // namespace incise::cli
