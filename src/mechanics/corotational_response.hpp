#pragma once

#include "mechanics/elastic_response.hpp"
#include "mechanics/kernels/kernels.hpp"

namespace incise {

/// add_elastic_response for the plain corotational law (no fibres, no viscosity, each tet its own volume): the fast path that a cut takes,
/// by the kernels of active_isa(). `stiffness` must be symmetric before. Sizes are the caller's to check.
void add_corotational_response(const TissueModel& model, TissueState& state, std::span<Vec3> forces,
                               BlockMatrix* stiffness, Tangent tangent, Workers& workers);

/// Forces as add_corotational_response; of the tangent of frozen rotations only what changed since the tets of `assembled` were put into
/// `stiffness`, and only in the blocks on and above the diagonal.
void renew_corotational_tangent(const TissueModel& model, TissueState& state, std::span<Vec3> forces, BlockMatrix& stiffness,
                                const AssembledTets& assembled, Workers& workers);

/// Its energy, µJ.
[[nodiscard]] double corotational_energy_uj(const TissueModel& model, const TissueState& state);

}  // namespace incise
