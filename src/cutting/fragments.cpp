#include "fragments.hpp"

#include <algorithm>
#include <utility>

namespace incise {

FaceAdjacency face_adjacency(const TetMesh& mesh, std::span<const SplitTet> copies) {
  const std::size_t count = mesh.tets.size(), whole = count - copies.size();
  std::vector<std::pair<Triangle, std::int32_t>> faces;  // sorted vertices, tet
  faces.reserve(4 * count);
  for (std::size_t t = 0; t < count; ++t) {
    for (int f = 0; f < 4; ++f) {
      Triangle face = face_of(mesh.tets[t], f);
      std::ranges::sort(face);
      faces.emplace_back(face, static_cast<std::int32_t>(t));
    }
  }
  std::ranges::sort(faces);
  const auto whole_of = [&](std::size_t t) { return t < whole ? TetId(t) : copies[t - whole].whole; };
  const auto for_each_pair = [&](const auto& visit) {  // both ways
    for (std::size_t i = 0; i < faces.size(); ++i) {
      for (std::size_t j = i + 1; j < faces.size() && faces[j].first == faces[i].first; ++j) {
        const auto a = static_cast<std::size_t>(faces[i].second), b = static_cast<std::size_t>(faces[j].second);
        if (whole_of(a) == whole_of(b)) continue;
        visit(a, b);
        visit(b, a);
      }
    }
  };
  FaceAdjacency adjacency{std::vector<std::int32_t>(count + 1, 0), {}};
  for_each_pair([&](std::size_t tet, std::size_t) { ++adjacency.start[tet + 1]; });
  for (std::size_t t = 0; t < count; ++t) adjacency.start[t + 1] += adjacency.start[t];
  adjacency.tets.resize(static_cast<std::size_t>(adjacency.start[count]));
  std::vector<std::int32_t> next(adjacency.start.begin(), adjacency.start.end() - 1);
  for_each_pair([&](std::size_t tet, std::size_t neighbour) {
    adjacency.tets[static_cast<std::size_t>(next[tet]++)] = static_cast<std::int32_t>(neighbour);
  });
  return adjacency;
}

std::vector<TetId> loose_fragments(const TetMesh& mesh, std::span<const double> volumes_mm3,
                                   const FaceAdjacency& neighbours, std::span<const std::uint8_t> is_live,
                                   std::span<const std::uint8_t> is_anchored, std::span<const TetId> changed,
                                   double least_mm3) {
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
      for (const std::int32_t neighbour : neighbours.of(tet)) {
        if (is_live[static_cast<std::size_t>(neighbour)] == 0) continue;
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
    if (is_live[static_cast<std::size_t>(seed)] != 0 && parts[static_cast<std::size_t>(seed)] == Part::Unknown)
      search(seed);
  };
  for (const TetId tet : changed) {
    search_from(tet.value);
    for (const std::int32_t seed : neighbours.of(tet.index())) search_from(seed);
  }
  std::sort(loose.begin(), loose.end());
  return loose;
}

}  // namespace incise
