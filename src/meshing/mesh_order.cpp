#include "meshing/mesh_order.hpp"

#include <incise/geometry/disjoint_sets.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace incise::meshing_detail {
namespace {

using Face = std::pair<Triangle, std::size_t>;  ///< sorted corners, tet

std::vector<Face> sorted_faces(const TetMesh& mesh) {
  std::vector<Face> faces;
  faces.reserve(4 * mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Tet corners = mesh.tets[t];
    std::sort(corners.begin(), corners.end());
    for (std::size_t left_out = 0; left_out < 4; ++left_out) {
      Triangle face;
      for (std::size_t c = 0, f = 0; c < 4; ++c) {
        if (c != left_out) face[f++] = corners[c];
      }
      faces.emplace_back(face, t);
    }
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

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
  const std::vector<Face> faces = sorted_faces(mesh);
  for (std::size_t f = 1; f < faces.size(); ++f) {
    if (faces[f].first == faces[f - 1].first) sets.join(faces[f].second, faces[f - 1].second);
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
    const auto at = [&](std::size_t c) -> const Vec3& { return result.vertices[tet[c].index()]; };
    if (signed_volume(at(0), at(1), at(2), at(3)) < 0.0) std::swap(tet[2], tet[3]);
    result.tets.push_back(tet);
  }
  std::sort(result.tets.begin(), result.tets.end());
  return result;
}

}  // namespace incise::meshing_detail
