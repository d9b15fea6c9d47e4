#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace incise {

/// A column of numbers with its name, unit included (`signed_error_mm`).
using NamedColumn = std::pair<std::string, std::vector<double>>;

/// Reads columns of numbers from a `.csv` by the names in its header, in any order and among others. A byte order mark,
/// CRLF and blank lines are fine; quoting is not known.
/// @returns one list for each of `names`, in their order; equally long.
/// @throws DataError naming line and column: missing column, a row of another width, a bad or not-a-number value, an
/// empty file.
[[nodiscard]] std::vector<std::vector<double>> read_csv_columns(const std::filesystem::path& path,
                                                                const std::vector<std::string>& names);

/// Writes a header and rows, LF line ends. Numbers are the shortest text that reads back to the same double.
/// @pre all numbers finite; columns equally long; names without comma, quote or line end.
/// @throws DataError if the file cannot be written.
void write_csv_columns(const std::filesystem::path& path, const std::vector<NamedColumn>& columns);

}  // namespace incise
