#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
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

/// A table of text, as in a file: a header, and rows of as many cells as it has.
struct TextTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> lines;  ///< of the file, from 1: where each row stands
};

/// Reads every cell of a `.csv` as text, blanks round it removed; for columns whose printed digits matter. Cells in
/// double quotes may hold commas; a quote inside is doubled; a line end is not known there.
/// @param most_cells  that the rows may hold together; the first row beyond is refused before it is kept.
/// @throws DataError naming the line: a row of another width, a quote that does not end, a column name given twice or
/// empty, a control character, bytes that are not UTF-8, an empty file, more cells than `most_cells`.
[[nodiscard]] TextTable read_csv_text(const std::filesystem::path& path,
                                      std::size_t most_cells = std::numeric_limits<std::size_t>::max());

/// The table as CSV (LF; cells with comma or quote are quoted). @pre rows as wide as the header, no line ends.
[[nodiscard]] std::string csv_text(const TextTable& table);

/// The table as a LaTeX `tabular` for the booktabs package; every cell is text, its special characters escaped, and
/// "a ± b" set as $a \pm b$. @pre as csv_text.
[[nodiscard]] std::string latex_text(const TextTable& table);

/// Writes a header and rows, LF line ends. Numbers are the shortest text that reads back to the same double.
/// @pre all numbers finite; columns equally long; names without comma, quote or line end.
/// @throws DataError if the file cannot be written.
void write_csv_columns(const std::filesystem::path& path, const std::vector<NamedColumn>& columns);

}  // namespace incise
