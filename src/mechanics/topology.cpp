#include "mechanics/topology.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

namespace incise {
namespace {

void list_tets_of_vertices(TissueModel& model) {
  const std::size_t count = model.mesh.vertices.size();
  model.vertex_tet_start.assign(count + 1, 0);
  for (const Tet& tet : model.mesh.tets) {
    for (const VertexId v : tet) ++model.vertex_tet_start[v.index() + 1];
  }
  for (std::size_t v = 0; v < count; ++v) model.vertex_tet_start[v + 1] += model.vertex_tet_start[v];
  model.vertex_tets.resize(4 * model.mesh.tets.size());
  std::vector<std::int32_t> next(model.vertex_tet_start.begin(), model.vertex_tet_start.end() - 1);
  for (std::size_t t = 0; t < model.mesh.tets.size(); ++t) {
    for (std::size_t c = 0; c < 4; ++c) {
      auto& slot = next[model.mesh.tets[t][c].index()];
      model.vertex_tets[static_cast<std::size_t>(slot++)] = static_cast<std::int32_t>(4 * t + c);
    }
  }
}

/// A pattern to copy rows from, and the vertices whose rows must be built.
struct KnownRows {
  const BlockPattern& pattern;
  const std::vector<std::uint8_t>& is_new;
};

/// Builds the pattern whose row v contains v and everything that `list_neighbours(v, list)` appends, in any order.
template <class ListNeighbours>
std::shared_ptr<const BlockPattern> make_pattern(std::size_t count, const ListNeighbours& list_neighbours,
                                                 const KnownRows* known = nullptr) {
  auto pattern = std::make_shared<BlockPattern>();
  pattern->row_start.reserve(count + 1);
  pattern->diagonal.reserve(count);
  if (known != nullptr) pattern->column.reserve(known->pattern.column.size() + known->pattern.column.size() / 16);
  pattern->row_start.push_back(0);
  std::vector<std::int32_t> neighbours;
  for (std::size_t v = 0; v < count; ++v) {
    if (known != nullptr && known->is_new[v] == 0) {
      const auto row = known->pattern.columns_of(v);
      pattern->diagonal.push_back(pattern->row_start.back() + known->pattern.diagonal[v] - known->pattern.row_start[v]);
      pattern->column.insert(pattern->column.end(), row.begin(), row.end());
      pattern->row_start.push_back(static_cast<std::int32_t>(pattern->column.size()));
      continue;
    }
    neighbours.assign(1, static_cast<std::int32_t>(v));  // the diagonal exists even for a vertex without a tet
    list_neighbours(v, neighbours);
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    const auto self = std::lower_bound(neighbours.begin(), neighbours.end(), static_cast<std::int32_t>(v));
    pattern->diagonal.push_back(pattern->row_start.back() + static_cast<std::int32_t>(self - neighbours.begin()));
    pattern->column.insert(pattern->column.end(), neighbours.begin(), neighbours.end());
    pattern->row_start.push_back(static_cast<std::int32_t>(pattern->column.size()));
  }
  return pattern;
}

std::shared_ptr<const BlockPattern> make_stars(const TissueModel& model, const KnownRows* known = nullptr) {
  const auto list_star = [&](std::size_t v, std::vector<std::int32_t>& neighbours) {
    for (const std::int32_t entry : model.corners_at(v)) {
      for (const VertexId w : model.mesh.tets[static_cast<std::size_t>(entry / 4)]) neighbours.push_back(w.value);
    }
  };
  return make_pattern(model.mesh.vertices.size(), list_star, known);
}

std::shared_ptr<const BlockPattern> make_stars_of_stars(const BlockPattern& stars) {
  return make_pattern(stars.rows(), [&](std::size_t v, std::vector<std::int32_t>& neighbours) {
    for (const std::int32_t w : stars.columns_of(v)) {
      const auto star = stars.columns_of(static_cast<std::size_t>(w));
      neighbours.insert(neighbours.end(), star.begin(), star.end());
    }
  });
}

/// Finds the slots of the blocks (a, b) of a tet for one corner a; they lie in the row of that corner.
void find_slots(TissueModel& model, std::size_t tet, std::size_t a) {
  const std::size_t row = model.mesh.tets[tet][a].index();
  const auto columns = model.pattern->columns_of(row);
  for (std::size_t b = 0; b < 4; ++b) {
    const auto at = std::ranges::lower_bound(columns, model.mesh.tets[tet][b].value);
    model.tet_slots[tet][4 * a + b] = model.pattern->row_start[row] + static_cast<std::int32_t>(at - columns.begin());
  }
}

std::shared_ptr<const BlockPattern> pattern_for(const TissueModel& model) {
  return model.material.volume == VolumeTreatment::Averaged ? make_stars_of_stars(*model.stars) : model.stars;
}

}  // namespace

void add_topology(TissueModel& model) {
  list_tets_of_vertices(model);
  model.stars = make_stars(model);
  model.pattern = pattern_for(model);
  model.tet_slots.resize(model.mesh.tets.size());
  for (std::size_t t = 0; t < model.mesh.tets.size(); ++t) {
    for (std::size_t a = 0; a < 4; ++a) find_slots(model, t, a);
  }
}

void add_split_topology(TissueModel& model, const TissueModel& whole, const MeshSplits& splits) {
  list_tets_of_vertices(model);
  std::vector<std::uint8_t> is_new(model.mesh.vertices.size(), 0);
  std::fill(is_new.begin() + static_cast<std::ptrdiff_t>(whole.mesh.vertices.size()), is_new.end(), std::uint8_t{1});
  for (const auto* list : {&splits.changed, &splits.copies}) {
    for (const SplitTet& tet : *list) {
      for (const VertexId v : tet.corners) is_new[v.index()] = 1;
      for (const VertexId v : whole.mesh.tets[tet.whole.index()]) is_new[v.index()] = 1;
    }
  }
  const KnownRows stars{*whole.stars, is_new};
  model.stars = make_stars(model, &stars);
  model.pattern = pattern_for(model);
  const bool keeps_rows = model.pattern == model.stars;  // otherwise rows farther from the splits differ too
  model.tet_slots.resize(model.mesh.tets.size());
  for (std::size_t t = 0; t < model.mesh.tets.size(); ++t) {
    for (std::size_t a = 0; a < 4; ++a) {
      const std::size_t row = model.mesh.tets[t][a].index();
      if (!keeps_rows || is_new[row] != 0) {
        find_slots(model, t, a);
        continue;
      }
      const std::int32_t moved = model.pattern->row_start[row] - whole.pattern->row_start[row];
      for (std::size_t b = 0; b < 4; ++b) model.tet_slots[t][4 * a + b] = whole.tet_slots[t][4 * a + b] + moved;
    }
  }
}

}  // namespace incise
