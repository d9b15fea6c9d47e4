#include "io/number_text.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/table_io.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace incise {
namespace {

/// Splits one row of a CSV file without quotes into fields.
std::vector<std::string_view> split(std::string_view row) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = row.find(',');
    fields.push_back(io_detail::trimmed(row.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    row.remove_prefix(comma + 1);
  }
}

std::string joined(const std::vector<std::string_view>& names) {
  return fmt::format("{}", fmt::join(names, ",")).substr(0, 80);
}

/// Returns the index of each name among the header's columns.
std::vector<std::size_t> find_columns(const std::vector<std::string_view>& header,
                                      const std::vector<std::string>& names, const std::filesystem::path& path,
                                      std::size_t line) {
  std::vector<std::size_t> places;
  for (const std::string& name : names) {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end()) {
      throw DataError(path, fmt::format("line {}", line), fmt::format("the header '{}'", joined(header)),
                      fmt::format("a header with the column {}", name),
                      fmt::format("The first line reads {}.", fmt::join(names, ",")));
    }
    places.push_back(static_cast<std::size_t>(found - header.begin()));
  }
  return places;
}

}  // namespace

std::vector<std::vector<double>> read_csv_columns(const std::filesystem::path& path,
                                                  const std::vector<std::string>& names) {
  const std::string text = read_text(path);
  std::string_view rest = text;
  if (rest.rfind("\xEF\xBB\xBF", 0) == 0) rest.remove_prefix(3);  // byte order mark
  std::vector<std::vector<double>> columns(names.size());
  std::vector<std::size_t> places;
  std::size_t width = 0;
  for (std::size_t line = 1; !rest.empty(); ++line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view row = io_detail::trimmed(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (row.empty()) continue;
    const auto fields = split(row);
    if (width == 0) {
      places = find_columns(fields, names, path, line);
      width = fields.size();
      continue;
    }
    if (fields.size() != width) {
      throw DataError(path, fmt::format("line {}", line), fmt::format("{} fields", fields.size()),
                      fmt::format("{}", width));
    }
    for (std::size_t k = 0; k < names.size(); ++k) {
      const auto value = io_detail::to_number(fields[places[k]]);
      if (!value || !std::isfinite(*value)) {
        throw DataError(path, fmt::format("line {}, column {}", line, names[k]),
                        fmt::format("'{}'", fields[places[k]].substr(0, 40)), "a finite number");
      }
      columns[k].push_back(*value);
    }
  }
  if (width == 0)
    throw DataError(path, "", "an empty file", fmt::format("a header {} and rows", fmt::join(names, ",")));
  return columns;
}

void write_csv_columns(const std::filesystem::path& path, const std::vector<NamedColumn>& columns) {
  INCISE_REQUIRE(!columns.empty(), "expected at least one column");
  const std::size_t rows = columns.front().second.size();
  std::string text;
  for (const auto& [name, values] : columns) {
    INCISE_REQUIRE(!name.empty() && name.find_first_of(",\"\r\n") == std::string::npos,
                   fmt::format("expected column names without comma, quote or line end, found '{}'", name));
    INCISE_REQUIRE(values.size() == rows,
                   fmt::format("expected {} values in '{}', found {}", rows, name, values.size()));
    text += (text.empty() ? "" : ",") + name;
  }
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const double value = columns[k].second[i];
      INCISE_REQUIRE(std::isfinite(value),
                     fmt::format("expected finite numbers, found {} in {} at point {}", value, columns[k].first, i));
      text += k == 0 ? "\n" : ",";
      text += io_detail::number_text(value);
    }
  }
  text += "\n";
  write_atomically(path, text);
}

}  // namespace incise
