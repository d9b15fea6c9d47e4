#pragma once

#include <incise/mechanics/tissue.hpp>

namespace incise {

/// Turns model.constraints into fixed axes, prescribed displacements, support planes and dead loads. Throws CaseError
/// naming the constraint
/// ("specimen.constraints[2].where") that selects nothing, has a bad number, or contradicts an earlier one.
void apply_constraints(TissueModel& model, const Vec3& gravity_mm_s2);

/// Throws CaseError when the body could still move as a whole: the fixed axes of its vertices leave one of the six
/// rigid motions free.
void require_no_rigid_motion(const TissueModel& model);

}  // namespace incise
