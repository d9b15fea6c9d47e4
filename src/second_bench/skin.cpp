#include "second_bench/body_state.hpp"

#include <incise/second_bench/cut.hpp>

namespace incise::second_bench {
namespace {

/// The highest voxel that is left of a column.
struct Top {
  int piece = -1;
  std::array<int, 3> place{};  // of its brick
  int bit = 0;
  bool is_uncut = true;
};

Top find_top(const BodyState& state, int i, int j, const TissueSpan& span) {
  const BrickGrid& grid = state.tissue.grid;
  Top top;
  for (int k = grid.along(2, span.high_mm); k >= 0; --k)
    for (int c = kVoxelsAcross - 1; c >= 0; --c) {
      top.place = {i / kVoxelsAcross, j / kVoxelsAcross, k};
      top.bit = i % kVoxelsAcross + kVoxelsAcross * (j % kVoxelsAcross) + 16 * c;
      const double z = grid.voxel_mm(top.place, top.bit).z();
      if (z > span.high_mm || z < span.low_mm) continue;
      top.piece = state.tissue.piece_with(grid.brick(top.place[0], top.place[1], k), top.bit);
      if (top.piece >= 0) return top;
      top.is_uncut = false;
    }
  return top;
}

}  // namespace

SeenTissue seen_from_above(const BodyState& state) {
  const BrickTissue& tissue = state.tissue;
  const BrickGrid& grid = tissue.grid;
  SeenTissue seen;
  seen.tumor_edge = tumor_edge_of(state);
  for (int j = 0; j < state.columns_y(); ++j)
    for (int i = 0; i < state.columns_x(); ++i) {
      const auto& span = state.columns[static_cast<std::size_t>(j) * static_cast<std::size_t>(state.columns_x()) +
                                       static_cast<std::size_t>(i)];
      if (!span) continue;
      const Top top = find_top(state, i, j, *span);
      if (top.piece < 0) continue;
      // One square a column, so that skin ends where its last voxel does.
      const Vec3 voxel = grid.size_mm(top.place) / kVoxelsAcross;
      const Vec3 middle = grid.voxel_mm(top.place, top.bit);
      const std::size_t first = seen.vertices.size();
      for (const auto& [a, b] :
           {std::pair{-0.5, -0.5}, std::pair{0.5, -0.5}, std::pair{0.5, 0.5}, std::pair{-0.5, 0.5}}) {
        Vec3 rest = middle + Vec3(a * voxel.x(), b * voxel.y(), 0.5 * voxel.z());
        if (top.is_uncut) {
          const auto there = span_at(state.shape, rest.x(), rest.y());
          rest.z() = there ? there->high_mm : span->high_mm;
        }
        seen.vertices.push_back(tissue.position_of(tissue.rider_on(top.piece, rest)));
        seen.rest.push_back(rest);
      }
      for (const std::size_t n : {1U, 2U}) {
        seen.triangles.push_back({VertexId(first), VertexId(first + n), VertexId(first + n + 1)});
        seen.is_skin.push_back(top.is_uncut ? 1 : 0);
      }
    }
  return seen;
}

}  // namespace incise::second_bench
