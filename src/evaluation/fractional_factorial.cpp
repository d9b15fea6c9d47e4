#include <incise/core/error.hpp>
#include <incise/evaluation/fractional_factorial.hpp>

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

namespace incise {
namespace {

constexpr std::size_t kMostFactors = 16;

}  // namespace

// Each factor has a word with an odd number of bits set. The product of two words has an even number, so no interaction
// of a pair is aliased with a factor.
FractionalFactorial::FractionalFactorial(std::size_t factors) {
  INCISE_REQUIRE(factors >= 1 && factors <= kMostFactors,
                 fmt::format("expected 1 to {} factors, found {}", kMostFactors, factors));
  while ((std::size_t{1} << (bits_ - 1)) < factors) ++bits_;
  std::vector<unsigned> odd;
  for (unsigned word = 1; word < (1U << bits_); ++word)
    if (std::popcount(word) % 2 == 1) odd.push_back(word);
  std::stable_sort(odd.begin(), odd.end(), [](unsigned a, unsigned b) { return std::popcount(a) < std::popcount(b); });
  words_.assign(odd.begin(), odd.begin() + static_cast<std::ptrdiff_t>(factors));
  std::map<unsigned, std::vector<Pair>> groups;
  for (std::size_t a = 0; a < factors; ++a)
    for (std::size_t b = a + 1; b < factors; ++b) groups[words_[a] ^ words_[b]].emplace_back(a, b);
  for (auto& [word, pairs] : groups) pair_groups_.push_back(std::move(pairs));
}

bool FractionalFactorial::is_on(std::size_t run, std::size_t factor) const {
  return std::popcount(static_cast<unsigned>(run) & words_.at(factor)) % 2 == 1;
}

std::optional<FactorialFit> fit_factorial(const FractionalFactorial& design,
                                          std::span<const std::optional<double>> responses) {
  INCISE_REQUIRE(responses.size() == design.runs(),
                 fmt::format("expected {} responses, found {}", design.runs(), responses.size()));
  std::vector<std::size_t> measured;
  for (std::size_t run = 0; run < responses.size(); ++run) {
    INCISE_REQUIRE(!responses[run] || std::isfinite(*responses[run]), "expected finite responses");
    if (responses[run]) measured.push_back(run);
  }
  const auto rows = static_cast<Eigen::Index>(measured.size());
  const auto effects = static_cast<Eigen::Index>(design.factors()) + 1;
  if (rows <= effects) return std::nullopt;
  Eigen::MatrixXd model = Eigen::MatrixXd::Ones(rows, effects);
  Eigen::VectorXd values(rows);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const std::size_t run = measured[static_cast<std::size_t>(row)];
    values[row] = *responses[run];
    for (Eigen::Index k = 1; k < effects; ++k)
      model(row, k) = design.is_on(run, static_cast<std::size_t>(k - 1)) ? 0.5 : -0.5;
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(model);
  if (solver.rank() < effects) return std::nullopt;
  const Eigen::VectorXd found = solver.solve(values);
  const Eigen::VectorXd rest = values - model * found;
  const double variance = rest.squaredNorm() / static_cast<double>(rows - effects);
  const Eigen::MatrixXd inverse = (model.transpose() * model).inverse();
  FactorialFit fit;
  for (Eigen::Index k = 1; k < effects; ++k) fit.factors.push_back({found[k], std::sqrt(variance * inverse(k, k))});
  fit.residuals.resize(responses.size());
  for (Eigen::Index row = 0; row < rows; ++row) fit.residuals[measured[static_cast<std::size_t>(row)]] = rest[row];
  return fit;
}

}  // namespace incise
