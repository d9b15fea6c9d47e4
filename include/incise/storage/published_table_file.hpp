#pragma once

#include <incise/evaluation/published_table.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace incise {

struct PublishedTable {
  std::vector<PrintedRow> rows;
  std::vector<std::string> number_columns;  ///< headers of the columns read as numbers
  std::vector<std::string> name_columns;    ///< headers of all others, which distinguish the rows
};

/// Reads a published table from a `.csv`, with the digits as printed. Columns, in any order; the unit in a name such as
/// `mean_mm` is optional:
///
///   mean, sd                    of the row; required
///   max, min, n                 of the row; optional
///   PART_mean, PART_sd          of a set that the row was pooled from; optional, but only together
///   PART_max, PART_min, PART_n  of the same set; optional
///   score_percent               0.75 mean + 0.25 max as per cent of a baseline; optional
///
/// Every other column belongs to the row's name. A cell that is empty or reads -, n/a, failure or failed has no value.
/// A set without mean is dropped; a set without sd is kept for its mean and n.
/// @throws DataError naming line and column: no column mean or no column sd, a part with only one of the two, two
///         columns for one quantity, no rows, a cell that is no decimal number, a count that is not whole or below 1,
///         more than 200 000 cells; or as read_csv_text.
[[nodiscard]] PublishedTable read_published_table(const std::filesystem::path& path);

}  // namespace incise
