#pragma once

#include "registration/settling.hpp"

namespace incise {

/// What noise does not explain of the distance between two surfaces that lie on each other. In units of the target's radius.
struct ShapeResidual {
  double left = 0.0;         ///< by neither noise nor settling: see shape_residual
  double apart_rms = 0.0;  ///< of the smooth part, which settling explains and no change of the pose does
  double apart_largest = 0.0;
  double settled_rms = 0.0;  ///< of all of the smooth part
};

/// How far the source lies from the target where neither noise nor settling explains it: the distance that nine tenths
/// of the neighbourhoods keep within, each the median height of the target's points within a fifth of the target's
/// radius, less what their noise makes of a median. Ridges and hollows of another shape stay in it. Pose and settling are
/// found once more, with settling allowed for whether or not it was asked for. 0 where too few points lie above the target.
/// @param settling  how far tissue may have settled: two standard deviations; less than usual counts as usual.
/// Both clouds, and the answer, in units of the target's radius.
[[nodiscard]] ShapeResidual shape_residual(const SampledSurface& source, const SampledSurface& target, const Similarity& start,
                                           const ScaleRange& scale, double settling, Workers& workers);

}  // namespace incise
