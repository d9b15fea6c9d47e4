#pragma once

#include <incise/core/monitor.hpp>
#include <incise/core/outcome.hpp>
#include <incise/second_bench/specimen.hpp>

#include <memory>

namespace incise::second_bench {

struct BodyState;  // tissue, platform and shape: private to the bench

/// Resolution of the second bench's computation. It is a part of the bench: results depend on it.
struct Resolution {
  double brick_mm = 2.0;   ///< approximate edge of the bricks round the tumour's ring, > 0
  double coarse_mm = 4.5;  ///< the same far from it, >= brick_mm
  double way_mm = 0.5;     ///< greatest travel of the tool in a step, > 0; a step also takes at most half a second
  int relaxations = 14;    ///< iterations of dynamic relaxation in a step, > 0
};

/// A specimen of the second bench in its holder: clamped, its tip pulled forward. LPS frame of the shape, mm; the
/// platform is z = 0, +z is up, and camera and surgeon look along -z. Hidden from the planner.
struct Body {
  Specimen specimen;
  Resolution resolution;
  std::shared_ptr<const BodyState> state;   ///< stretched, relaxed for Specimen::wait_s
  double stretch_force_n = 0.0;             ///< the suture's pull when the cut begins
  double gauge_force_n = 0.0;               ///< the gauge's reading at Specimen::gauge_s, with its bias, without noise
  double residual = 0.0;                    ///< norm of the free forces divided by that of the reactions, at the end
  Outcome outcome = Outcome::NotConverged;  ///< Success: `residual` is below 1e-3
};

/// Makes the body of a specimen, clamps and stretches it; takes about one second on one core. The same specimen and
/// resolution give the same bits. A body that does not come to rest is returned, with its `outcome`; do not read or cut
/// it.
/// @throws CaseError naming the first parameter out of range, or for a tumour that reaches beyond the tissue;
///         InvalidArgument for a resolution out of range; Cancelled.
[[nodiscard]] Body make_body(const Specimen& specimen, const Resolution& resolution, Monitor& monitor);

}  // namespace incise::second_bench
