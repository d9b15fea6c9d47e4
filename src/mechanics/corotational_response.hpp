#pragma once

#include "mechanics/elastic_response.hpp"

namespace incise {

/// add_elastic_response for the plain corotational law (no fibres, no viscosity, each tet its own volume): the fast path that a cut takes,
/// by the kernels of active_isa(). `stiffness` must be symmetric before. Sizes are the caller's to check.
void add_corotational_response(const TissueModel& model, TissueState& state, std::span<Vec3> forces,
                               BlockMatrix* stiffness, Tangent tangent, Workers& workers);

/// Its energy, µJ.
[[nodiscard]] double corotational_energy_uj(const TissueModel& model, const TissueState& state);

}  // namespace incise
