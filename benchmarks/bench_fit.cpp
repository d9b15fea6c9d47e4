// How well can the planner's own simulation be made to follow one cut of the virtual bench? See planner_fit.hpp.
//   incise_bench_fit [first seed] [specimens] [tets] [tets|lattice|paper] [kernel_radius_mm] [hold_per_mm2]
#include "support/planner_fit.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>

using namespace incise::testing;

int main(int argc, char** argv) {
  const std::uint64_t first = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
  const std::uint64_t count = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 2;
  const int tets = argc > 3 ? std::atoi(argv[3]) : 25000;
  const std::optional<incise::CutRule> rule =
      argc > 4 ? incise::value_of<incise::CutRule>(argv[4]) : incise::CutRule::Tets;
  if (!rule) {
    fmt::print(stderr, "incise_bench_fit: expected one of {} as the rule, found {}\n",
               incise::choices(incise::names_of(incise::CutRule{})), argv[4]);
    return 2;
  }
  incise::CutSettings cut;
  cut.rule = *rule;
  if (argc > 5) cut.kernel_radius_mm = std::strtod(argv[5], nullptr);
  if (argc > 6) cut.hold_per_mm2 = std::strtod(argv[6], nullptr);
  if (const auto problems = incise::validate(cut, 1.0); !problems.empty()) {
    fmt::print(stderr, "incise_bench_fit: {}\n", incise::sentence(problems.front()));
    return 2;
  }
  fmt::print(
      "seed,bench_mean_abs_mm,bench_sd_mm,residual_rms_mm,dullness_at_13_mm_s,modulus_kpa,bias_mm,open_simulations\n");
  std::size_t fitted = 0;
  std::size_t in_band = 0;
  double sum = 0.0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const std::optional<PlannerFit> fit = fit_planner_to_bench(seed, tets, cut);
    if (!fit) {
      fmt::print("{},no closed ring\n", seed);
      continue;
    }
    fmt::print("{},{:.3f},{:.3f},{:.3f},{:.1f},{:.0f},{:.3f},{}\n", seed, fit->seen_mean_abs_mm, fit->seen_sd_mm,
               fit->residual_rms_mm, fit->dullness, fit->modulus_kpa, fit->bias_mm, fit->open_simulations);
    std::fflush(stdout);
    ++fitted;
    in_band += fit->residual_rms_mm >= kLeastResidualMm && fit->residual_rms_mm <= kMostResidualMm ? 1 : 0;
    sum += fit->residual_rms_mm;
  }
  const double mean = fitted > 0 ? sum / static_cast<double>(fitted) : 0.0;
  fmt::print("# residual: mean {:.3f} mm rms, {} of {} specimens in {} to {} mm\n", mean, in_band, fitted, kLeastResidualMm,
             kMostResidualMm);
  return fitted > 0 && mean >= kLeastResidualMm && mean <= kMostResidualMm ? 0 : 4;
}
