#include "fragments.hpp"

#include <algorithm>
#include <utility>

namespace incise {

FaceAdjacency face_adjacency(const TetMesh& mesh) {
  const std::size_t count = mesh.tets.size();
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
  const auto for_each_pair = [&](const auto& visit) {  // both ways
    for (std::size_t i = 0; i < faces.size(); ++i) {
      for (std::size_t j = i + 1; j < faces.size() && faces[j].first == faces[i].first; ++j) {
        const auto a = static_cast<std::size_t>(faces[i].second), b = static_cast<std::size_t>(faces[j].second);
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

FaceAdjacency split_adjacency(const TetMesh& split, const MeshSplits& splits, const FaceAdjacency& whole) {
  const std::size_t whole_count = whole.start.size() - 1;
  // Per whole tet: its first copy, and per copy the next one of the same tet.
  std::vector<std::int32_t> first(whole_count, -1), next(splits.copies.size(), -1);
  for (std::size_t i = splits.copies.size(); i-- > 0;) {
    std::int32_t& head = first[splits.copies[i].whole.index()];
    next[i] = head;
    head = static_cast<std::int32_t>(i);
  }
  std::vector<std::uint8_t> has_other_corners(whole_count, 0);
  for (const auto* list : {&splits.changed, &splits.copies}) {
    for (const SplitTet& tet : *list) has_other_corners[tet.whole.index()] = 1;
  }
  const auto share_a_face = [&](std::size_t a, std::size_t b) {
    const Tet& other = split.tets[b];
    return std::ranges::count_if(split.tets[a],
                                 [&](VertexId v) { return std::ranges::find(other, v) != other.end(); }) == 3;
  };
  FaceAdjacency adjacency;
  adjacency.start.reserve(split.tets.size() + 1);
  adjacency.tets.reserve(whole.tets.size() + 4 * splits.copies.size());
  adjacency.start.push_back(0);
  for (std::size_t tet = 0; tet < split.tets.size(); ++tet) {
    const std::size_t original = tet < whole_count ? tet : splits.copies[tet - whole_count].whole.index();
    for (const std::int32_t neighbour : whole.of(original)) {
      const auto n = static_cast<std::size_t>(neighbour);
      const bool is_as_before = has_other_corners[original] == 0 && has_other_corners[n] == 0;
      if (is_as_before || share_a_face(tet, n)) adjacency.tets.push_back(neighbour);
      for (std::int32_t copy = first[n]; copy >= 0; copy = next[static_cast<std::size_t>(copy)]) {
        const std::size_t part = whole_count + static_cast<std::size_t>(copy);
        if (share_a_face(tet, part)) adjacency.tets.push_back(static_cast<std::int32_t>(part));
      }
    }
    adjacency.start.push_back(static_cast<std::int32_t>(adjacency.tets.size()));
  }
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

  // A part that became loose contains or borders on a changed tet. Its search ends as soon as it proves large or held.
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
      parts[static_cast<std::size_t>(tet)] = Part::Held;  // also of a loose part, which needs no further search
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
