#pragma once

#include <incise/storage/evaluation_file.hpp>
#include <incise/storage/run_folder.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <vector>

namespace incise::cli {

struct ComparedFiles {
  std::vector<EvaluationFile> before;
  std::vector<EvaluationFile> after;
};

struct ComparisonOutput {
  ComparedFiles files;
  ComparisonSettings settings;
  nlohmann::ordered_json json;  ///< what --json prints and compare.json holds
};

/// Compares the specimens that have errors. Those on which no incision was found stay in the table, are named under
/// `left_out` and make no mean better. A side without any errors has a verdict, `too_few`, and no test.
[[nodiscard]] ComparisonOutput compared(ComparedFiles files, const ComparisonSettings& settings);

/// Writes the folder: compare.json, table.csv, table.tex, tests.csv, tests.tex, box_plot and error_by_clock as .svg and
/// .png, manifest.json. @throws DataError if it cannot be written.
void write_comparison(const std::filesystem::path& folder, const ComparisonOutput& output,
                      const std::vector<std::filesystem::path>& inputs, const RunContext& context, double wall_s);

}  // namespace incise::cli
