#include "fragments.hpp"

#include <algorithm>

namespace incise {

std::vector<TetId> loose_fragments(const TetMesh& mesh, std::span<const double> volumes_mm3,
                                   std::span<const std::array<std::int32_t, 4>> neighbours,
                                   std::span<const std::uint8_t> is_live, std::span<const std::uint8_t> is_anchored,
                                   std::span<const TetId> changed, double least_mm3) {
  enum class Part : std::uint8_t { Unknown, Visited, Held };
  std::vector<Part> parts(is_live.size(), Part::Unknown);
  std::vector<std::int32_t> part;
  std::vector<TetId> loose;

  // A part that became loose touches what has changed. The search in it ends as soon as it is known to be large or
  // held.
  const auto search = [&](std::int32_t seed) {
    part.assign(1, seed);
    parts[static_cast<std::size_t>(seed)] = Part::Visited;
    double volume = 0.0;
    bool is_held = false;
    for (std::size_t next = 0; next < part.size() && !is_held; ++next) {
      const auto tet = static_cast<std::size_t>(part[next]);
      volume += volumes_mm3[tet];
      is_held = volume >= least_mm3;
      for (const VertexId v : mesh.tets[tet]) is_held = is_held || is_anchored[v.index()] != 0;
      for (const std::int32_t neighbour : neighbours[tet]) {
        if (neighbour < 0 || is_live[static_cast<std::size_t>(neighbour)] == 0) continue;
        Part& known = parts[static_cast<std::size_t>(neighbour)];
        is_held = is_held || known == Part::Held;
        if (known != Part::Unknown) continue;
        known = Part::Visited;
        part.push_back(neighbour);
      }
    }
    for (const std::int32_t tet : part) {
      parts[static_cast<std::size_t>(tet)] = Part::Held;  // of a loose part, too: it is dealt with
      if (!is_held) loose.emplace_back(static_cast<std::size_t>(tet));
    }
  };
  const auto search_from = [&](std::int32_t seed) {
    if (seed >= 0 && is_live[static_cast<std::size_t>(seed)] != 0 &&
        parts[static_cast<std::size_t>(seed)] == Part::Unknown)
      search(seed);
  };
  for (const TetId tet : changed) {
    search_from(tet.value);
    for (const std::int32_t seed : neighbours[tet.index()]) search_from(seed);
  }
  std::sort(loose.begin(), loose.end());
  return loose;
}

}  // namespace incise
