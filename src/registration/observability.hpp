#pragma once

#include "registration/surface_match.hpp"

#include <incise/registration/register_clouds.hpp>

namespace incise {

/// How well the surfaces fix the transform: see PoseObservability. @param width  of the residuals' robust weight, as
/// icp leaves it.
[[nodiscard]] PoseObservability pose_observability(const SampledSurface& source, const SampledSurface& target,
                                                   const Similarity& t, double width, bool with_scale,
                                                   Workers& workers);

/// Puts another covariance (about `center`, rms arm `length`) in the place of the one from noise alone, and the
/// standard deviations that follow from it. What the shapes alone say (visible, sharpness) stays; the weakest motion
/// does, too.
void set_covariance(PoseObservability& certificate, const Eigen::Matrix<double, 7, 7>& covariance, const Vec3& center,
                    double length);

/// Finds the weakest motion and its standard deviation in the covariance, with a turn and a stretch as large as they
/// move points at the rms arm `length`.
void find_weakest(PoseObservability& certificate, double length);

}  // namespace incise
