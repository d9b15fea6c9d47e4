#pragma once

#include <incise/mechanics/tissue.hpp>

namespace incise {

/// Returns the vertices of the mesh in a region, ascending.
/// @throws CaseError for `field` if the region cannot be applied to the mesh, or selects no vertex.
[[nodiscard]] std::vector<VertexId> selected_vertices(const TetMesh& mesh, const Region& region,
                                                      const std::string& field);

/// Turns model.constraints and gravity into fixed axes, prescribed displacements, supports and dead loads.
/// @throws CaseError naming a constraint ("specimen.constraints[2].where") that selects nothing, has a bad number or an
/// unusable holder, or contradicts an earlier one.
void apply_constraints(TissueModel& model, const Vec3& gravity_mm_s2);

/// Checks that the body cannot move as a whole. @throws CaseError if the fixed axes leave one of the six rigid motions
/// free; supports do not count.
void require_no_rigid_motion(const TissueModel& model);

}  // namespace incise
