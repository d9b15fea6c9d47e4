#include <incise/core/error.hpp>
#include <incise/geometry/mesh_splits.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace incise {

void require_splits_of(const TetMesh& whole, const MeshSplits& splits) {
  const auto require = [](bool is_one, const char* what, std::int32_t found, std::size_t count) {
    INCISE_REQUIRE(is_one, fmt::format("splits: expected one of {} {}, found {}", count, what, found));
  };
  const std::size_t vertices = whole.vertices.size();
  for (std::size_t i = 0; i < splits.vertices.size(); ++i) {
    const VertexId v = splits.vertices[i];
    require(v.is_valid() && v.index() < vertices + i, "vertices", v.value, vertices + i);
  }
  const std::vector<VertexId> whole_of = whole_vertices(vertices, splits);
  std::map<TetId, double> shares;
  for (const auto* list : {&splits.copies, &splits.changed}) {
    for (const SplitTet& tet : *list) {
      require(tet.whole.is_valid() && tet.whole.index() < whole.tets.size(), "tets", tet.whole.value,
              whole.tets.size());
      INCISE_REQUIRE(tet.share >= 0.0 && tet.share <= 1.0,
                     fmt::format("splits: expected a share of tet {} in [0, 1], found {}", tet.whole.value, tet.share));
      shares[tet.whole] += tet.share;
      for (std::size_t c = 0; c < 4; ++c) {
        const VertexId v = tet.corners[c];
        const std::size_t count = vertices + splits.vertices.size();
        require(v.is_valid() && v.index() < count && whole_of[v.index()] == whole.tets[tet.whole.index()][c],
                "vertices, a copy of the tet's own", v.value, count);
      }
    }
  }
  const auto is_out_of_order = [](const SplitTet& a, const SplitTet& b) { return !(a.whole < b.whole); };
  INCISE_REQUIRE(std::ranges::adjacent_find(splits.changed, is_out_of_order) == splits.changed.end(),
                 "splits: expected changed tets in ascending order, each once");
  for (const SplitTet& copy : splits.copies)
    INCISE_REQUIRE(std::ranges::binary_search(splits.changed, copy.whole, {}, &SplitTet::whole),
                   fmt::format("splits: expected tet {} among the changed ones as it has a copy, found only the copy",
                               copy.whole.value));
  constexpr double kRounding = 1e-9;
  for (const auto& [tet, sum] : shares)
    INCISE_REQUIRE(std::abs(sum - 1.0) <= kRounding,
                   fmt::format("splits: expected shares of tet {} that add up to 1, found {}", tet.value, sum));
}

namespace {

void add_copies(std::map<std::string, DataArray>& data, std::span<const std::size_t> originals) {
  for (auto& [name, array] : data) {
    const auto components = static_cast<std::size_t>(array.components);
    for (const std::size_t original : originals) {
      for (std::size_t k = 0; k < components; ++k) array.values.push_back(array.values[original * components + k]);
    }
  }
}

}  // namespace

TetMesh split_mesh(const TetMesh& whole, const MeshSplits& splits) {
  require_splits_of(whole, splits);
  TetMesh mesh = whole;
  mesh.vertices = split_positions(whole.vertices, splits);
  for (const SplitTet& tet : splits.changed) mesh.tets[tet.whole.index()] = tet.corners;
  std::vector<std::size_t> vertices, tets;
  for (const VertexId v : splits.vertices) vertices.push_back(v.index());
  for (const SplitTet& tet : splits.copies) {
    mesh.tets.push_back(tet.corners);
    tets.push_back(tet.whole.index());
  }
  add_copies(mesh.point_data, vertices);
  add_copies(mesh.cell_data, tets);
  return mesh;
}

Points split_positions(std::span<const Vec3> whole, const MeshSplits& splits) {
  Points positions(whole.begin(), whole.end());
  positions.reserve(whole.size() + splits.vertices.size());
  for (const VertexId v : splits.vertices) positions.push_back(positions[v.index()]);
  return positions;
}

std::vector<VertexId> whole_vertices(std::size_t whole_count, const MeshSplits& splits) {
  std::vector<VertexId> whole;
  whole.reserve(whole_count + splits.vertices.size());
  for (std::size_t v = 0; v < whole_count; ++v) whole.emplace_back(v);
  for (const VertexId v : splits.vertices) whole.push_back(whole[v.index()]);
  return whole;
}

double share_of(const MeshSplits& splits, std::size_t whole_count, TetId tet) {
  if (tet.index() >= whole_count) return splits.copies[tet.index() - whole_count].share;
  const auto at = std::ranges::lower_bound(splits.changed, tet, {}, &SplitTet::whole);
  return at != splits.changed.end() && at->whole == tet ? at->share : 1.0;
}

}  // namespace incise
