#pragma once

#include <incise/geometry/tet_mesh.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace incise {

/// Finds what a cut leaves hanging on nothing.
class LooseParts {
 public:
  /// @param is_held  per vertex: held by the holder.
  LooseParts(const TetMesh& mesh, std::vector<std::uint8_t> is_held);
  /// Live tets of parts next to `gone` that share no face with the rest, hold no held vertex and have fewer than 1 % of
  /// all tets; ascending.
  [[nodiscard]] std::vector<std::size_t> beside(std::span<const std::size_t> gone,
                                                std::span<const std::uint8_t> is_live) const;

 private:
  std::vector<Tet> tets_;
  std::vector<std::array<std::int32_t, 4>> neighbours_;  // across each face; -1: none
  std::vector<std::uint8_t> is_held_;
};

}  // namespace incise
