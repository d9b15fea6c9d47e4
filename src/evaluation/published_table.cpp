#include "evaluation/audit_rules.hpp"

#include <incise/core/expect.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

namespace incise {
namespace {

/// Finds the baseline that most rows agree on. The candidates are the lower ends of the rows' ranges.
void find_baseline(const std::vector<PrintedRow>& rows, Audit& audit) {
  std::vector<BaselineRange> ranges;
  for (const PrintedRow& row : rows) {
    if (const auto score = audit_rules::printed_score(row)) ranges.push_back(baseline_range(*score));
  }
  audit.scored_rows = ranges.size();
  for (const BaselineRange& candidate : ranges) {
    BaselineRange common = candidate;
    std::size_t count = 0;
    for (const BaselineRange& range : ranges) {
      if (range.low_mm > candidate.low_mm || range.high_mm < candidate.low_mm) continue;
      ++count;
      common.high_mm = std::min(common.high_mm, range.high_mm);
    }
    if (count <= audit.rows_on_baseline) continue;
    audit.rows_on_baseline = count;
    audit.baseline_mm = common;
  }
  if (audit.scored_rows > 1 &&
      2 * audit.rows_on_baseline <= audit.scored_rows) {  // unknown which rows are wrong
    audit.baseline_mm.reset();
    audit.rows_on_baseline = 0;
  }
}

}  // namespace

std::optional<PrintedNumber> printed_number(std::string_view text) {
  // A sign and digits with at most one point: tables do not print a length as "1e3" or "inf".
  const bool is_plain = !text.empty() && text.find_first_not_of("+-.0123456789") == std::string_view::npos;
  if (!is_plain) return std::nullopt;
  std::string_view digits = text;
  if (digits.front() == '+') digits.remove_prefix(1);
  PrintedNumber number;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number.value);
  if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(number.value)) return std::nullopt;
  const std::size_t point = text.find('.');
  const std::size_t places = point == std::string_view::npos ? 0 : text.size() - point - 1;
  number.half_unit = 0.5 * std::pow(10.0, -static_cast<double>(places));
  return number;
}

std::string to_text(const Finding& finding) {
  constexpr std::array<const char*, kAuditRuleNames.size()> kPatterns{
      "mean {found:g} lies below the least possible value, {bound:g}",
      "sd {found:g} is negative",
      "max {found:g} lies below the mean, which is at least {bound:.4g}",
      "min {found:g} lies above the mean, which is at most {bound:.4g}",
      "sd {found:g} is more than mean and max allow, {bound:.4g}",
      "sd {found:g} is less than the greatest value alone causes, {bound:.4g}",
      "mean {found:g} is less than the greatest value alone causes, {bound:.4g}",
      "mean {found:g} cannot be the mean of n such values; the nearest possible: {bound:.6g}",
      "pooled mean {found:g} lies outside the means of its parts; the nearest reaches {bound:.4g}",
      "pooled mean {found:g} is not the mean of its parts weighted by n; the nearest is {bound:.4g}",
      "pooled n {found:g} is not the sum of its parts, {bound:g}",
      "pooled sd {found:g} is more than its parts allow, {bound:.4g}",
      "pooled sd {found:g} is less than its parts allow, {bound:.4g}",
      "score {found:g} % does not follow from mean, max and the baseline; the nearest is {bound:.4g} %"};
  static_assert(kPatterns.back() != nullptr, "a sentence for each rule");
  return (finding.group.empty() ? "" : finding.group + ": ") +
         fmt::format(fmt::runtime(kPatterns.at(static_cast<std::size_t>(finding.rule))),
                     fmt::arg("found", finding.printed), fmt::arg("bound", finding.bound));
}

std::map<std::string, std::size_t> findings_by_rule(const Audit& audit) {
  std::map<std::string, std::size_t> rules;
  for (const AuditedRow& row : audit.rows) {
    for (const Finding& finding : row.findings) ++rules[std::string(to_string(finding.rule))];
  }
  return rules;
}

std::string to_text(const Audit& audit) {
  std::string text;
  std::map<std::string, std::size_t> unchecked;  // rows in which a rule could not be checked
  for (const AuditedRow& row : audit.rows) {
    for (const Finding& finding : row.findings) text += fmt::format("{:<32} {}\n", row.name, to_text(finding));
    std::set<std::string> rules;
    for (const Unchecked& rule : row.not_checkable)
      rules.insert(fmt::format("{} (needs {})", to_string(rule.rule), rule.needs));
    for (const std::string& rule : rules) ++unchecked[rule];
  }
  for (const auto& [rule, count] : unchecked)
    text += fmt::format("not checkable in {} of {} rows: {}\n", count, audit.rows.size(), rule);
  text += fmt::format("{} of {} rows impossible\n", audit.impossible_rows, audit.rows.size());
  if (audit.baseline_mm) {
    text += fmt::format("score baseline {:.3f} to {:.3f} mm explains {} of {} rows\n", audit.baseline_mm->low_mm,
                        audit.baseline_mm->high_mm, audit.rows_on_baseline, audit.scored_rows);
  }
  return text;
}

Audit audit(const std::vector<PrintedRow>& rows, const AuditSettings& settings) {
  require_none(problems_of(settings));
  Audit result;
  find_baseline(rows, result);
  for (const PrintedRow& row : rows) {
    AuditedRow audited{.name = row.name, .findings = {}, .not_checkable = {}};
    if (row.total) {
      audit_rules::check_group(*row.total, row.total->max, settings, audited.findings);
      audit_rules::note_unchecked(*row.total, row.total->max, settings, audited);
    }
    for (const PrintedGroup& part : row.parts) {
      const auto max = part.max || !row.total ? part.max : row.total->max;
      audit_rules::check_group(part, max, settings, audited.findings);
      audit_rules::note_unchecked(part, max, settings, audited);
    }
    if (row.total) audit_rules::check_pooling(*row.total, row.parts, settings, audited);
    if (result.baseline_mm) audit_rules::check_score(row, *result.baseline_mm, audited.findings);
    if (!audited.findings.empty()) ++result.impossible_rows;
    result.rows.push_back(std::move(audited));
  }
  return result;
}

}  // namespace incise
