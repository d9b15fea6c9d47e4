#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/names.hpp>
#include <incise/evaluation/registration_score.hpp>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// Reads a number as printed ("1.20": 1.2 ± 0.005). Absent for text that is not a finite decimal number.
[[nodiscard]] std::optional<PrintedNumber> printed_number(std::string_view text);

/// The statistics that a table prints of one set of numbers.
struct PrintedGroup {
  std::string name;  ///< of the group of columns; empty for the row's own columns
  PrintedNumber mean;
  /// Taken as the sample standard deviation (n - 1). Absent if not printed; then taken as 0 if n is 1.
  std::optional<PrintedNumber> sd;
  std::optional<PrintedNumber> max;
  std::optional<PrintedNumber> min;
  std::optional<std::size_t> n;
};

/// A row of a table: one set of numbers, and possibly the sets that it was pooled from.
struct PrintedRow {
  std::string name;
  std::optional<PrintedGroup> total;
  std::vector<PrintedGroup> parts;             ///< the total's max also bounds a part without max
  std::optional<PrintedNumber> score_percent;  ///< 0.75 mean + 0.25 max of the total, in per cent of a baseline
};

struct AuditSettings {
  double least = 0.0;
  std::size_t n_at_least = 10;
  std::optional<double> grain;
};
inline void describe(Visitor& v, AuditSettings& s) {
  v("least", s.least, "Least possible value: 0 for absolute errors.");
  v("n_at_least", s.n_at_least,
    "Fewest values that a row may have if the table gives no n. Fewer values may spread more, so a lower number finds "
    "fewer rows impossible.",
    {2.0, 1e9});
  v("grain", s.grain, "Values are whole multiples of this (1 for counts): the GRIM test; needs n.", kPositive);
}

/// Conditions that no set of numbers can meet, whatever the digits behind the printed ones.
enum class AuditRule {
  MeanBelowLeast,  ///< mean < least possible value
  NegativeSd,
  MaxBelowMean,
  MinAboveMean,
  SdTooLarge,         ///< sd² > n/(n−1) (max − mean)(mean − min): [BhatiaDavis2000]
  SdTooSmall,         ///< sd² < n/(n−1)² (max − mean)²: the greatest value alone causes more spread; needs n
  MeanTooSmall,       ///< n · mean < max + (n − 1) · least: the greatest value alone causes a greater mean; needs n
  MeanNotOnGrain,     ///< no sum of n multiples of the grain has this mean: [BrownHeathers2017]; needs n and grain
  PooledMeanOutside,  ///< below the mean of every part, or above it
  PooledMeanOff,      ///< not Σ n_i mean_i / Σ n_i; needs n of every part
  PooledNOff,         ///< n of the row is not the sum of the parts' n; needs n of the row and of its parts
  PooledSdTooLarge,  ///< (N−1) sd² > Σ (n_i−1) sd_i² + Σ n_i (mean_i − mean)²; without n: for any shares with that mean
  PooledSdTooSmall,  ///< (N−1) sd² < the same
  ScoreOffBaseline,  ///< the per cent does not follow from mean, max and the baseline of most rows
};
inline constexpr std::array<std::string_view, 14> kAuditRuleNames{
    "mean_below_least", "negative_sd",         "max_below_mean",      "min_above_mean",      "sd_too_large",
    "sd_too_small",     "mean_too_small",      "mean_not_on_grain",   "pooled_mean_outside", "pooled_mean_off",
    "pooled_n_off",     "pooled_sd_too_large", "pooled_sd_too_small", "score_off_baseline"};
[[nodiscard]] constexpr Names names_of(AuditRule) {
  return kAuditRuleNames;
}

/// Describes the group of a finding; absent for the row's own columns.
inline void describe_group(Visitor& v, std::string& group) {
  std::optional<std::string> named;
  if (!group.empty()) named = group;
  v("of", named, "Group of columns with these numbers; absent: the row's own columns.");
  if (v.sets()) group = named.value_or("");
}

/// A number that no data can produce.
struct Finding {
  AuditRule rule = AuditRule::SdTooLarge;
  std::string group;     ///< name of the group; empty for the row's own columns
  double printed = 0.0;  ///< the impossible number
  double bound = 0.0;    ///< the nearest possible value, with allowance for rounding
};

/// Returns one sentence for a person: rule, number, bound.
[[nodiscard]] std::string to_text(const Finding& finding);
inline void describe(Visitor& v, Finding& f) {
  v("rule", f.rule, "Rule that is broken.");
  describe_group(v, f.group);
  v("printed", f.printed, "The impossible number.");
  v("bound", f.bound, "Nearest possible value.");
  v.derived("text", to_text(f), "The finding as a sentence.");
}

/// A rule that could not be checked, because the table does not print a number that it needs.
struct Unchecked {
  AuditRule rule = AuditRule::SdTooLarge;
  std::string group;  ///< as in Finding
  std::string needs;  ///< the missing number
};

inline void describe(Visitor& v, Unchecked& u) {
  v("rule", u.rule, "Rule that could not be checked.");
  describe_group(v, u.group);
  v("needs", u.needs, "Number that the table does not print.");
}

struct AuditedRow {
  std::string name;
  std::vector<Finding> findings;         ///< empty if nothing impossible was found
  std::vector<Unchecked> not_checkable;  ///< rules that could not be checked
};

inline void describe(Visitor& v, AuditedRow& r) {
  v("name", r.name, "Name of the row.");
  v.derived("possible", r.findings.empty(), "Whether nothing impossible was found.");
  v("findings", r.findings, "Numbers that no data can produce.");
  v("not_checkable", r.not_checkable, "Rules that could not be checked.");
}

struct Audit {
  std::vector<AuditedRow> rows;  ///< in the order of the table
  std::size_t impossible_rows = 0;
  /// Baselines that explain the per cents of most rows. Absent if no row has one, or if no baseline explains more than
  /// half of several rows.
  std::optional<BaselineRange> baseline_mm;
  std::size_t rows_on_baseline = 0;  ///< rows whose per cent these baselines explain
  std::size_t scored_rows = 0;       ///< rows with a mean, a max and a per cent above its rounding
};

/// Returns how often each rule is broken, by its name.
[[nodiscard]] std::map<std::string, std::size_t> findings_by_rule(const Audit& audit);
/// Returns an audit as lines for a person: findings, rules that could not be checked, number of impossible rows,
/// baseline.
[[nodiscard]] std::string to_text(const Audit& audit);

inline void describe(Visitor& v, Audit& a) {
  v("impossible_rows", a.impossible_rows, "Number of rows that no data can produce.");
  v.derived("checked_rows", a.rows.size(), "Number of rows that were checked.");
  v("rows", a.rows, "Rows in the order of the table.");
  const Field baseline{"score_baseline_mm",
                       "Baselines that explain the per cents of most rows; absent: no row has one."};
  if (!v.optional(baseline, a.baseline_mm.has_value())) return;
  BaselineRange range = a.baseline_mm.value_or(BaselineRange{});
  v.begin(baseline);
  v({"low", "Least of these baselines.", "mm"}, range.low_mm);
  v({"high", "Greatest of these baselines.", "mm"}, range.high_mm);
  v("rows", a.rows_on_baseline, "Number of rows that they explain.");
  v("of", a.scored_rows, "Number of rows with a per cent above 0, a mean and a max.");
  v.end();
  if (v.sets()) a.baseline_mm = range;
}

/// Finds the rows of a published table that no data can produce. A row that passes is possible, not necessarily right.
/// @throws InvalidArgument with every violation of the settings; for a number that is not finite.
[[nodiscard]] Audit audit(const std::vector<PrintedRow>& rows, const AuditSettings& settings = {});

}  // namespace incise
