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

// Words of an odd number of bits: the product of two of them is one of an even number, so that no pair is confused with
// a factor.
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
                                          std::span<const std::vector<std::optional<double>>> blocks, bool with_pairs) {
  Eigen::Index measured = 0;
  for (const auto& block : blocks) {
    INCISE_REQUIRE(block.size() == design.runs(),
                   fmt::format("expected {} responses in a block, found {}", design.runs(), block.size()));
    for (const std::optional<double>& response : block) {
      INCISE_REQUIRE(!response || std::isfinite(*response), "expected finite responses");
      measured += response ? 1 : 0;
    }
  }
  const auto levels = static_cast<Eigen::Index>(blocks.size());
  const auto factors = static_cast<Eigen::Index>(design.factors());
  const auto groups = with_pairs ? static_cast<Eigen::Index>(design.pair_groups().size()) : 0;
  const Eigen::Index effects = levels + factors + groups;
  if (measured <= effects) return std::nullopt;
  Eigen::MatrixXd model = Eigen::MatrixXd::Zero(measured, effects);
  Eigen::VectorXd responses(measured);
  const auto half = [](bool is_high) { return is_high ? 0.5 : -0.5; };
  Eigen::Index row = 0;
  for (Eigen::Index block = 0; block < levels; ++block) {
    for (std::size_t run = 0; run < design.runs(); ++run) {
      const std::optional<double>& response = blocks[static_cast<std::size_t>(block)][run];
      if (!response) continue;
      responses[row] = *response;
      model(row, block) = 1.0;
      for (Eigen::Index k = 0; k < factors; ++k)
        model(row, levels + k) = half(design.is_on(run, static_cast<std::size_t>(k)));
      for (Eigen::Index k = 0; k < groups; ++k)
        model(row, levels + factors + k) =
            half(design.is_alike(run, design.pair_groups()[static_cast<std::size_t>(k)].front()));
      ++row;
    }
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(model);
  if (solver.rank() < effects) return std::nullopt;
  const Eigen::VectorXd found = solver.solve(responses);
  FactorialFit fit{
      .factors = {}, .pair_groups = {}, .degrees_of_freedom = static_cast<std::size_t>(measured - effects)};
  const double variance = (responses - model * found).squaredNorm() / static_cast<double>(fit.degrees_of_freedom);
  const Eigen::MatrixXd inverse = (model.transpose() * model).inverse();
  for (Eigen::Index k = levels; k < effects; ++k) {
    auto& list = k < levels + factors ? fit.factors : fit.pair_groups;
    list.push_back({found[k], std::sqrt(variance * inverse(k, k))});
  }
  return fit;
}

}  // namespace incise
