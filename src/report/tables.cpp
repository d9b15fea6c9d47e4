#include "report/tables.hpp"

#include "report/svg.hpp"

#include <incise/io/text_encoding.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace incise {
namespace {

/// Grows one HTML table. Cells are escaped here.
class TableWriter {
 public:
  void header(std::string_view name, bool is_number = false) {
    head_ += fmt::format("<th scope=\"col\"{}>{}</th>", is_number ? " class=\"number\"" : "", escaped(name));
  }
  void row() { body_ += body_.empty() ? "<tr>" : "</tr>\n<tr>"; }
  void name(std::string_view text) { body_ += fmt::format("<th scope=\"row\">{}</th>", escaped(text)); }
  void cell(std::string_view text) { body_ += fmt::format("<td>{}</td>", escaped(text)); }
  void code(std::string_view text) { body_ += fmt::format("<td><code>{}</code></td>", escaped(text)); }
  void unit(std::string_view text) { body_ += fmt::format("<td class=\"unit\">{}</td>", escaped(text)); }
  void number(std::string_view text) { body_ += fmt::format("<td class=\"number\">{}</td>", escaped(text)); }
  void raw(std::string_view html) { body_ += fmt::format("<td>{}</td>", html); }
  [[nodiscard]] std::string html() const {
    if (body_.empty()) return "";
    const std::string head = head_.empty() ? "" : "<thead><tr>" + head_ + "</tr></thead>\n";
    return "<div class=\"table\"><table>\n" + head + "<tbody>\n" + body_ + "</tr>\n</tbody></table></div>\n";
  }

 private:
  std::string head_, body_;
};

std::string optional_text(const std::optional<double>& value) {
  return value ? number_text(*value) : "–";
}

bool reads_as_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

/// As a reader writes it.
std::string sign_of(const std::string& relation) {
  if (relation == ">=") return "≥ ";
  return relation == "<=" ? "≤ " : relation + " ";
}

}  // namespace

std::string evaluation_table(std::span<const ReportMeasure> measures) {
  const auto has = [&](std::optional<double> ReportMeasure::*which) {
    return std::any_of(measures.begin(), measures.end(),
                       [which](const ReportMeasure& m) { return (m.*which).has_value(); });
  };
  const bool has_after = has(&ReportMeasure::after);
  TableWriter table;
  table.header("measure");
  table.header(has_after ? "before" : "value", true);
  if (has_after) table.header("after", true);
  table.header("unit");
  for (const ReportMeasure& measure : measures) {
    table.row();
    table.name(measure.name);
    table.number(optional_text(measure.before));
    if (has_after) table.number(optional_text(measure.after));
    table.unit(measure.unit);
  }
  return table.html();
}

std::string stage_table(std::span<const ReportStage> stages) {
  TableWriter table;
  table.header("stage");
  table.header("state");
  table.header("wall time, s", true);
  for (const ReportStage& stage : stages) {
    table.row();
    table.name(stage.name);
    table.cell(stage.state);
    table.number(fmt::format("{:.2f}", stage.wall_s));
  }
  return table.html();
}

std::string check_table(std::span<const ReportCheck> checks) {
  TableWriter table;
  table.header("check");
  table.header("found", true);
  table.header("limit", true);
  table.header("unit");
  table.header("result");
  for (const ReportCheck& check : checks) {
    table.row();
    table.name(check.name);
    if (check.relation.empty()) {  // a plain yes or no
      table.number("");
      table.number("");
    } else {
      table.number(number_text(check.value));
      table.number(sign_of(check.relation) + number_text(check.limit));
    }
    table.unit(check.unit);
    table.raw(check.passed ? "<span class=\"good\">✓ passed</span>" : "<span class=\"bad\">✗ failed</span>");
  }
  return table.html();
}

std::string value_table(std::span<const ReportValue> values) {
  TableWriter table;
  for (const ReportValue& value : values) {
    table.row();
    table.name(value.name);
    table.code(value.value);
    table.unit(value.unit);
  }
  return table.html();
}

std::string file_table(std::span<const ReportFile> files) {
  TableWriter table;
  table.header("file");
  table.header("what it holds");
  for (const ReportFile& file : files) {
    table.row();
    table.raw(fmt::format("<a href=\"{0}\"><code>{0}</code></a>", escaped(file.path)));
    table.cell(file.meaning);
  }
  return table.html();
}

std::string free_table(const ReportTable& content) {
  if (content.rows.empty()) return "";
  TableWriter table;
  for (std::size_t k = 0; k < content.columns.size(); ++k) {
    table.header(content.columns[k], reads_as_number(content.rows.front()[k]));
  }
  for (const auto& row : content.rows) {
    table.row();
    for (const std::string& cell : row) {
      if (reads_as_number(cell)) {
        table.number(cell);
      } else {
        table.cell(cell);
      }
    }
  }
  return "<h3>" + escaped(content.title) + "</h3>\n" + table.html();
}

}  // namespace incise
