#pragma once

#include <incise/mechanics/material.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>

namespace incise {

/// Estimates the peak memory for stretching and cutting a body, bytes, without the mesh: model, states, matrix, solver
/// and kept frames. Counts the arrays that grow with the body. A test checks that the estimate is within 30 % of the
/// measured memory.
/// @param frames         see IncisionSettings.
/// @param viscous_terms  number of Prony terms; absent: the tissue is not viscous.
[[nodiscard]] std::uint64_t expected_memory_bytes(std::size_t vertices, std::size_t tets, VolumeTreatment volume,
                                                  int frames, std::optional<std::size_t> viscous_terms = {});

}  // namespace incise
