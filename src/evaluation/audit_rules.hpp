#pragma once

#include <incise/evaluation/published_table.hpp>

#include <algorithm>

namespace incise::audit_rules {

/// Allowance for the rounding of our arithmetic: a printed number exactly at its bound is possible.
inline constexpr double kSlack = 1e-9;

[[nodiscard]] inline double low(const PrintedNumber& number) {
  return number.value - number.half_unit;
}
[[nodiscard]] inline double high(const PrintedNumber& number) {
  return number.value + number.half_unit;
}

/// Returns the number of values: as printed, otherwise AuditSettings::n_at_least; at least 2.
[[nodiscard]] inline std::size_t count_of(const PrintedGroup& group, const AuditSettings& settings) {
  return std::max<std::size_t>(2, group.n.value_or(settings.n_at_least));
}

/// Returns the greatest product (top - m)(m - bottom) for m in [from, to].
[[nodiscard]] inline double greatest_product(double bottom, double top, double from, double to) {
  const double m = std::clamp(0.5 * (top + bottom), from, to);
  return std::max(0.0, (top - m) * (m - bottom));
}

/// Checks all rules about one set of numbers. @param max  of the set, or of a set that contains it.
void check_group(const PrintedGroup& group, const std::optional<PrintedNumber>& max, const AuditSettings& settings,
                 std::vector<Finding>& findings);

/// Lists the rules about one set of numbers that need a number which the table does not print.
void note_unchecked(const PrintedGroup& group, const std::optional<PrintedNumber>& max, const AuditSettings& settings,
                    AuditedRow& row);

/// Checks whether `total` can have been pooled from `parts`. Does nothing for fewer than 2 parts.
void check_pooling(const PrintedGroup& total, const std::vector<PrintedGroup>& parts, const AuditSettings& settings,
                   AuditedRow& row);

/// Returns a row's mean, max and per cent, if it has all three and the per cent is above its rounding.
[[nodiscard]] std::optional<PrintedScore> printed_score(const PrintedRow& row);

/// Checks whether a row's per cent follows from its mean, its max and the baseline.
void check_score(const PrintedRow& row, const BaselineRange& baseline_mm, std::vector<Finding>& findings);

}  // namespace incise::audit_rules
