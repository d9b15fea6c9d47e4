#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace incise {

/// A column of numbers with its name, unit included (`signed_error_mm`).
using NamedColumn = std::pair<std::string, std::vector<double>>;

/// Reads columns of numbers from a `.csv` by the names in its header, in any order and among others. Accepts a byte
/// order mark, CRLF and blank lines; does not support quotes.
/// @returns one list for each of `names`, in their order, all equally long.
/// @throws DataError naming line and column: missing column, a row of another width, a bad or non-finite value, an
///         empty file.
[[nodiscard]] std::vector<std::vector<double>> read_csv_columns(const std::filesystem::path& path,
                                                                const std::vector<std::string>& names);

/// A table of text: a header, and rows with as many cells as the header.
struct TextTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> lines;  ///< number of each row's line in the file, from 1
};

/// Returns a number as a cell, empty if it is absent; or one member of a value that may be absent.
[[nodiscard]] std::string number_cell(const std::optional<double>& number);
template <class T>
[[nodiscard]] std::string number_cell(const std::optional<T>& value, double T::*member) {
  return number_cell(value ? std::optional((*value).*member) : std::nullopt);
}

/// Reads every cell of a `.csv` as text, trimmed; for columns whose printed digits matter. Cells in double quotes may
/// hold commas; a quote inside is doubled. Line ends inside quotes are not supported.
/// @param most_cells  limit on the cells of all rows together
/// @throws DataError naming the line: a row of another width, an unclosed quote, a column name that is empty or given
///         twice, a control character, bytes that are not UTF-8, an empty file, more cells than `most_cells`.
[[nodiscard]] TextTable read_csv_text(const std::filesystem::path& path,
                                      std::size_t most_cells = std::numeric_limits<std::size_t>::max());

/// Returns the table as CSV: LF line ends, cells with a comma or quote quoted.
/// @pre rows as wide as the header, no line ends in cells (InvalidArgument).
[[nodiscard]] std::string csv_text(const TextTable& table);

/// Returns the table as a LaTeX `tabular` for the booktabs package; cells are text with special characters escaped, and
/// ± becomes $\pm$. @pre rows as wide as the header (InvalidArgument).
[[nodiscard]] std::string latex_text(const TextTable& table);

/// Writes a header and rows, LF line ends. Each number is the shortest text that reads back to the same double.
/// @pre at least one column; all numbers finite; columns equally long; names not empty and without comma, quote or line
///      end (InvalidArgument).
/// @throws DataError if the file cannot be written.
void write_csv_columns(const std::filesystem::path& path, const std::vector<NamedColumn>& columns);

}  // namespace incise
