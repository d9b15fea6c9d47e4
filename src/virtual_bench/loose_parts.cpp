#include "virtual_bench/loose_parts.hpp"

#include <algorithm>
#include <unordered_set>

namespace incise {

LooseParts::LooseParts(const TetMesh& mesh, std::vector<std::uint8_t> is_held)
    : tets_(mesh.tets), neighbours_(face_neighbours(mesh)), is_held_(std::move(is_held)) {}

std::vector<std::size_t> LooseParts::beside(std::span<const std::size_t> gone,
                                            std::span<const std::uint8_t> is_live) const {
  const std::size_t most = tets_.size() / 100;
  std::vector<std::size_t> loose;
  std::unordered_set<std::int32_t> seen;  // membership only: its order is never used
  for (const std::size_t start : gone) {
    for (const std::int32_t first : neighbours_[start]) {
      if (first < 0 || is_live[static_cast<std::size_t>(first)] == 0 || seen.count(first) != 0) continue;
      std::vector<std::int32_t> part{first};
      std::unordered_set<std::int32_t> in_part{first};
      bool is_loose = true;
      for (std::size_t i = 0; i < part.size() && is_loose; ++i) {
        const auto tet = static_cast<std::size_t>(part[i]);
        for (const VertexId v : tets_[tet]) is_loose = is_loose && is_held_[v.index()] == 0;
        for (const std::int32_t next : neighbours_[tet]) {
          if (next >= 0 && is_live[static_cast<std::size_t>(next)] != 0 && in_part.insert(next).second)
            part.push_back(next);
        }
        is_loose = is_loose && part.size() <= most;
      }
      // A tet visited in a search needs no search of its own, even if the search ended early.
      seen.insert(part.begin(), part.end());
      if (is_loose) loose.insert(loose.end(), part.begin(), part.end());
    }
  }
  std::sort(loose.begin(), loose.end());
  return loose;
}

}  // namespace incise
