#include <incise/core/error.hpp>
#include <incise/io/table_io.hpp>
#include <incise/storage/published_table_file.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>

namespace incise {
namespace {

constexpr std::array<std::string_view, 5> kQuantities{"mean", "sd", "max", "min", "n"};

/// Limits memory: each row takes some kB. A published table has a few hundred cells.
constexpr std::size_t kMostCells = 200'000;

/// Content of a column: a quantity of a part; part "" is the row itself.
struct ColumnRole {
  std::string part;
  std::string quantity;  ///< one of kQuantities; empty: part of the row's name
};

ColumnRole role_of(std::string name) {
  constexpr std::string_view kUnit = "_mm";
  if (name.size() > kUnit.size() && name.ends_with(kUnit)) name.resize(name.size() - kUnit.size());
  for (const std::string_view quantity : kQuantities) {
    if (name == quantity) return {"", std::string(quantity)};
    const std::string ending = "_" + std::string(quantity);
    if (name.size() > ending.size() && name.ends_with(ending)) {
      return {name.substr(0, name.size() - ending.size()), std::string(quantity)};
    }
  }
  return {};
}

bool says_nothing(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text.empty() || text == "-" || text == "–" || text == "n/a" || text == "failure" || text == "failed";
}

/// Index of the column for each quantity of each part; parts in the order of the header.
struct Columns {
  std::vector<std::string> parts;
  std::map<std::string, std::map<std::string, std::size_t>> places;
  std::vector<std::size_t> names;
  std::optional<std::size_t> score;
};

Columns columns_of(const TextTable& table, const std::filesystem::path& path) {
  Columns columns;
  for (std::size_t k = 0; k < table.header.size(); ++k) {
    const ColumnRole role = role_of(table.header[k]);
    if (table.header[k] == "score_percent") {
      columns.score = k;
    } else if (role.quantity.empty()) {
      columns.names.push_back(k);
    } else {
      if (columns.places.count(role.part) == 0) columns.parts.push_back(role.part);
      const auto [place, is_new] = columns.places[role.part].emplace(role.quantity, k);
      if (!is_new) {
        throw DataError(path, "line 1", fmt::format("'{}' and '{}'", table.header[place->second], table.header[k]),
                        "one column for each quantity");
      }
    }
  }
  const auto own = columns.places.find("");
  if (own == columns.places.end() || own->second.count("mean") == 0 || own->second.count("sd") == 0) {
    throw DataError(path, "line 1", fmt::format("the columns {}", fmt::join(table.header, ", ")),
                    "the columns mean_mm and sd_mm",
                    "Optional: max_mm, min_mm, n, score_percent, and PART_mean_mm, PART_sd_mm, PART_n of the parts "
                    "from which a row was pooled");
  }
  for (const auto& [part, places] : columns.places) {
    if (places.count("mean") != places.count("sd")) {
      throw DataError(path, "line 1", fmt::format("only one of {0}_mean_mm and {0}_sd_mm", part), "both or neither");
    }
    if (places.count("mean") == 0) {
      throw DataError(path, "line 1", fmt::format("no column {0}_mean_mm", part),
                      fmt::format("the mean and sd of what '{}' belongs to", table.header[places.begin()->second]));
    }
  }
  return columns;
}

/// One row of the file, with what errors need to name it.
struct TableRow {
  const std::filesystem::path& path;
  const TextTable& table;
  std::size_t index;

  [[nodiscard]] std::optional<PrintedNumber> number(std::size_t column) const {
    const std::string& cell = table.rows[index][column];
    if (says_nothing(cell)) return std::nullopt;
    const auto value = printed_number(cell);
    if (!value) refuse(column, "a decimal number, or nothing, -, n/a, failure");
    return value;
  }
  [[noreturn]] void refuse(std::size_t column, const char* expected) const {
    throw DataError(path, fmt::format("line {}, column {}", table.lines[index], table.header[column]),
                    fmt::format("'{}'", table.rows[index][column].substr(0, 40)), expected);
  }
};

std::optional<PrintedGroup> group_of(const TableRow& row, const std::string& part,
                                     const std::map<std::string, std::size_t>& places) {
  std::map<std::string, std::optional<PrintedNumber>> cells;
  for (const auto& [quantity, column] : places) cells[quantity] = row.number(column);
  if (!cells["mean"]) return std::nullopt;
  PrintedGroup group{.name = part, .mean = *cells["mean"], .sd = cells["sd"]};
  group.max = cells["max"];
  group.min = cells["min"];
  if (cells["n"]) {
    const double n = cells["n"]->value;
    if (n < 1.0 || n != std::floor(n) || n > 1e15) row.refuse(places.at("n"), "a whole number of at least 1");
    group.n = static_cast<std::size_t>(n);
  }
  return group;
}

}  // namespace

PublishedTable read_published_table(const std::filesystem::path& path) {
  const TextTable table = read_csv_text(path, kMostCells);
  const Columns columns = columns_of(table, path);
  if (table.rows.empty()) throw DataError(path, "", "a header without rows", "at least one row");
  PublishedTable result;
  for (std::size_t k = 0; k < table.header.size(); ++k) {
    const bool is_name = std::find(columns.names.begin(), columns.names.end(), k) != columns.names.end();
    (is_name ? result.name_columns : result.number_columns).push_back(table.header[k]);
  }
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const TableRow row{path, table, i};
    PrintedRow printed;
    for (const std::size_t column : columns.names) {
      printed.name += (printed.name.empty() ? "" : ", ") + table.header[column] + " " + table.rows[i][column];
    }
    if (printed.name.empty()) printed.name = fmt::format("line {}", table.lines[i]);
    for (const std::string& part : columns.parts) {
      auto group = group_of(row, part, columns.places.at(part));
      if (!group) continue;
      if (part.empty()) {
        printed.total = std::move(group);
      } else {
        printed.parts.push_back(std::move(*group));
      }
    }
    if (columns.score) printed.score_percent = row.number(*columns.score);
    result.rows.push_back(std::move(printed));
  }
  return result;
}

}  // namespace incise
