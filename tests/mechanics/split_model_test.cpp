#include "mechanics/bodies.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <vector>

namespace incise {
namespace {

using testing::elastic_forces;
using testing::irregular_block;
using testing::plane_x;

/// A block on a plane, with weight, held at one end.
TissueModel whole_block(VolumeTreatment volume) {
  Material material{.poissons_ratio = 0.45};
  material.volume = volume;
  return make_tissue_model(irregular_block(Vec3(8, 6, 6), {4, 3, 3}, 0.2, 3), material,
                           {FixedConstraint{plane_x(0.0)}, SupportConstraint{}}, Vec3(0, 0, -9810.0));
}

/// Every tet beyond x = 4 leaves that plane's vertices, and the first that has all its corners there comes in two parts.
MeshSplits splits_at_middle(const TetMesh& mesh, std::optional<TetId>& in_two) {
  MeshSplits splits;
  std::map<VertexId, VertexId> copies;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (std::abs(mesh.vertices[v].x() - 4.0) > 0.5) continue;
    copies[VertexId(v)] = VertexId(mesh.vertices.size() + splits.vertices.size());
    splits.vertices.emplace_back(v);
  }
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    double x = 0.0;
    for (const VertexId v : mesh.tets[t]) x += 0.25 * vertex(mesh.vertices, v).x();
    Tet beyond = mesh.tets[t];
    for (VertexId& v : beyond) v = copies.contains(v) ? copies.at(v) : v;
    if (x < 4.0 || beyond == mesh.tets[t]) continue;
    splits.changed.push_back({TetId(t), beyond, 1.0});
    if (in_two) continue;
    in_two = TetId(t);
    splits.changed.back().share = 0.6;
    splits.copies.push_back({TetId(t), mesh.tets[t], 0.4});
  }
  return splits;
}

class SplitModel : public ::testing::TestWithParam<VolumeTreatment> {};

TEST_P(SplitModel, AddsUpToTheWholeWhereCopiesMoveTogether) {
  const TissueModel whole = whole_block(GetParam());
  std::optional<TetId> in_two;
  const MeshSplits splits = splits_at_middle(whole.mesh, in_two);
  ASSERT_TRUE(in_two);
  ASSERT_GT(splits.changed.size(), 10U);
  const TissueModel split = split_model(whole, splits);
  TissueState state = testing::shaken(whole, 0.2, 5);
  TissueState parted = rest_state(split);
  parted.positions = split_positions(state.positions, splits);
  parted.fill.assign(split.mesh.tets.size(), 1.0);
  parted.fill[in_two->index()] = 0.6;
  parted.fill.back() = 0.4;

  const std::vector<VertexId> original = whole_vertices(whole.mesh.vertices.size(), splits);
  const auto gathered = [&](const auto& values) {
    auto sums = values;
    sums.resize(whole.mesh.vertices.size());
    for (std::size_t v = sums.size(); v < values.size(); ++v) sums[original[v].index()] += values[v];
    return sums;
  };
  const Points forces = elastic_forces(whole, state);
  const Points split_forces = elastic_forces(split, parted);
  // Averages over a vertex are those of its own side.
  if (GetParam() == VolumeTreatment::PerTet) {
    const Points sums = gathered(split_forces);
    for (std::size_t v = 0; v < forces.size(); ++v)
      EXPECT_LT((sums[v] - forces[v]).norm(), 1e-9 * (1.0 + forces[v].norm())) << v;
  }
  const std::vector<double> masses = gathered(split.vertex_mass_kg);
  const Points loads = gathered(split.dead_load_mn);
  for (std::size_t v = 0; v < masses.size(); ++v) {
    EXPECT_NEAR(masses[v], whole.vertex_mass_kg[v], 1e-12 * whole.vertex_mass_kg[v]);
    EXPECT_LT((loads[v] - whole.dead_load_mn[v]).norm(), 1e-12 * whole.dead_load_mn[v].norm());
  }
  for (std::size_t v = 0; v < split.vertex_mass_kg.size(); ++v) {
    EXPECT_GT(split.vertex_mass_kg[v], 0.0) << "each copy has tissue of its own";
    EXPECT_NEAR(split.dead_load_mn[v].z(), -9810.0 * split.vertex_mass_kg[v], 1e-9 * std::abs(split.dead_load_mn[v].z()));
  }
  ASSERT_EQ(split.supports.size(), 1U);
  const auto sum = [](const std::vector<double>& x) { return std::accumulate(x.begin(), x.end(), 0.0); };
  EXPECT_NEAR(sum(split.supports[0].stiffness), sum(whole.supports[0].stiffness),
              1e-9 * sum(whole.supports[0].stiffness));
  EXPECT_GT(split.supports[0].vertices.size(), whole.supports[0].vertices.size());
}
/// Its rows are taken from the whole one where nothing is split.
TEST_P(SplitModel, HasThePatternAndTheSlotsOfItsMesh) {
  const TissueModel whole = whole_block(GetParam());
  std::optional<TetId> in_two;
  const TissueModel split = split_model(whole, splits_at_middle(whole.mesh, in_two));
  std::vector<std::set<std::int32_t>> stars(split.mesh.vertices.size());
  for (const Tet& tet : split.mesh.tets) {
    for (const VertexId v : tet) {
      for (const VertexId w : tet) stars[v.index()].insert(w.value);
    }
  }
  std::vector<std::set<std::int32_t>> rows = stars;
  for (std::size_t v = 0; GetParam() == VolumeTreatment::Averaged && v < rows.size(); ++v) {
    for (const std::int32_t w : stars[v])
      rows[v].insert(stars[static_cast<std::size_t>(w)].begin(), stars[static_cast<std::size_t>(w)].end());
  }
  const BlockPattern& pattern = *split.pattern;
  ASSERT_EQ(pattern.rows(), rows.size());
  for (std::size_t v = 0; v < rows.size(); ++v) {
    const std::vector<std::int32_t> found(pattern.column.begin() + pattern.row_start[v],
                                          pattern.column.begin() + pattern.row_start[v + 1]);
    EXPECT_EQ(found, std::vector(rows[v].begin(), rows[v].end())) << v;
    EXPECT_EQ(pattern.column[static_cast<std::size_t>(pattern.diagonal[v])], static_cast<std::int32_t>(v));
  }
  for (std::size_t t = 0; t < split.mesh.tets.size(); ++t) {
    for (std::size_t a = 0; a < 4; ++a) {
      const std::size_t row = split.mesh.tets[t][a].index();
      for (std::size_t b = 0; b < 4; ++b) {
        const std::int32_t slot = split.tet_slots[t][4 * a + b];
        EXPECT_TRUE(slot >= pattern.row_start[row] && slot < pattern.row_start[row + 1]);
        EXPECT_EQ(pattern.column[static_cast<std::size_t>(slot)], split.mesh.tets[t][b].value);
      }
    }
  }
}

/// Copies stand in the runs of their originals.
TEST(SplitModel, HasTheSameForcesAtAnyThreadCountAndInAllThoseOfTheWhole) {
  const TissueModel whole = make_tissue_model(make_block({10, 10, 10}, {9, 9, 9}), Material{},
                                              {FixedConstraint{plane_x(0.0)}});  // of several runs
  MeshSplits splits;
  for (std::size_t t = 0; t < whole.mesh.tets.size(); t += 7) {  // in two, the second with a corner of its own
    Tet corners = whole.mesh.tets[t];
    corners[0] = VertexId(whole.mesh.vertices.size() + splits.vertices.size());
    splits.vertices.push_back(whole.mesh.tets[t][0]);
    splits.copies.push_back({TetId(t), corners, 0.5});
    splits.changed.push_back({TetId(t), whole.mesh.tets[t], 0.5});
  }
  const TissueModel split = split_model(whole, splits);
  TissueState of_whole = testing::shaken(whole, 0.1, 5), state = rest_state(split);
  state.positions = split_positions(of_whole.positions, splits);
  state.fill.assign(split.mesh.tets.size(), 1.0);
  for (std::size_t i = 0; i < splits.copies.size(); ++i)
    state.fill[splits.copies[i].whole.index()] = state.fill[whole.mesh.tets.size() + i] = 0.5;
  const auto forces = [&](int threads) {
    Points sums(split.mesh.vertices.size(), Vec3::Zero());
    Workers workers(threads);
    TissueState begun = state;
    add_elastic_response(split, begun, sums, nullptr, workers);
    return sums;
  };
  Points sums = forces(1);
  EXPECT_EQ(forces(4), sums);
  for (std::size_t i = 0; i < splits.vertices.size(); ++i)
    sums[splits.vertices[i].index()] += sums[whole.mesh.vertices.size() + i];
  const Points expected = elastic_forces(whole, of_whole);
  for (std::size_t v = 0; v < expected.size(); ++v)
    EXPECT_LT((sums[v] - expected[v]).norm(), 1e-9 * (1.0 + expected[v].norm())) << v;
}
INSTANTIATE_TEST_SUITE_P(Volumes, SplitModel, ::testing::Values(VolumeTreatment::PerTet, VolumeTreatment::Averaged));

TEST(SplitModel, WithoutSplitsIsTheModel) {
  const TissueModel whole = whole_block(VolumeTreatment::PerTet);
  const TissueModel same = split_model(whole, {});
  EXPECT_EQ(same.vertex_mass_kg, whole.vertex_mass_kg);
  EXPECT_EQ(same.dead_load_mn, whole.dead_load_mn);
  EXPECT_EQ(same.tet_slots, whole.tet_slots);
}

}  // namespace
}  // namespace incise
