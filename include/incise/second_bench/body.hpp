#pragma once

#include <incise/core/monitor.hpp>
#include <incise/core/outcome.hpp>
#include <incise/second_bench/specimen.hpp>

#include <memory>

namespace incise::second_bench {

struct BodyState;  // tissue, platform and shape: private to the bench

/// How finely the second bench computes. Part of what it is: results change with it.
struct Resolution {
  double brick_mm = 2.0;   ///< edge of the bricks round the tumour's ring, about; > 0
  double coarse_mm = 4.5;  ///< far from it; >= brick_mm
  double way_mm = 0.5;     ///< of the tool in a step, or half a second of dwelling; > 0
  int relaxations = 14;    ///< iterations of the tissue in a step; > 0
};

/// A specimen of the second bench in its holder: clamped, its tip drawn forward. LPS frame of the shape, mm; the
/// platform is z = 0, +z is up, and camera and surgeon look along -z. Hidden from whoever plans.
struct Body {
  Specimen specimen;
  Resolution resolution;
  std::shared_ptr<const BodyState> state;   ///< stretched, relaxed for Specimen::wait_s
  double stretch_force_n = 0.0;             ///< the suture's pull when the cut begins
  double gauge_force_n = 0.0;               ///< what its gauge said after Specimen::gauge_s, bias included, noise not
  double residual = 0.0;                    ///< free forces over reactions when last at rest
  Outcome outcome = Outcome::NotConverged;  ///< Success: `residual` is below 1e-3
};

/// Makes the body of a specimen, holds and stretches it; about one second of one core. The same specimen and resolution
/// give the same bits. A body that does not come to rest is a result: its `outcome` says so, and nothing can be read or
/// cut.
/// @throws CaseError for a specimen that is not valid or a tumour beyond the tissue; InvalidArgument for a resolution
/// out of range; Cancelled.
[[nodiscard]] Body make_body(const Specimen& specimen, const Resolution& resolution, Monitor& monitor);

}  // namespace incise::second_bench
