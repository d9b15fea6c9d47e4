#include "described_options.hpp"
#include "option_checks.hpp"
#include "options.hpp"

#include <incise/core/described_json.hpp>
#include <incise/core/expect.hpp>
#include <incise/io/json_file.hpp>
#include <incise/storage/published_table_file.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <set>

namespace incise::cli {
namespace {

using Json = nlohmann::ordered_json;

struct AuditArguments {
  std::filesystem::path table;
  AuditSettings settings;
  double grain = 0.0;
};

Json audit_json(const Audit& audit, const PublishedTable& table) {
  Json json = to_json(audit);
  json["columns"] = {{"read", table.number_columns}, {"names", table.name_columns}};
  std::map<std::string, std::size_t> rules;
  for (const AuditedRow& row : audit.rows) {
    for (const Finding& finding : row.findings) ++rules[std::string(to_string(finding.rule))];
  }
  json["findings_by_rule"] = rules;
  return json;
}

void print_audit(const Audit& audit, const PublishedTable& table) {
  // A rule whose column was not recognised finds nothing, which does not mean that there is nothing to find.
  fmt::print("columns read: {}\n", fmt::join(table.number_columns, ", "));
  if (!table.name_columns.empty())
    fmt::print("columns of names, not numbers: {}\n", fmt::join(table.name_columns, ", "));
  for (const AuditedRow& row : audit.rows) {
    for (const Finding& finding : row.findings) fmt::print("{:<32} {}\n", row.name, to_text(finding));
  }
  std::map<std::string, std::size_t> unchecked;
  for (const AuditedRow& row : audit.rows) {
    std::set<std::string> rules;
    for (const Unchecked& rule : row.not_checkable)
      rules.insert(fmt::format("{} (needs {})", to_string(rule.rule), rule.needs));
    for (const std::string& rule : rules) ++unchecked[rule];
  }
  for (const auto& [rule, count] : unchecked)
    fmt::print("not checkable in {} of {} rows: {}\n", count, audit.rows.size(), rule);
  fmt::print("{} of {} rows impossible\n", audit.impossible_rows, audit.rows.size());
  if (audit.baseline_mm) {
    fmt::print("score baseline {:.3f} to {:.3f} mm explains {} of {} rows\n", audit.baseline_mm->low_mm,
               audit.baseline_mm->high_mm, audit.rows_on_baseline, audit.scored_rows);
  }
}

int run_audit(const AuditArguments& given, const CommonOptions& options) {
  AuditArguments arguments = given;
  if (arguments.grain > 0.0) arguments.settings.grain = arguments.grain;
  require_valid(problems_of(arguments.settings));
  refuse_input_as_output("-o", options.output, {arguments.table});
  const PublishedTable table = read_published_table(arguments.table);
  const Audit result = audit(table.rows, arguments.settings);
  const Json json = audit_json(result, table);
  if (!options.output.empty()) write_json(options.output, json);
  options.json ? print_result(options, json) : print_audit(result, table);
  return result.impossible_rows == 0 ? kDone : kNotAcceptable;
}

}  // namespace

void add_audit(Application& application) {
  auto [verb, a] = application.add_verb<AuditArguments>(
      "audit", "Find the rows of a published table that no data can produce; exit status 4 if there are any",
      "incise audit data/published_tables/table_1.csv", run_audit);
  describe_output(*verb, kNothingByDefault);
  verb->add_option("table", a.table,
                   "Table with the digits as printed (.csv): mean_mm, sd_mm; optional max_mm, min_mm, n, "
                   "score_percent, and PART_mean_mm, PART_sd_mm, PART_n of each part that a row pools")
      ->required();
  add_options_of(*verb, a.settings, "least", "n_at_least");
  verb->add_option("--grain", a.grain, "Values are whole multiples of this (1 for counts); 0: any number")
      ->check(zero_or_more("--grain"));
}

}  // namespace incise::cli
