#pragma once

#include <incise/mechanics/material.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>

namespace incise {

/// Memory that stretching a body and cutting it takes at most, bytes, beside the mesh that is there already: model,
/// states, matrix, solver and the frames that are kept. Counted from the arrays that grow with the body; a test holds
/// it to 30 % of what a cut was seen to take.
/// @param viscous_terms  Prony terms; absent: the tissue is not viscous. @param frames  see IncisionSettings.
[[nodiscard]] std::uint64_t expected_memory_bytes(std::size_t vertices, std::size_t tets, VolumeTreatment volume,
                                                  int frames, std::optional<std::size_t> viscous_terms = {});

}  // namespace incise
