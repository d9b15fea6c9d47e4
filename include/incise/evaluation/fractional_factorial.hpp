#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace incise {

/// Regular two-level designs of 8, 16 or 32 runs for at most 4, 8 or 16 factors, and of 2 and 4 runs for one and two
/// factors. No run is repeated. Their resolution is IV: the main effect of a factor is not aliased with other main
/// effects or with interactions of pairs, but interactions of pairs are aliased with one another.
/// Source: [BoxHunter1961].
class FractionalFactorial {
 public:
  using Pair = std::pair<std::size_t, std::size_t>;  ///< of factors, the lower one first

  /// Makes the smallest design for this number of factors. @throws InvalidArgument unless 1 to 16.
  explicit FractionalFactorial(std::size_t factors);

  [[nodiscard]] std::size_t factors() const { return words_.size(); }
  [[nodiscard]] std::size_t runs() const { return std::size_t{1} << bits_; }
  /// Whether a factor is on in a run. In run 0 every factor is off; each is on in half of the runs.
  /// @pre run < runs(), factor < factors().
  [[nodiscard]] bool is_on(std::size_t run, std::size_t factor) const;
  /// Whether both factors of a pair are in the same state in a run.
  [[nodiscard]] bool is_alike(std::size_t run, const Pair& pair) const {
    return is_on(run, pair.first) == is_on(run, pair.second);
  }
  /// Returns all pairs of factors, in groups. The interactions of one group are aliased: only their sum can be
  /// estimated.
  [[nodiscard]] const std::vector<std::vector<Pair>>& pair_groups() const { return pair_groups_; }

 private:
  unsigned bits_ = 1;
  std::vector<unsigned> words_;  ///< of each factor: bits of the run whose parity is its state
  std::vector<std::vector<Pair>> pair_groups_;
};

/// The effect of one factor, in the unit of the response.
struct FactorialEffect {
  double change = 0.0;
  double standard_error = 0.0;
};

struct FactorialFit {
  std::vector<FactorialEffect> factors;          ///< by factor: response with it minus response without it
  std::vector<std::optional<double>> residuals;  ///< by run: measured minus fitted response; absent if not measured
};

/// Fits a mean and the main effects of all factors by least squares.
/// @param responses  one for each run; absent if not measured.
/// @returns nothing if the measured responses do not determine the effects and their standard errors.
/// @throws InvalidArgument unless there are design.runs() responses, the measured ones finite.
/// @note O(runs · factors²).
[[nodiscard]] std::optional<FactorialFit> fit_factorial(const FractionalFactorial& design,
                                                        std::span<const std::optional<double>> responses);

}  // namespace incise
