#pragma once

#include "verification/sofa_body.hpp"

#include <incise/mechanics/tissue.hpp>

namespace incise::testing {

/// SOFA's steps (see SofaStepping) with the library's forces, tangent and Cholesky factor.
[[nodiscard]] Points library_steps(const TissueModel& model, const SofaStepping& stepping);

}  // namespace incise::testing
