#pragma once

#include <incise/evaluation/published_table.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace incise {

struct PublishedTable {
  std::vector<PrintedRow> rows;
  std::vector<std::string> number_columns;  ///< headers of those that were read as numbers
  std::vector<std::string> name_columns;    ///< headers of all others, which tell the rows apart
};

/// Reads a published table, digits as printed. Columns, in any order; a unit after the name (`mean_mm`) may be left
/// out:
///
///   mean, sd            needed; of the row                     max, min, n     optional
///   PART_mean, PART_sd  of a set that the row was pooled from  PART_max, PART_min, PART_n   optional
///   score_percent       0.75 mean + 0.25 max as per cent of a baseline
///
/// Every other column belongs to the row's name. A cell that is empty or reads -, n/a, failure or failed holds nothing;
/// a set without mean is left out, one without sd is kept: its mean and n count.
/// @throws DataError naming line and column: neither mean nor sd among the columns, a part with one of the two,
/// a cell that is no decimal number, a count that is not whole or below 1, more than 200 000 cells.
[[nodiscard]] PublishedTable read_published_table(const std::filesystem::path& path);

}  // namespace incise
