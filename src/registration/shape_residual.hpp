#pragma once

#include "registration/settling.hpp"

namespace incise {

/// The part of the distance between two aligned surfaces that noise does not explain, in units of the target's radius.
struct ShapeResidual {
  double left = 0.0;       ///< explained by neither noise nor settling: see shape_residual
  double apart_rms = 0.0;  ///< of the smooth part that settling explains, but no change of the pose
  double apart_largest = 0.0;
  double settled_rms = 0.0;  ///< of the whole smooth part
};

/// Computes how far the source lies from the target beyond what noise and settling explain: the 90th percentile over
/// neighbourhoods of the source's points, each the median height of the target's points within a fifth of the target's
/// radius, less the part that noise explains. Ridges and hollows of another shape remain in it. Pose and settling are
/// found once more, with settling allowed even if it was not requested. All 0 if too few points lie above the target.
/// @param settling  how far tissue may have settled, as two standard deviations; at least 0.035 is used.
/// @pre both clouds are in units of the target's radius; so is the result.
[[nodiscard]] ShapeResidual shape_residual(const SampledSurface& source, const SampledSurface& target, const Similarity& start,
                                           const ScaleRange& scale, double settling, Workers& workers);

}  // namespace incise
