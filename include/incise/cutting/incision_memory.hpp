#pragma once

#include <incise/cutting/cut_settings.hpp>
#include <incise/mechanics/material.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace incise {

/// Estimates the peak memory for stretching and cutting a body, bytes, without the mesh: model, states, matrix, solver
/// and kept frames. Counts the arrays that grow with the body. A test checks that the estimate is within 30 % of the
/// measured memory.
/// @param frames         see IncisionSettings.
/// @param viscous_terms  number of Prony terms; absent: the tissue is not viscous.
[[nodiscard]] std::uint64_t expected_memory_bytes(std::size_t vertices, std::size_t tets, VolumeTreatment volume,
                                                  int frames, std::optional<std::size_t> viscous_terms = {});

/// Estimates the memory that a cut by points (CutRule::Lattice) takes beyond expected_memory_bytes, bytes: its points,
/// the split mesh's model and solver, and what measuring the kerf takes. A test checks that the sum is within 30 % of
/// the measured memory.
/// @param model_bytes  expected_memory_bytes without frames.
/// @param volumes_mm3  of the tets, each above 0.
/// @param length_mm    of the path, without overlap, >= 0.
/// @param depth_mm     of the tip, >= 0.
/// @param cut          its kernel_radius_mm counts.
[[nodiscard]] std::uint64_t expected_point_memory_bytes(std::uint64_t model_bytes, std::vector<double> volumes_mm3,
                                                        double length_mm, double depth_mm, const CutSettings& cut);

}  // namespace incise
