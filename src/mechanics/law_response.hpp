#pragma once

#include "mechanics/elastic_response.hpp"

namespace incise {

/// Whether the material is what add_corotational_response computes: corotational, each tet its own volume, no fibres.
[[nodiscard]] bool is_plain_corotational(const TissueModel& model);

/// add_elastic_response for every law, with or without averaged volume and fibres. Sizes are the caller's to check.
void add_law_response(const TissueModel& model, TissueState& state, std::span<Vec3> forces, BlockMatrix* stiffness,
                      Tangent tangent, Workers& workers);

/// Its energy, µJ.
[[nodiscard]] double law_energy_uj(const TissueModel& model, const TissueState& state);

/// First Piola stress of every live tet, kPa (0 for carved ones).
[[nodiscard]] std::vector<Mat3> law_stresses_kpa(const TissueModel& model, const TissueState& state);

}  // namespace incise
