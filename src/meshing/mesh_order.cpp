#include "meshing/mesh_order.hpp"

#include <incise/geometry/disjoint_sets.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace incise::meshing_detail {
namespace {

/// Inserts two zeros before each of the 21 lowest bits.
std::uint64_t spread_bits(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x1f00000000ffffULL;
  v = (v | v << 16) & 0x1f0000ff0000ffULL;
  v = (v | v << 8) & 0x100f00f00f00f00fULL;
  v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
  v = (v | v << 2) & 0x1249249249249249ULL;
  return v;
}

std::uint64_t morton_code(const Vec3& p, const Box3& box) {
  constexpr double kCells = 2097151.0;  // 2^21 - 1
  const double extent = std::max(box.sizes().maxCoeff(), 1e-300);
  const Vec3 scaled = (p - box.min()) * (kCells / extent);
  return spread_bits(static_cast<std::uint64_t>(scaled.x())) |
         spread_bits(static_cast<std::uint64_t>(scaled.y())) << 1 |
         spread_bits(static_cast<std::uint64_t>(scaled.z())) << 2;
}

/// Returns the used vertices in Morton order; ties (vertices closer than the code resolves) in order of coordinates.
std::vector<std::size_t> ordered_vertices(const TetMesh& mesh) {
  std::vector<std::uint8_t> is_used(mesh.vertices.size(), 0);
  Box3 box;
  for (const Tet& tet : mesh.tets) {
    for (const VertexId id : tet) {
      is_used[id.index()] = 1;
      box.extend(mesh.vertices[id.index()]);
    }
  }
  std::vector<std::pair<std::uint64_t, std::size_t>> keys;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (is_used[v] != 0) keys.emplace_back(morton_code(mesh.vertices[v], box), v);
  }
  std::sort(keys.begin(), keys.end(), [&mesh](const auto& a, const auto& b) {
    if (a.first != b.first) return a.first < b.first;
    const Vec3& p = mesh.vertices[a.second];
    const Vec3& q = mesh.vertices[b.second];
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  });
  std::vector<std::size_t> order;
  for (const auto& [code, v] : keys) order.push_back(v);
  return order;
}

}  // namespace

TetMesh largest_component(TetMesh mesh, std::size_t& dropped) {
  dropped = 0;
  DisjointSets sets(mesh.tets.size());
  const std::vector<std::array<std::int32_t, 4>> neighbours = face_neighbours(mesh);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (const std::int32_t other : neighbours[t]) {
      if (other >= 0) sets.join(t, static_cast<std::size_t>(other));
    }
  }
  std::vector<std::size_t> size(mesh.tets.size(), 0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) ++size[sets.root(t)];
  const auto largest = static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());

  std::vector<Tet> kept;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (sets.root(t) == largest) kept.push_back(mesh.tets[t]);
  }
  dropped = mesh.tets.size() - kept.size();
  mesh.tets = std::move(kept);
  return mesh;
}

TetMesh in_canonical_order(const TetMesh& mesh) {
  const std::vector<std::size_t> order = ordered_vertices(mesh);
  TetMesh result;
  std::vector<VertexId> new_id(mesh.vertices.size());
  for (const std::size_t old : order) {
    new_id[old] = VertexId(result.vertices.size());
    result.vertices.push_back(mesh.vertices[old]);
  }
  for (const Tet& old : mesh.tets) {
    Tet tet;
    for (std::size_t c = 0; c < 4; ++c) tet[c] = new_id[old[c].index()];
    std::sort(tet.begin(), tet.end());
    const auto [p, q, r, s] = corners_of(result.vertices, tet);
    if (signed_volume(p, q, r, s) < 0.0) std::swap(tet[2], tet[3]);
    result.tets.push_back(tet);
  }
  std::sort(result.tets.begin(), result.tets.end());
  return result;
}

}  // namespace incise::meshing_detail
