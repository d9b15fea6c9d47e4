#pragma once

#include <incise/evaluation/published_table.hpp>

#include <algorithm>

namespace incise::audit_rules {

/// Rounding of our own arithmetic: a printed number that meets its bound exactly is possible.
inline constexpr double kSlack = 1e-9;

[[nodiscard]] inline double low(const PrintedNumber& number) {
  return number.value - number.half_unit;
}
[[nodiscard]] inline double high(const PrintedNumber& number) {
  return number.value + number.half_unit;
}

/// As printed, else the fewest that there may be.
[[nodiscard]] inline std::size_t count_of(const PrintedGroup& group, const AuditSettings& settings) {
  return std::max<std::size_t>(2, group.n.value_or(settings.n_at_least));
}

/// Greatest product (top - m)(m - bottom) for m in [from, to].
[[nodiscard]] inline double greatest_product(double bottom, double top, double from, double to) {
  const double m = std::clamp(0.5 * (top + bottom), from, to);
  return std::max(0.0, (top - m) * (m - bottom));
}

/// All rules about one set of numbers. @param max  of the set, or of a set that holds it.
void check_group(const PrintedGroup& group, const std::optional<PrintedNumber>& max, const AuditSettings& settings,
                 std::vector<Finding>& findings);

/// Lists the rules about one set of numbers that lack a number which the table does not print.
void note_unchecked(const PrintedGroup& group, const std::optional<PrintedNumber>& max, const AuditSettings& settings,
                    AuditedRow& row);

/// Whether `total` can have been pooled from `parts`; at least 2 of them, otherwise nothing is said.
void check_pooling(const PrintedGroup& total, const std::vector<PrintedGroup>& parts, const AuditSettings& settings,
                   AuditedRow& row);

/// A row's mean, max and per cent, if it has all three and did not fail.
[[nodiscard]] std::optional<PrintedScore> printed_score(const PrintedRow& row);

void check_score(const PrintedRow& row, const BaselineRange& baseline_mm, std::vector<Finding>& findings);

}  // namespace incise::audit_rules
