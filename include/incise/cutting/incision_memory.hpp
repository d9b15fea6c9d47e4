#pragma once

#include <incise/cutting/cut_settings.hpp>
#include <incise/geometry/tet_mesh.hpp>
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

/// Estimates the same for a cut by points (CutRule::Lattice), bytes: with its points, the split mesh's model and
/// solver, and what measuring the kerf takes. A test checks that it is within 30 % of the measured memory.
/// @param by_tets_bytes  expected_memory_bytes.  @param length_mm  of the path, without overlap.  @param depth_mm  of
/// the tip.
[[nodiscard]] std::uint64_t expected_memory_by_points_bytes(std::uint64_t by_tets_bytes, const TetMesh& mesh,
                                                            double length_mm, double depth_mm, const CutSettings& cut);

}  // namespace incise
