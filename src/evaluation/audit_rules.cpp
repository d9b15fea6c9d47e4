#include "evaluation/audit_rules.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise::audit_rules {
namespace {

void require_finite(const PrintedNumber& number, const std::string& name) {
  INCISE_REQUIRE(std::isfinite(number.value) && number.half_unit >= 0.0,
                 fmt::format("a number of \"{}\" is not finite", name));
}

/// Greatest possible sd [BhatiaDavis2000], for the sample variance.
double greatest_sd(const PrintedGroup& group, double bottom, double top, const AuditSettings& settings) {
  if (group.n == 1U) return 0.0;  // one value has no spread
  const auto n = static_cast<double>(count_of(group, settings));
  return std::sqrt(n / (n - 1.0) * greatest_product(bottom, top, low(group.mean), high(group.mean)));
}

/// Checks the rules that need the number of values.
void check_counted(const PrintedGroup& group, const AuditSettings& settings, std::vector<Finding>& findings) {
  const auto n = static_cast<double>(*group.n);
  if (settings.grain) {
    const double step = *settings.grain / n;
    const double nearest = std::round(group.mean.value / step) * step;
    if (std::abs(nearest - group.mean.value) > group.mean.half_unit + kSlack) {
      findings.push_back({AuditRule::MeanNotOnGrain, group.name, group.mean.value, nearest});
    }
  }
  if (!group.max) return;
  const double least_mean = (low(*group.max) + (n - 1.0) * settings.least) / n;
  if (high(group.mean) < least_mean - kSlack) {
    findings.push_back({AuditRule::MeanTooSmall, group.name, group.mean.value, least_mean});
  }
  if (*group.n < 2 || !group.sd) return;
  const double reach = std::max(0.0, low(*group.max) - high(group.mean));
  const double least_sd = reach * std::sqrt(n) / (n - 1.0);
  if (high(*group.sd) < least_sd - kSlack) {
    findings.push_back({AuditRule::SdTooSmall, group.name, group.sd->value, least_sd});
  }
}

}  // namespace

void check_group(const PrintedGroup& group, const std::optional<PrintedNumber>& max, const AuditSettings& settings,
                 std::vector<Finding>& findings) {
  for (const auto& number : {std::optional(group.mean), group.sd, max, group.min}) {
    if (number) require_finite(*number, group.name);
  }
  const auto find = [&](AuditRule rule, double printed, double bound) {
    findings.push_back({rule, group.name, printed, bound});
  };
  const std::size_t before = findings.size();
  if (high(group.mean) < settings.least - kSlack) find(AuditRule::MeanBelowLeast, group.mean.value, settings.least);
  if (group.sd && high(*group.sd) < -kSlack) find(AuditRule::NegativeSd, group.sd->value, 0.0);
  if (max && high(*max) < low(group.mean) - kSlack) find(AuditRule::MaxBelowMean, max->value, low(group.mean));
  if (group.min && low(*group.min) > high(group.mean) + kSlack) {
    find(AuditRule::MinAboveMean, group.min->value, high(group.mean));
  }
  // Bounds on the spread have no meaning if the mean itself is impossible.
  if (findings.size() > before) return;
  if (max && group.sd) {
    const double bottom = group.min ? std::max(settings.least, low(*group.min)) : settings.least;
    const double bound = greatest_sd(group, bottom, high(*max), settings);
    if (low(*group.sd) > bound + kSlack) find(AuditRule::SdTooLarge, group.sd->value, bound);
  }
  if (group.n) check_counted(group, settings, findings);
}

void note_unchecked(const PrintedGroup& group, const std::optional<PrintedNumber>& max, const AuditSettings& settings,
                    AuditedRow& row) {
  const auto note = [&](AuditRule rule, const char* needs) { row.not_checkable.push_back({rule, group.name, needs}); };
  // The sd of one value is 0 by definition: if it is not printed, there is nothing to check.
  const bool has_sd_to_check = group.sd || group.n != 1U;
  if (has_sd_to_check && (!max || !group.sd)) note(AuditRule::SdTooLarge, group.sd ? "max" : "sd");
  const bool is_bare = !group.n || !group.max;
  const char* needs = group.max ? "n" : group.n ? "its own max" : "n and its own max";
  if (has_sd_to_check && (is_bare || !group.sd)) note(AuditRule::SdTooSmall, group.sd ? needs : "sd");
  if (is_bare) note(AuditRule::MeanTooSmall, needs);
  if (settings.grain && !group.n) note(AuditRule::MeanNotOnGrain, "n");
}

std::optional<PrintedScore> printed_score(const PrintedRow& row) {
  if (!row.total || !row.total->max || !row.score_percent) return std::nullopt;
  if (row.score_percent->value <= row.score_percent->half_unit) return std::nullopt;
  return PrintedScore{row.total->mean, *row.total->max, *row.score_percent};
}

void check_score(const PrintedRow& row, const BaselineRange& baseline_mm, std::vector<Finding>& findings) {
  const auto score = printed_score(row);
  if (!score) return;
  const BaselineRange own = baseline_range(*score);
  if (own.low_mm <= baseline_mm.high_mm && own.high_mm >= baseline_mm.low_mm) return;
  // The per cent nearest to the printed one that follows from mean, max and the baseline.
  const bool is_high = own.low_mm > baseline_mm.high_mm;
  const double baseline = is_high ? baseline_mm.high_mm : baseline_mm.low_mm;
  const double edge = is_high ? own.low_mm * (score->percent.value + score->percent.half_unit)
                              : own.high_mm * (score->percent.value - score->percent.half_unit);
  findings.push_back({AuditRule::ScoreOffBaseline, row.total->name, score->percent.value, edge / baseline});
}

}  // namespace incise::audit_rules
