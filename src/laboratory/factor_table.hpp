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

/// How far a photographed ring missed, by direction in the picture, mm. As it is for all cuts of one specimen.
using ErrorByDirection = std::vector<double>;

/// What makes up a difference of two such errors, mm.
struct ErrorParts {
  double level_mm = 0.0;  ///< mean round the ring
  double shift_mm = 0.0;  ///< of the ring as a whole: amplitude of the wave that goes once round
  double rest_mm = 0.0;   ///< root mean square of what is left
};
inline void describe(Visitor& v, ErrorParts& p) {
  v({"level_mm", "Mean round the ring.", "mm"}, p.level_mm);
  v({"shift_mm", "Of the ring as a whole.", "mm"}, p.shift_mm);
  v({"rest_mm", "Root mean square of what is left.", "mm"}, p.rest_mm);
}

/// What one factor does to the error as planned.
struct FactorEffect {
  std::string factor;
  std::optional<double> change_mm;               ///< of the mean |error|: mean over specimens
  std::optional<Interval> change_95;             ///< of that mean, Student's; absent for fewer than two specimens
  std::optional<ErrorParts> moved;               ///< root mean squares over specimens of what the factor does to each
  std::size_t made_with = 0, measured_with = 0;  ///< cuts, and those whose ring could be measured
  std::size_t made_without = 0, measured_without = 0;  ///< likewise where the factor is off
};
void describe(Visitor& v, FactorEffect& e);

/// The sum of the interactions of pairs that the design aliases.
struct PairEffect {
  std::vector<std::pair<std::string, std::string>> pairs;
  /// Of the mean |error| where both of a pair are on, or both off, beyond the factors' own effects: mean over
  /// specimens.
  double change_mm = 0.0;
  std::optional<Interval> change_95;  ///< of that mean, Student's
  std::optional<double> p;            ///< two-tailed, that it is chance, for one of all groups: times their number
};
void describe(Visitor& v, PairEffect& e);

struct FactorTable {
  std::size_t cuts = 0, measured = 0;
  std::vector<std::size_t> estimated;  ///< specimens, by index, whose measured cuts determine their effects
  std::vector<FactorEffect> factors;   ///< in the order of the design
  std::optional<ErrorParts> chance;    ///< what an idle factor would be found to move
  std::vector<PairEffect> pairs;       ///< the least p first; empty: too few cuts could be measured
};
void describe(Visitor& v, FactorTable& t);

/// Effects by specimen, of which root mean squares are taken: a drift to the left and one to the right do not cancel.
/// What is said to be chance of a mean follows from how specimens differ. Without a specimen whose cuts determine its
/// effects `moved`, `chance` and `pairs` are absent.
/// @param names    of the design's factors.
/// @param errors   by specimen and run; absent: no closed ring. All lists are equally long, 4 or more.
/// @throws InvalidArgument for lists of other lengths, or errors that are not finite.
[[nodiscard]] FactorTable factor_table(const FractionalFactorial& design, std::span<const std::string> names,
                                       const std::vector<std::vector<std::optional<ErrorByDirection>>>& errors,
                                       const std::vector<std::vector<std::optional<double>>>& mean_abs_mm);

}  // namespace incise::laboratory
