#pragma once

#include <incise/core/describe.hpp>
#include <incise/evaluation/fractional_factorial.hpp>
#include <incise/evaluation/t_tests.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace incise::laboratory {

/// Error of a photographed ring by direction in the picture, mm. Directions are the same for all cuts of a specimen.
using ErrorByDirection = std::vector<double>;

/// The parts of a difference of two such errors, mm.
struct ErrorParts {
  double level_mm = 0.0;  ///< mean round the ring
  double shift_mm = 0.0;  ///< shift of the whole ring: amplitude of the wave that goes once round
  double rest_mm = 0.0;   ///< root mean square of the remainder
};
inline void describe(Visitor& v, ErrorParts& p) {
  v({"level_mm", "Mean round the ring.", "mm"}, p.level_mm);
  v({"shift_mm", "Shift of the ring as a whole.", "mm"}, p.shift_mm);
  v({"rest_mm", "Root mean square of the remainder.", "mm"}, p.rest_mm);
}

/// The effect of one factor on the error as planned.
struct FactorEffect {
  std::string factor;
  std::optional<double> change_mm;               ///< change of the mean |error|, mm: mean over specimens
  std::optional<Interval> change_95;             ///< of that mean, Student's; absent for fewer than two specimens
  std::optional<ErrorParts> moved;               ///< effect on each part: root mean squares over specimens
  std::size_t made_with = 0, measured_with = 0;  ///< cuts, and those whose ring could be measured
  std::size_t made_without = 0, measured_without = 0;  ///< likewise where the factor is off
};
void describe(Visitor& v, FactorEffect& e);

/// The sum of the interactions of pairs that the design aliases.
struct PairEffect {
  std::vector<std::pair<std::string, std::string>> pairs;
  /// Difference of the mean |error|, mm, between runs in which both of a pair are on or both off and the other runs,
  /// beyond the factors' own effects: mean over specimens.
  double change_mm = 0.0;
  std::optional<Interval> change_95;  ///< of that mean, Student's
  std::optional<double> p;            ///< two-tailed p-value times the number of groups, at most 1
};
void describe(Visitor& v, PairEffect& e);

struct FactorTable {
  std::size_t cuts = 0, measured = 0;
  std::vector<std::size_t> estimated;  ///< indices of the specimens whose measured cuts determine their effects
  std::vector<FactorEffect> factors;   ///< in the order of the design
  std::optional<ErrorParts> chance;    ///< apparent effect of a factor without influence
  std::vector<PairEffect> pairs;       ///< ascending p; empty: too few cuts could be measured
};
void describe(Visitor& v, FactorTable& t);

/// Estimates the effects of the factors. Effects are estimated by specimen and combined as root mean squares: a drift
/// to the left and one to the right do not cancel. Intervals and p-values of a mean follow from the spread among
/// specimens. If no specimen's cuts determine its effects, `moved`, `chance` and `pairs` are absent.
/// @param names    of the design's factors.
/// @param errors   by specimen and run; absent: no closed ring. All lists are equally long, 4 or more.
/// @throws InvalidArgument for lists of other lengths, or errors that are not finite.
[[nodiscard]] FactorTable factor_table(const FractionalFactorial& design, std::span<const std::string> names,
                                       const std::vector<std::vector<std::optional<ErrorByDirection>>>& errors,
                                       const std::vector<std::vector<std::optional<double>>>& mean_abs_mm);

}  // namespace incise::laboratory
