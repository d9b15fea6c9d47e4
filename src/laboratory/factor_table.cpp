#include "laboratory/factor_table.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace incise::laboratory {
namespace {

using Responses = std::vector<std::optional<double>>;  // run by run
using Runs = std::vector<std::optional<ErrorByDirection>>;

/// Returns the mean, both components of the first wave, and the remainder in each direction: a linear map of the
/// errors.
std::vector<double> parts_of(const ErrorByDirection& errors) {
  const auto count = static_cast<double>(errors.size());
  const auto angle = [count](std::size_t i) { return 2.0 * std::numbers::pi * static_cast<double>(i) / count; };
  std::vector<double> parts(3 + errors.size(), 0.0);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    INCISE_REQUIRE(std::isfinite(errors[i]), "expected finite errors");
    parts[0] += errors[i] / count;
    parts[1] += 2.0 / count * errors[i] * std::cos(angle(i));
    parts[2] += 2.0 / count * errors[i] * std::sin(angle(i));
  }
  for (std::size_t i = 0; i < errors.size(); ++i)
    parts[3 + i] = errors[i] - parts[0] - parts[1] * std::cos(angle(i)) - parts[2] * std::sin(angle(i));
  return parts;
}

/// Returns the sums of squares of the parts: level, shift and rest.
ErrorParts squares_of(std::span<const double> parts) {
  ErrorParts squares{parts[0] * parts[0], parts[1] * parts[1] + parts[2] * parts[2], 0.0};
  const std::span<const double> rest = parts.subspan(3);
  for (const double value : rest) squares.rest_mm += value * value / static_cast<double>(rest.size());
  return squares;
}

void add(ErrorParts& sum, const ErrorParts& squares, double share) {
  sum.level_mm += share * squares.level_mm;
  sum.shift_mm += share * squares.shift_mm;
  sum.rest_mm += share * squares.rest_mm;
}

ErrorParts roots_of(const ErrorParts& squares) {
  return {std::sqrt(squares.level_mm), std::sqrt(squares.shift_mm), std::sqrt(squares.rest_mm)};
}

/// Effects of the factors on one specimen, part by part, with their standard errors.
struct SpecimenEffects {
  std::vector<std::vector<double>> changes, standard_errors;  // by factor and part
};

std::optional<SpecimenEffects> effects_of(const FractionalFactorial& design, const Runs& runs) {
  std::vector<Responses> by_part;
  for (std::size_t run = 0; run < runs.size(); ++run) {
    if (!runs[run]) continue;
    const std::vector<double> parts = parts_of(*runs[run]);
    if (by_part.empty()) by_part.assign(parts.size(), Responses(runs.size()));
    INCISE_REQUIRE(parts.size() == by_part.size() && parts.size() >= 3 + 4,
                   "expected errors in equally many directions, 4 or more");
    for (std::size_t k = 0; k < parts.size(); ++k) by_part[k][run] = parts[k];
  }
  SpecimenEffects effects{std::vector<std::vector<double>>(design.factors()),
                          std::vector<std::vector<double>>(design.factors())};
  if (by_part.empty()) return std::nullopt;
  for (const Responses& responses : by_part) {
    const auto fit = fit_factorial(design, responses);
    if (!fit) return std::nullopt;
    for (std::size_t k = 0; k < design.factors(); ++k) {
      effects.changes[k].push_back(fit->factors[k].change);
      effects.standard_errors[k].push_back(fit->factors[k].standard_error);
    }
  }
  return effects;
}

void count_cuts(const FractionalFactorial& design, const std::vector<Runs>& errors, std::size_t factor,
                FactorEffect& effect) {
  for (const Runs& runs : errors) {
    for (std::size_t run = 0; run < design.runs(); ++run) {
      const bool is_on = design.is_on(run, factor);
      ++(is_on ? effect.made_with : effect.made_without);
      if (runs[run]) ++(is_on ? effect.measured_with : effect.measured_without);
    }
  }
}

/// Returns the mean residual of a fit in runs where a group's pairs are alike, minus the mean in the other runs;
/// absent: no run of one kind was measured.
std::optional<double> contrast_of(const FractionalFactorial& design, const FractionalFactorial::Pair& pair,
                                  const Responses& residuals) {
  double sums[2] = {0.0, 0.0}, counts[2] = {0.0, 0.0};
  for (std::size_t run = 0; run < residuals.size(); ++run) {
    if (!residuals[run]) continue;
    const std::size_t kind = design.is_alike(run, pair) ? 1 : 0;
    sums[kind] += *residuals[run];
    counts[kind] += 1.0;
  }
  if (!(counts[0] > 0.0 && counts[1] > 0.0)) return std::nullopt;
  return sums[1] / counts[1] - sums[0] / counts[0];
}

/// @param fits  of the mean |error|, one per specimen.
std::vector<PairEffect> pairs_of(const FractionalFactorial& design, std::span<const std::string> names,
                                 const std::vector<FactorialFit>& fits) {
  std::vector<PairEffect> found;
  const auto groups = static_cast<double>(design.pair_groups().size());
  for (const std::vector<FractionalFactorial::Pair>& group : design.pair_groups()) {
    std::vector<double> changes;
    for (const FactorialFit& fit : fits)
      if (const auto change = contrast_of(design, group.front(), fit.residuals)) changes.push_back(*change);
    if (changes.empty()) continue;
    const TTest test = paired_t_test(std::vector<double>(changes.size(), 0.0), changes);
    PairEffect one{.change_mm = test.difference, .change_95 = test.confidence};
    if (test.p) one.p = std::min(1.0, groups * *test.p);
    for (const auto& [a, b] : group) one.pairs.emplace_back(names[a], names[b]);
    found.push_back(std::move(one));
  }
  std::ranges::stable_sort(found, {}, [](const PairEffect& effect) { return effect.p.value_or(1.0); });
  return found;
}

}  // namespace

FactorTable factor_table(const FractionalFactorial& design, std::span<const std::string> names,
                         const std::vector<Runs>& errors, const std::vector<Responses>& mean_abs_mm) {
  INCISE_REQUIRE(names.size() == design.factors() && errors.size() == mean_abs_mm.size(),
                 "expected one name for each factor, and as many lists of means as of errors");
  FactorTable table;
  std::vector<SpecimenEffects> specimens;
  std::vector<FactorialFit> means;
  for (std::size_t s = 0; s < errors.size(); ++s) {
    INCISE_REQUIRE(errors[s].size() == design.runs() && mean_abs_mm[s].size() == design.runs(),
                   fmt::format("expected {} runs of each specimen", design.runs()));
    table.cuts += design.runs();
    table.measured += static_cast<std::size_t>(std::ranges::count_if(errors[s], [](const auto& e) { return !!e; }));
    std::optional<SpecimenEffects> effects = effects_of(design, errors[s]);
    std::optional<FactorialFit> mean = fit_factorial(design, mean_abs_mm[s]);
    if (!effects || !mean) continue;
    specimens.push_back(std::move(*effects));
    means.push_back(std::move(*mean));
    table.estimated.push_back(s);
  }
  const double share = 1.0 / std::max(1.0, static_cast<double>(specimens.size()));
  ErrorParts chance;
  for (std::size_t k = 0; k < design.factors(); ++k) {
    FactorEffect effect{.factor = names[k]};
    count_cuts(design, errors, k, effect);
    ErrorParts moved;
    std::vector<double> changes;
    for (std::size_t s = 0; s < specimens.size(); ++s) {
      add(moved, squares_of(specimens[s].changes[k]), share);
      add(chance, squares_of(specimens[s].standard_errors[k]), share / static_cast<double>(design.factors()));
      changes.push_back(means[s].factors[k].change);
    }
    if (!changes.empty()) {
      effect.moved = roots_of(moved);
      const TTest test = paired_t_test(std::vector<double>(changes.size(), 0.0), changes);
      effect.change_mm = test.difference;
      effect.change_95 = test.confidence;
    }
    table.factors.push_back(std::move(effect));
  }
  if (specimens.empty()) return table;
  table.chance = roots_of(chance);
  table.pairs = pairs_of(design, names, means);
  return table;
}

void describe(Visitor& v, FactorEffect& e) {
  v("factor", e.factor, "Name of the factor.");
  v({"change_mm", "Change of the mean absolute error with the factor, mean over specimens.", "mm"}, e.change_mm);
  describe_interval(v, {"change_95_mm", "95 % interval of change_mm.", "mm"}, e.change_95);
  v("moved", e.moved, "Effect of the factor on each part of the error: root mean squares over specimens.");
  v("made_with", e.made_with, "Cuts with the factor.");
  v("measured_with", e.measured_with, "Of these, cuts whose ring could be measured.");
  v("made_without", e.made_without, "Cuts without the factor.");
  v("measured_without", e.measured_without, "Of these, cuts whose ring could be measured.");
}

void describe(Visitor& v, PairEffect& e) {
  std::vector<std::string> names;
  for (const auto& [a, b] : e.pairs) names.push_back(a + " and " + b);
  v.derived("pairs", names, "Pairs of factors that the design cannot tell apart.");
  v({"change_mm", "Change of the mean absolute error where both of a pair are on, or both off; mean over specimens.",
     "mm"},
    e.change_mm);
  describe_interval(v, {"change_95_mm", "95 % interval of change_mm.", "mm"}, e.change_95);
  v("p", e.p, "Two-tailed p-value of that change, multiplied by the number of groups.");
}

void describe(Visitor& v, FactorTable& t) {
  v("cuts", t.cuts, "Requested cuts.");
  v("measured", t.measured, "Of these, cuts whose ring could be measured.");
  v("estimated", t.estimated, "Specimens, counted from 0, whose measured cuts determine their effects.");
  v("factors", t.factors, "Effects of the factors, in the order of the design.");
  v("chance", t.chance, "Effect that a factor without influence would seem to have.");
  v("pairs", t.pairs, "Interactions of pairs of factors, the smallest p first.");
}

}  // namespace incise::laboratory
