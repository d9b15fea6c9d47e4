#pragma once

#include <incise/mechanics/solvers.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace incise {

/// Aggregates that one thread takes at a time in a sweep of conjugate gradients.
inline constexpr std::size_t kAggregatesPerChunk = 2;

/// Adds the sums of the chunks in their order: same bits at any thread count.
inline double sum_of(const std::vector<double>& of_chunks) {
  return std::accumulate(of_chunks.begin(), of_chunks.end(), 0.0);
}

/// Preconditioned conjugate gradients from x = start · p. `sweeps` owns the vectors, initially r = b and x = 0, with p
/// and A p those of a first direction (0: none), and provides
///   move(alpha):    x += alpha p, r -= alpha A p; returns |r|
///   precondition(): prepares M⁻¹ r; returns r · M⁻¹ r
///   turn(beta):     p = M⁻¹ r + beta p
///   multiply():     A p; returns p · A p
template <class Sweeps>
PcgReport iterate(Sweeps& sweeps, const PcgSettings& settings, double start = 0.0) {
  PcgReport report;
  const double reference = settings.reference_mn > 0.0 ? settings.reference_mn : sweeps.move(0.0);
  report.residual_mn = sweeps.move(start);
  const double target = settings.relative_tolerance * std::max(reference, settings.floor_mn);
  double rz_before = 0.0;
  while (!(report.residual_mn <= target) && report.iterations < settings.max_iterations) {
    const double rz = sweeps.precondition();
    sweeps.turn(report.iterations == 0 ? 0.0 : rz / rz_before);
    const double pq = sweeps.multiply();
    if (!(pq > 0.0) || !std::isfinite(rz)) {  // x is the last good iterate
      report.is_indefinite = true;
      break;
    }
    report.residual_mn = sweeps.move(rz / pq);
    rz_before = rz;
    ++report.iterations;
  }
  report.converged = !report.is_indefinite && report.residual_mn <= target;
  return report;
}

}  // namespace incise
