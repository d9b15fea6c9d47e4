#pragma once

#include <incise/evaluation/published_table.hpp>

namespace incise::audit_rules {

/// All rules about one set of numbers. @param max  of the set, or of a set that holds it.
void check_group(const PrintedGroup& group, const std::optional<PrintedNumber>& max, const AuditSettings& settings,
                 std::vector<Finding>& findings);

/// Whether `total` can have been pooled from `parts`; at least 2 of them, otherwise nothing is said.
void check_pooling(const PrintedGroup& total, const std::vector<PrintedGroup>& parts, const AuditSettings& settings,
                   std::vector<Finding>& findings);

/// A row's mean, max and per cent, if it has all three and did not fail.
[[nodiscard]] std::optional<PrintedScore> printed_score(const PrintedRow& row);

void check_score(const PrintedRow& row, const BaselineRange& baseline_mm, std::vector<Finding>& findings);

}  // namespace incise::audit_rules
