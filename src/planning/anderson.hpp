#pragma once

#include <span>
#include <vector>

namespace incise {

/// One point of a fixed-point iteration x -> x + f(x).
struct IterationPoint {
  std::vector<double> x;
  std::vector<double> f;
};

/// Where to go from `base`: the plain step base.x + base.f, corrected by what earlier points tell about how f changes
/// with x (Anderson acceleration, type II). @param earlier  any number of other points; none: the plain step.
/// @param noise  rms noise of the entries of f: what the earlier points say within it is damped, >= 0.
/// Source: [WalkerNi2011], with Tikhonov's regularisation.
[[nodiscard]] std::vector<double> accelerated_step(const IterationPoint& base, std::span<const IterationPoint> earlier,
                                                   double noise);

}  // namespace incise
