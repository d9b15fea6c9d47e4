#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/imaging/tumor_star.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace {

constexpr std::size_t kFirstHarmonic = 2;

double order(std::size_t h) {
  return static_cast<double>(h + kFirstHarmonic);
}

}  // namespace

double TumorStar::radius_at_mm(double angle) const {
  double sum = 1.0;
  for (std::size_t h = 0; h < amplitude.size(); ++h) sum += amplitude[h] * std::cos(order(h) * angle + phase[h]);
  return radius_mm * sum;
}

TumorStar draw_tumor_star(double diameter_mm, double irregularity, Random& random) {
  INCISE_REQUIRE(diameter_mm > 0.0 && std::isfinite(diameter_mm),
                 fmt::format("expected diameter_mm > 0, found {}", diameter_mm));
  INCISE_REQUIRE(irregularity >= 0.0 && irregularity <= 0.5,
                 fmt::format("expected irregularity in [0, 0.5], found {}", irregularity));
  TumorStar star;
  star.radius_mm = 0.5 * diameter_mm;
  double total = 0.0;
  for (std::size_t h = 0; h < star.amplitude.size(); ++h) {
    star.amplitude[h] = random.uniform(0.5, 1.0) / order(h);
    star.phase[h] = random.uniform(0.0, 2.0 * units::kPi);
    total += star.amplitude[h];
  }
  for (double& amplitude : star.amplitude) amplitude *= irregularity / total;
  return star;
}

}  // namespace incise
