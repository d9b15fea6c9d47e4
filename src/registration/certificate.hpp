#pragma once

#include "registration/surface_match.hpp"

#include <incise/registration/register_clouds.hpp>

namespace incise {

/// How well the surfaces fix the transform: see Certificate. @param width  of the residuals' robust weight, as icp
/// leaves it.
[[nodiscard]] Certificate certificate_of(const SampledSurface& source, const SampledSurface& target,
                                         const Similarity& t, double width, bool with_scale, Workers& workers);

}  // namespace incise
