#pragma once

#include <incise/calibration/ring_covariates.hpp>
#include <incise/mechanics/tissue.hpp>
#include <incise/workflow/case.hpp>

namespace incise {

/// Computes the covariates of a planned ring.
/// @param positions   of the model's nodes, stretched, mm.
/// @param tumor_edge  closed, on the stretched tissue, same frame, mm.
/// @param youngs_modulus_kpa  implied by the measured pull; without one, the case's.
/// @note The pull is the greatest displacement among the model's constraints, seen along the approach. If nothing is
/// displaced, the view's y takes its place.
[[nodiscard]] RingCovariates ring_covariates(const Case& settings, const TissueModel& model, const Points& positions,
                                             const Contour& tumor_edge, double youngs_modulus_kpa);

}  // namespace incise
