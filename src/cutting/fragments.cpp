#include "fragments.hpp"

#include <algorithm>

namespace incise {

std::vector<std::array<std::int32_t, 4>> face_neighbours(const TetMesh& mesh) {
  struct Face {
    std::array<std::int32_t, 3> key;
    std::int32_t tet;
    std::int32_t face;
  };
  std::vector<Face> faces;
  faces.reserve(4 * mesh.tets.size());
  for (std::size_t tet = 0; tet < mesh.tets.size(); ++tet) {
    for (int face = 0; face < 4; ++face) {
      const Triangle corners = face_of(mesh.tets[tet], face);
      std::array<std::int32_t, 3> key{corners[0].value, corners[1].value, corners[2].value};
      std::sort(key.begin(), key.end());
      faces.push_back({key, static_cast<std::int32_t>(tet), face});
    }
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
    return a.key != b.key ? a.key < b.key : a.tet < b.tet;
  });
  std::vector<std::array<std::int32_t, 4>> neighbours(mesh.tets.size(), {-1, -1, -1, -1});
  for (std::size_t i = 0; i + 1 < faces.size(); ++i) {
    const Face& a = faces[i];
    const Face& b = faces[i + 1];
    if (a.key != b.key) continue;
    neighbours[static_cast<std::size_t>(a.tet)][static_cast<std::size_t>(a.face)] = b.tet;
    neighbours[static_cast<std::size_t>(b.tet)][static_cast<std::size_t>(b.face)] = a.tet;
  }
  return neighbours;
}

std::vector<TetId> loose_fragments(const TetMesh& mesh, std::span<const std::array<std::int32_t, 4>> neighbours,
                                   std::span<const std::uint8_t> is_live, std::span<const std::uint8_t> is_anchored,
                                   double share) {
  const std::size_t count = mesh.tets.size();
  std::vector<std::uint8_t> is_seen(count, 0);
  std::vector<std::int32_t> part;
  std::vector<TetId> loose;
  std::size_t live = 0;
  for (const std::uint8_t flag : is_live) live += flag;

  for (std::size_t seed = 0; seed < count; ++seed) {
    if (is_live[seed] == 0 || is_seen[seed] != 0) continue;
    part.assign(1, static_cast<std::int32_t>(seed));
    is_seen[seed] = 1;
    bool touches_anchor = false;
    for (std::size_t next = 0; next < part.size(); ++next) {
      const auto tet = static_cast<std::size_t>(part[next]);
      for (const VertexId v : mesh.tets[tet]) touches_anchor = touches_anchor || is_anchored[v.index()] != 0;
      for (const std::int32_t neighbour : neighbours[tet]) {
        if (neighbour < 0 || is_live[static_cast<std::size_t>(neighbour)] == 0) continue;
        if (is_seen[static_cast<std::size_t>(neighbour)] != 0) continue;
        is_seen[static_cast<std::size_t>(neighbour)] = 1;
        part.push_back(neighbour);
      }
    }
    if (touches_anchor || static_cast<double>(part.size()) >= share * static_cast<double>(live)) continue;
    for (const std::int32_t tet : part) loose.emplace_back(static_cast<std::size_t>(tet));
  }
  std::sort(loose.begin(), loose.end());
  return loose;
}

}  // namespace incise
