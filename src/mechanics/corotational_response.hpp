#pragma once

#include "mechanics/elastic_response.hpp"
#include "mechanics/kernels/kernels.hpp"

namespace incise {

/// add_elastic_response for the plain corotational law (no fibres, volume per tet): the fast path of a cut, with the
/// kernels of active_isa().
/// @pre `stiffness` is symmetric; the caller has checked all sizes.
void add_corotational_response(const TissueModel& model, TissueState& state, std::span<Vec3> forces,
                               BlockMatrix* stiffness, Tangent tangent, Workers& workers);

/// Adds forces as add_corotational_response. Of the tangent of frozen rotations it adds only the change since
/// `assembled` was put into `stiffness`, and only to the blocks on and above the diagonal.
void renew_corotational_tangent(const TissueModel& model, TissueState& state, std::span<Vec3> forces, BlockMatrix& stiffness,
                                const AssembledTets& assembled, Workers& workers);

/// Returns the energy of this law, µJ.
[[nodiscard]] double corotational_energy_uj(const TissueModel& model, const TissueState& state);

}  // namespace incise
