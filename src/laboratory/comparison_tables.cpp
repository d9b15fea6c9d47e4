#include <incise/laboratory/comparison_tables.hpp>

#include <fmt/format.h>

namespace incise::laboratory {
namespace {

using Json = nlohmann::ordered_json;

std::string number(const Json& value, int places) {
  return value.is_number() ? fmt::format("{:.{}f}", value.get<double>(), places) : "-";
}

std::string number_at(const Json& object, const char* key, int places) {
  const auto found = object.find(key);
  return found == object.end() ? "-" : number(*found, places);
}

/// Small p-values keep their size.
std::string p_text(const Json& p) {
  if (!p.is_number()) return "-";
  const double value = p.get<double>();
  return value < 1e-4 ? fmt::format("{:.1e}", value) : fmt::format("{:.4f}", value);
}

std::string interval_text(const Json& interval) {
  return interval.is_array() ? number(interval[0], 3) + " to " + number(interval[1], 3) : "-";
}

void add_test(TextTable& table, const Json& test, const std::string& name) {
  if (!test.is_object()) return;
  table.rows.push_back({name, test.contains("t") ? number(test["t"], 3) : "-",
                        test.contains("df") ? number(test["df"], 2) : "-", p_text(test["p"]),
                        number(test["difference_mm"], 3), interval_text(test["confidence_mm"]),
                        test["verdict"].get<std::string>()});
}

}  // namespace

TextTable result_table(const Json& comparison) {
  TextTable table;
  table.header = {"side",
                  "specimen",
                  "outcome",
                  "points",
                  "mean ± sd mm",
                  "Hu score",
                  "Hu score of the ideal",
                  "centroid shift mm"};
  for (const Json& row : comparison["rows"]) {
    const std::string spread = number_at(row, "sd_mm", 2);
    table.rows.push_back({row["side"], row["name"], row["outcome"], row["n_points"].dump(),
                          spread == "-" ? "-" : number_at(row, "mean_mm", 2) + " ± " + spread,
                          number_at(row, "hu_score", 3), number_at(row, "hu_score_ideal", 3),
                          number_at(row, "centroid_shift_mm", 2)});
  }
  return table;
}

TextTable test_table(const Json& comparison) {
  TextTable table;
  table.header = {"test", "t", "df", "p", "difference mm", "confidence interval mm", "verdict"};
  if (const Json& points = comparison["points"]; points.is_object()) {
    add_test(table, points, "Student, pooled by point");
    add_test(table, points["welch"], "Welch, pooled by point");
    add_test(table, points["block_bootstrap"], "block bootstrap along the contours");
  }
  if (const Json& specimens = comparison["specimens"]; specimens.is_object()) {
    add_test(table, specimens["student"], "Student, by specimen");
    add_test(table, specimens["welch"], "Welch, by specimen");
    add_test(table, specimens["paired"], "paired, by specimen");
  }
  return table;
}

}  // namespace incise::laboratory
