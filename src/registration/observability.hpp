#pragma once

#include "registration/surface_match.hpp"

#include <incise/registration/register_clouds.hpp>

namespace incise {

/// Returns how well the surfaces determine the transform t. @param width  of the robust weight at the end of ICP.
[[nodiscard]] PoseObservability pose_observability(const SampledSurface& source, const SampledSurface& target,
                                                   const Similarity& t, double width, bool with_scale,
                                                   Workers& workers);

/// Sets the covariance (about `center`, with rms arm `length`) and the standard deviations that follow from it, except
/// that of the weakest motion. Does not change what follows from the shapes alone (visible, sharpness).
void set_covariance(PoseObservability& certificate, const Mat7& covariance, const Vec3& center, double length);

/// Sets the weakest motion and its standard deviation from the covariance. Turns and stretches are measured by how far
/// they move points at the rms arm `length`.
void find_weakest(PoseObservability& certificate, double length);

}  // namespace incise
