#include "evaluation/audit_rules.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise::audit_rules {
namespace {

struct Range {
  double low = 0.0;
  double high = 0.0;
  void include(const Range& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }
};

Range mean_of(const PrintedGroup& group) {
  return {low(group.mean), high(group.mean)};
}
/// Range of sd²; 0 if no sd is printed, which is exact for one value and the least for more. @see is_spread_known
Range variance_of(const PrintedGroup& group) {
  if (!group.sd) return {0.0, 0.0};
  const double least = std::max(0.0, low(*group.sd));
  const double most = std::max(0.0, high(*group.sd));
  return {least * least, most * most};
}

/// Number of values of each part, as far as the table determines it.
struct Counts {
  std::vector<std::size_t> parts;  ///< empty if not known
  std::optional<std::size_t> total;
  bool is_contradiction = false;
};

/// Reads the counts; a single missing count follows from the others.
Counts counts_of(const PrintedGroup& total, const std::vector<PrintedGroup>& parts, std::vector<Finding>& findings) {
  Counts counts{.parts = {}, .total = total.n};
  std::size_t sum = 0, missing = 0;
  for (const PrintedGroup& part : parts) {
    sum += part.n.value_or(0);
    missing += part.n ? 0 : 1;
    counts.parts.push_back(part.n.value_or(0));
  }
  // A part without a printed count has at least one value.
  const bool is_short = total.n && *total.n < sum + missing;
  if (is_short || (total.n && missing == 0 && *total.n != sum)) {
    findings.push_back(
        {AuditRule::PooledNOff, total.name, static_cast<double>(*total.n), static_cast<double>(sum + missing)});
    return {.parts = {}, .total = std::nullopt, .is_contradiction = true};
  }
  if (missing == 0) {
    counts.total = sum;
  } else if (missing == 1 && total.n) {
    *std::find(counts.parts.begin(), counts.parts.end(), 0U) = *total.n - sum;
  } else {
    counts.parts.clear();
  }
  return counts;
}

/// Whether the spread within every part is known: its sd is printed, or it has a single value, without spread.
bool is_spread_known(const std::vector<PrintedGroup>& parts, const Counts& counts) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const bool is_one = parts[i].n == 1U || (!counts.parts.empty() && counts.parts[i] == 1);
    if (!parts[i].sd && !is_one) return false;
  }
  return true;
}

/// The fewest values that a part may have; 1 for a part without n and sd.
std::size_t fewest_of(const PrintedGroup& part, const AuditSettings& settings) {
  if (part.n) return *part.n;
  return part.sd ? count_of(part, settings) : 1;
}

/// Range of the mean of the pooled values. @pre counts of all parts
Range pooled_mean(const std::vector<PrintedGroup>& parts, const Counts& counts) {
  Range sum;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto n = static_cast<double>(counts.parts[i]);
    sum.low += n * low(parts[i].mean);
    sum.high += n * high(parts[i].mean);
  }
  const auto n = static_cast<double>(*counts.total);
  return {sum.low / n, sum.high / n};
}

/// Least value of Σ n_i (m_i − c)² over c in `centers` and all means within their rounding. The sum is convex in c.
double least_between(const std::vector<PrintedGroup>& parts, const Counts& counts, Range centers) {
  const auto pull = [&](double c) {  // half the derivative
    double sum = 0.0;
    for (std::size_t i = 0; i < parts.size(); ++i)
      sum += static_cast<double>(counts.parts[i]) * (c - std::clamp(c, low(parts[i].mean), high(parts[i].mean)));
    return sum;
  };
  constexpr int kHalvings = 100;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (centers.low + centers.high);
    (pull(middle) > 0.0 ? centers.high : centers.low) = middle;
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double off = centers.low - std::clamp(centers.low, low(parts[i].mean), high(parts[i].mean));
    sum += static_cast<double>(counts.parts[i]) * off * off;
  }
  return sum;
}

/// Range of sd² in (N − 1) sd² = Σ (n_i − 1) sd_i² + Σ n_i (m_i − mean)². @pre counts of all parts, two values
Range pooled_variance(const std::vector<PrintedGroup>& parts, const Counts& counts) {
  const auto count = static_cast<double>(*counts.total);
  const Range mean = pooled_mean(parts, counts);
  const double center = 0.5 * (mean.low + mean.high);
  Range sum{least_between(parts, counts, mean), 0.0};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto n = static_cast<double>(counts.parts[i]);
    const Range variance = variance_of(parts[i]);
    // The sum about the mean is less than about any other point, so no mean within its rounding gives more than this.
    const double off = std::abs(parts[i].mean.value - center) + parts[i].mean.half_unit;
    sum.low += (n - 1.0) * variance.low;
    sum.high += (n - 1.0) * variance.high + n * off * off;
  }
  return {sum.low / (count - 1.0), sum.high / (count - 1.0)};
}

/// Mean square about the pooled mean of values from two parts, in shares that give this mean. Absent if no shares do.
std::optional<Range> spread_of_pair(const PrintedGroup& lower, const PrintedGroup& upper, const Range& total) {
  const Range a = mean_of(lower), b = mean_of(upper);
  const Range m{std::max(total.low, a.low), std::min(total.high, b.high)};
  if (m.low > m.high) return std::nullopt;
  // The share of the upper part, (m − a) / (b − a), grows with m and falls with a and b.
  const auto share = [](double mean, double from, double to) {
    return to > from ? std::clamp((mean - from) / (to - from), 0.0, 1.0) : 0.0;
  };
  const double least = share(m.low, std::min(a.high, m.low), b.high);
  const double most = b.low > m.high ? share(m.high, a.low, b.low) : 1.0;
  const Range va = variance_of(lower), vb = variance_of(upper);
  const auto within = [](double w, double first, double second) { return (1.0 - w) * first + w * second; };
  const auto between = [&](double mean) { return std::max(0.0, b.low - mean) * std::max(0.0, mean - a.high); };
  return Range{
      std::min(within(least, va.low, vb.low), within(most, va.low, vb.low)) + std::min(between(m.low), between(m.high)),
      std::max(within(least, va.high, vb.high), within(most, va.high, vb.high)) +
          greatest_product(a.low, b.high, m.low, m.high)};
}

/// Range of the pooled sd² without counts. The mean square about the pooled mean is linear in the parts' shares, which
/// give that mean and add up to 1. So it is least and greatest where at most two parts have a share.
Range variance_for_any_shares(const PrintedGroup& total, const std::vector<PrintedGroup>& parts, const Counts& counts,
                              const AuditSettings& settings) {
  const Range mean = mean_of(total);
  Range spread{std::numeric_limits<double>::infinity(), 0.0};
  Range parts_sum;
  std::size_t fewest = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Range variance = variance_of(parts[i]);
    parts_sum.low += variance.low;
    parts_sum.high += variance.high;
    fewest += fewest_of(parts[i], settings);
    if (low(parts[i].mean) <= mean.high && high(parts[i].mean) >= mean.low) spread.include(variance);
    for (std::size_t j = 0; j < parts.size(); ++j) {
      if (i == j) continue;
      if (const auto pair = spread_of_pair(parts[i], parts[j], mean)) spread.include(*pair);
    }
  }
  // (N − 1) sd² = N · spread − Σ sd_i²: monotonic in N, so the fewest and very many values bound it.
  const auto n = static_cast<double>(counts.total.value_or(fewest));
  Range result{(n * spread.low - parts_sum.high) / (n - 1.0), (n * spread.high - parts_sum.low) / (n - 1.0)};
  if (!counts.total) result.include(spread);
  return result;
}

}  // namespace

void check_pooling(const PrintedGroup& total, const std::vector<PrintedGroup>& parts, const AuditSettings& settings,
                   AuditedRow& row) {
  if (parts.size() < 2) return;
  const Counts counts = counts_of(total, parts, row.findings);
  const bool is_counted = !counts.parts.empty();
  if (!counts.is_contradiction && !(is_counted && total.n)) {
    row.not_checkable.push_back({AuditRule::PooledNOff, total.name, "n of the row and of its parts"});
  }
  Range span = mean_of(parts.front());
  for (const PrintedGroup& part : parts) span.include(mean_of(part));
  const Range mean = mean_of(total);
  if (mean.high < span.low - kSlack || mean.low > span.high + kSlack) {
    row.findings.push_back({AuditRule::PooledMeanOutside, total.name, total.mean.value,
                            total.mean.value < span.low ? span.low : span.high});
    return;
  }
  if (is_counted) {
    const Range weighted = pooled_mean(parts, counts);
    if (mean.high < weighted.low - kSlack || mean.low > weighted.high + kSlack) {
      row.findings.push_back({AuditRule::PooledMeanOff, total.name, total.mean.value,
                              total.mean.value < weighted.low ? weighted.low : weighted.high});
    }
  } else {
    row.not_checkable.push_back(
        {AuditRule::PooledMeanOff, total.name, counts.is_contradiction ? "counts that agree" : "n of every part"});
  }
  if (!total.sd) {
    row.not_checkable.push_back({AuditRule::PooledSdTooLarge, total.name, "sd of the row"});
    row.not_checkable.push_back({AuditRule::PooledSdTooSmall, total.name, "sd of the row"});
    return;
  }
  const Range variance =
      is_counted ? pooled_variance(parts, counts) : variance_for_any_shares(total, parts, counts, settings);
  const double most = std::sqrt(std::max(0.0, variance.high));
  const double fewest = std::sqrt(std::max(0.0, variance.low));
  // The sum grows with the sd of each part. If an sd is missing, the sum has a lower bound, but no upper one.
  if (!is_spread_known(parts, counts)) {
    row.not_checkable.push_back({AuditRule::PooledSdTooLarge, total.name, "sd of every part"});
  } else if (low(*total.sd) > most + kSlack) {
    row.findings.push_back({AuditRule::PooledSdTooLarge, total.name, total.sd->value, most});
  }
  if (high(*total.sd) < fewest - kSlack) {
    row.findings.push_back({AuditRule::PooledSdTooSmall, total.name, total.sd->value, fewest});
  }
}

}  // namespace incise::audit_rules
