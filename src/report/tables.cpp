#include "report/tables.hpp"

#include "report/svg.hpp"

#include <incise/io/text_encoding.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace incise {
namespace {

/// Builds one HTML table. Cells are escaped here. A long table can be folded, and a phone shows it folded at first.
class TableWriter {
 public:
  /// @param kind  class of the table; empty: on a phone each of its rows becomes a block.
  explicit TableWriter(std::string_view kind = "") : kind_(kind) {}
  void header(std::string_view name, bool is_number = false) {
    head_ += fmt::format("<th scope=\"col\"{}>{}</th>", is_number ? " class=\"number\"" : "", escaped(name));
    names_.emplace_back(name);
  }
  void row() {
    body_ += body_.empty() ? "<tr>" : "</tr>\n<tr>";
    column_ = 0;
    ++rows_;
  }
  void name(std::string_view text) {
    body_ += fmt::format("<th scope=\"row\">{}</th>", escaped(text));
    ++column_;
  }
  void cell(std::string_view text) { raw(escaped(text)); }
  void code(std::string_view text) { raw("<code>" + escaped(text) + "</code>"); }
  void unit(std::string_view text) { add(escaped(text), "unit"); }
  void number(std::string_view text) { add(escaped(text), "number"); }
  void raw(const std::string& html, bool is_number = false) { add(html, is_number ? "number" : ""); }
  [[nodiscard]] std::string html() const {
    if (body_.empty()) return "";
    const std::string head = head_.empty() ? "" : "<thead><tr>" + head_ + "</tr></thead>\n";
    const std::string table = fmt::format(
        "<div class=\"table\"><table class=\"{}\">\n{}<tbody>\n{}</tr>\n</tbody></table></div>\n", kind_, head, body_);
    constexpr int kLong = 8;
    if (rows_ <= kLong) return table;
    return fmt::format("<details class=\"fold\" open><summary>{} rows</summary>\n{}</details>\n", rows_, table);
  }

 private:
  /// A cell carries its column's name, which a phone shows beside it.
  void add(const std::string& html, std::string_view kind) {
    const std::string name = column_ < names_.size() ? fmt::format(" data-name=\"{}\"", escaped(names_[column_])) : "";
    body_ += fmt::format("<td{}{}>{}</td>", kind.empty() ? "" : fmt::format(" class=\"{}\"", kind), name, html);
    ++column_;
  }

  std::string kind_, head_, body_;
  std::vector<std::string> names_;
  std::size_t column_ = 0;
  int rows_ = 0;
};

std::string optional_text(const std::optional<double>& value, std::string_view unit) {
  return value ? measure_text(*value, unit) : "–";
}

bool reads_as_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

/// "ok", "refused", followed by the outcome of the cut if it was no success.
std::string judgement_of(const ReportIncision& incision) {
  const VerdictStatus status = incision.verdict.status();
  std::string words(to_string(status));
  if (incision.outcome != Outcome::Success) {
    std::string outcome(to_string(incision.outcome));
    std::replace(outcome.begin(), outcome.end(), '_', ' ');
    words += " (" + outcome + ")";
  }
  static constexpr std::array<const char*, 3> kTones{"good", "caution", "bad"};
  return fmt::format("<span class=\"{}\">{}</span>", kTones[static_cast<std::size_t>(status)], words);
}

/// The relation as a reader would write it.
std::string sign_of(const std::string& relation) {
  if (relation == ">=") return "≥ ";
  return relation == "<=" ? "≤ " : relation + " ";
}

}  // namespace

std::string with_capital(std::string text) {
  if (!text.empty() && text.front() >= 'a' && text.front() <= 'z')
    text.front() = static_cast<char>(text.front() - 'a' + 'A');
  return text;
}

std::string answer_table(std::span<const ReportIncision> incisions) {
  struct Row {
    const char* name;
    std::optional<double> ReportIncision::*number;
    const char* unknown;
  };
  static constexpr std::array<Row, 3> kRows{
      {{"Closest approach to the tumour", &ReportIncision::nearest_to_tumor_mm, "not measured"},
       {"Least depth", &ReportIncision::least_depth_mm, "nothing was cut"},
       {"Greatest error", &ReportIncision::greatest_error_mm, "not measured"}}};
  const bool lacks_correction = incisions.size() == 1;
  TableWriter table("plain");
  table.header("Simulated");
  for (const ReportIncision& incision : incisions) table.header(incision.name, true);
  if (lacks_correction) table.header("Corrected", true);
  table.row();
  table.name("Verdict of the cut");
  for (const ReportIncision& incision : incisions) table.raw(judgement_of(incision), true);
  if (lacks_correction) table.number("not cut");
  for (const Row& row : kRows) {
    table.row();
    table.name(row.name);
    for (const ReportIncision& incision : incisions) {
      const std::optional<double>& number = incision.*row.number;
      table.number(number ? fixed_text(*number, 2) + " mm" : row.unknown);
    }
    if (lacks_correction) table.number("not cut");
  }
  return table.html();
}

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
    table.number(optional_text(measure.before, measure.unit));
    if (has_after) table.number(optional_text(measure.after, measure.unit));
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
    table.number(measure_text(stage.wall_s, "s"));
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
      table.number(check.passed ? "yes" : "no");
      table.number("yes");
    } else {
      table.number(measure_text(check.value, check.unit));
      table.number(sign_of(check.relation) + measure_text(check.limit, check.unit));
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
  table.header("contents");
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
    for (const std::string& cell : row) table.raw(escaped(cell), reads_as_number(cell));
  }
  return "<h3>" + escaped(content.title) + "</h3>\n" + table.html();
}

}  // namespace incise
