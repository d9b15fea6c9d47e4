#include "bond_stiffness.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace incise {
namespace {

constexpr double kKappa = 600.0;  // kPa/mm²
constexpr double kMu = 23.5;      // kPa

/// What a long row of linear elements, all held, passes on per area when its end is offset by 1 mm, kPa/mm. Each element's hold is integrated
/// exactly. The row's stiffness is built up element by element from the far end.
double passed_on(double kappa, double edge_mm) {
  double rest = 0.0;  // of the row behind the next element
  for (int i = 0; i < 2000; ++i) {
    const double own = kMu / edge_mm + kappa * edge_mm / 3.0;
    const double across = -kMu / edge_mm + kappa * edge_mm / 6.0;
    rest = own - across * across / (own + rest);
  }
  return rest;
}

TEST(BondStiffness, ARowOfElementsOfAnyLengthPassesOnWhatTheContinuumDoes) {
  const double continuum = std::sqrt(kMu * kKappa);
  for (const double edge_mm : {0.02, 0.2, 0.5, 0.8, 2.0}) {
    const double held = resolved_bond_stiffness(kKappa, kMu, edge_mm);
    EXPECT_NEAR(passed_on(held, edge_mm), continuum, 1e-9 * continuum) << edge_mm << " mm";
  }
  EXPECT_GT(passed_on(kKappa, 0.8), 1.5 * continuum) << "without it a mesh of 0.8 mm holds far too firmly";
}

TEST(BondStiffness, OfAFineMeshIsThatOfTheContinuumAndOfNoHoldIsNone) {
  EXPECT_NEAR(resolved_bond_stiffness(kKappa, kMu, 1e-4), kKappa, 1e-4);
  EXPECT_LT(resolved_bond_stiffness(kKappa, kMu, 1.0), resolved_bond_stiffness(kKappa, kMu, 0.9));
  EXPECT_EQ(resolved_bond_stiffness(0.0, kMu, 1.0), 0.0);
}

}  // namespace
}  // namespace incise
