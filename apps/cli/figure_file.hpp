#pragma once

#include <filesystem>
#include <string>

namespace incise::cli {

/// Refuses, before anything is computed, a figure that is neither .svg nor .png, or cannot be written.
/// @throws CaseError naming the option; DataError.
void require_figure_file(const std::filesystem::path& path, const char* option);

/// Writes a figure as the file's ending says. @pre require_figure_file.
void write_figure(const std::filesystem::path& path, const std::string& svg);

}  // namespace incise::cli
