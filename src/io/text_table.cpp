#include "io/number_text.hpp"

#include <incise/core/error.hpp>
#include <incise/core/utf8.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/table_io.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace incise {
namespace {

/// Splits one row into cells.
std::vector<std::string> cells_of(std::string_view row, const std::filesystem::path& path, std::size_t line) {
  std::vector<std::string> cells;
  std::size_t at = 0;
  while (true) {
    while (at < row.size() && (row[at] == ' ' || row[at] == '\t')) ++at;
    std::string cell;
    if (at < row.size() && row[at] == '"') {
      ++at;
      while (at < row.size() && !(row[at] == '"' && (at + 1 == row.size() || row[at + 1] != '"'))) {
        if (row[at] == '"') ++at;  // the first of two
        cell += row[at++];
      }
      if (at == row.size()) throw DataError(path, fmt::format("line {}", line), "a quote that is not closed", "\"…\"");
      ++at;
      const std::size_t comma = std::min(row.find(',', at), row.size());
      if (!io_detail::trimmed(row.substr(at, comma - at)).empty()) {
        throw DataError(path, fmt::format("line {}", line), "text after a closing quote", "a comma or the line's end");
      }
      at = comma;
    } else {
      const std::size_t comma = std::min(row.find(',', at), row.size());
      cell = io_detail::trimmed(row.substr(at, comma - at));
      at = comma;
    }
    cells.push_back(std::move(cell));
    if (at >= row.size()) return cells;
    ++at;  // the comma
  }
}

/// Refuses control characters and invalid UTF-8, because cells end up in tables, JSON and messages.
void require_text(std::string_view row, const std::filesystem::path& path, std::size_t line) {
  const auto is_control = [](char c) { return (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == '\x7f'; };
  const auto bad = std::find_if(row.begin(), row.end(), is_control);
  const std::string place = fmt::format("line {}", line);
  if (bad != row.end()) throw DataError(path, place, fmt::format("a control character (0x{:02x})", static_cast<unsigned char>(*bad)), "text");
  if (first_not_utf8(row)) throw DataError(path, place, "bytes that are not UTF-8", "text in UTF-8", "Save the table as UTF-8");
}

void require_names(const std::vector<std::string>& header, const std::filesystem::path& path, std::size_t line) {
  for (std::size_t k = 0; k < header.size(); ++k) {
    const std::string place = fmt::format("line {}, column {}", line, k + 1);
    if (header[k].empty()) throw DataError(path, place, "no name", "a name for every column");
    if (std::count(header.begin(), header.end(), header[k]) > 1) {
      throw DataError(path, place, fmt::format("'{}' more than once", header[k]), "each column name once");
    }
  }
}

void require_rectangular(const TextTable& table) {
  for (const auto& row : table.rows) {
    INCISE_REQUIRE(row.size() == table.header.size(),
                   fmt::format("found {} cells in a row, expected {}", row.size(), table.header.size()));
  }
}

std::string quoted(const std::string& cell) {
  INCISE_REQUIRE(cell.find_first_of("\r\n") == std::string::npos, "expected cells without line ends");
  if (cell.find_first_of(",\"") == std::string::npos) return cell;
  std::string text = "\"";
  for (const char c : cell) text += c == '"' ? "\"\"" : std::string(1, c);
  return text + "\"";
}

std::string escaped_for_latex(std::string_view cell) {
  std::string text;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    const char c = cell[i];
    if (cell.substr(i, 2) == "\xC2\xB1") {  // ±
      text += "$\\pm$";
      ++i;
    } else if (cell.substr(i, 3) == "\xE2\x88\x92") {  // −
      text += "$-$";
      i += 2;
    } else if (std::string_view("&%$#_{}").find(c) != std::string_view::npos) {
      text += std::string("\\") + c;
    } else if (c == '\\') {
      text += "\\textbackslash{}";
    } else if (c == '~' || c == '^') {
      text += std::string("\\") + c + "{}";
    } else if (c == '<' || c == '>') {
      text += std::string("$") + c + "$";
    } else {
      text += c;
    }
  }
  return text;
}

template <class Format>
std::string joined(const std::vector<std::string>& row, const char* separator, Format format) {
  std::string text;
  for (std::size_t k = 0; k < row.size(); ++k) text += (k == 0 ? "" : separator) + format(row[k]);
  return text;
}

}  // namespace

TextTable read_csv_text(const std::filesystem::path& path, std::size_t most_cells) {
  const std::string text = read_text(path);
  std::string_view rest = text;
  if (rest.rfind("\xEF\xBB\xBF", 0) == 0) rest.remove_prefix(3);  // byte order mark
  TextTable table;
  for (std::size_t line = 1; !rest.empty(); ++line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view row = io_detail::trimmed(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (row.empty()) continue;
    require_text(row, path, line);
    std::vector<std::string> cells = cells_of(row, path, line);
    if (table.header.empty()) {
      require_names(cells, path, line);
      table.header = std::move(cells);
      continue;
    }
    if (cells.size() != table.header.size()) {
      throw DataError(path, fmt::format("line {}", line), fmt::format("{} fields", cells.size()),
                      fmt::format("{}", table.header.size()));
    }
    if (table.rows.size() >= most_cells / table.header.size()) {
      throw DataError(path, fmt::format("line {}", line),
                      fmt::format("more than {} rows of {} columns", table.rows.size(), table.header.size()),
                      fmt::format("at most {} cells", most_cells));
    }
    table.rows.push_back(std::move(cells));
    table.lines.push_back(line);
  }
  if (table.header.empty()) throw DataError(path, "", "an empty file", "a header and rows");
  return table;
}

std::string number_cell(const std::optional<double>& number) {
  return number ? fmt::format("{}", *number) : std::string();
}

std::string csv_text(const TextTable& table) {
  require_rectangular(table);
  std::string text = joined(table.header, ",", quoted) + "\n";
  for (const auto& row : table.rows) text += joined(row, ",", quoted) + "\n";
  return text;
}

std::string latex_text(const TextTable& table) {
  require_rectangular(table);
  std::string text =
      "% \\usepackage{booktabs}\n\\begin{tabular}{" + std::string(table.header.size(), 'l') + "}\n\\toprule\n";
  text += joined(table.header, " & ", escaped_for_latex) + " \\\\\n\\midrule\n";
  for (const auto& row : table.rows) text += joined(row, " & ", escaped_for_latex) + " \\\\\n";
  return text + "\\bottomrule\n\\end{tabular}\n";
}

}  // namespace incise
