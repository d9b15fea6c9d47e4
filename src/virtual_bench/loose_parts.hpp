#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace incise {

/// Finds the fragments that a cut has separated from the body.
class LooseParts {
 public:
  /// @param is_held  per vertex: 1 if the holder holds it.
  LooseParts(const TetMesh& mesh, std::vector<std::uint8_t> is_held);
  /// Returns the live tets of face-connected parts next to a tet of `gone` that contain no held vertex and at most 1 %
  /// of all tets; ascending.
  [[nodiscard]] std::vector<std::size_t> beside(std::span<const std::size_t> gone,
                                                std::span<const std::uint8_t> is_live) const;

 private:
  std::vector<Tet> tets_;
  std::vector<std::array<std::int32_t, 4>> neighbours_;  // across each face; -1: none
  std::vector<std::uint8_t> is_held_;
};

}  // namespace incise
