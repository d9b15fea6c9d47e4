#include "described_options.hpp"
#include "option_checks.hpp"
#include "options.hpp"

#include <incise/core/described_json.hpp>
#include <incise/core/expect.hpp>
#include <incise/io/json_file.hpp>
#include <incise/storage/published_table_file.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

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
  json["findings_by_rule"] = findings_by_rule(audit);
  return json;
}

void print_audit(const Audit& audit, const PublishedTable& table) {
  // A rule whose column was not recognised finds nothing, which does not mean that there is nothing to find.
  fmt::print("columns read: {}\n", fmt::join(table.number_columns, ", "));
  if (!table.name_columns.empty())
    fmt::print("columns of names, not numbers: {}\n", fmt::join(table.name_columns, ", "));
  fmt::print("{}", to_text(audit));
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
