#pragma once

#include "mechanics/elastic_response.hpp"

namespace incise {

/// Whether add_corotational_response covers the material: corotational, volume per tet, no fibres.
[[nodiscard]] bool is_plain_corotational(const TissueModel& model);

/// add_elastic_response for every law, with or without averaged volume and fibres. @pre the caller has checked all
/// sizes.  @throws InvalidArgument for a matrix of another pattern.
void add_law_response(const TissueModel& model, TissueState& state, std::span<Vec3> forces, BlockMatrix* stiffness,
                      Tangent tangent, Workers& workers);

/// Returns the energy of any law, µJ.
[[nodiscard]] double law_energy_uj(const TissueModel& model, const TissueState& state);

/// Returns the first Piola stress of each tet, kPa; 0 for carved ones.
[[nodiscard]] std::vector<Mat3> law_stresses_kpa(const TissueModel& model, const TissueState& state);

}  // namespace incise
