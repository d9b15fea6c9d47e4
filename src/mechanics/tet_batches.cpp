#include "mechanics/tet_batches.hpp"

#include "mechanics/aggregates.hpp"
#include "mechanics/chunks.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
#include <vector>

namespace incise {
namespace {

constexpr std::size_t kTetsPerRun = 504;  // 63 batches: about 50 µs of work, and few vertices shared with other runs

/// Groups tets that lie close together into runs of nearly kTetsPerRun.
Aggregates group_tets(const TissueModel& model) {
  Points centroids(model.mesh.tets.size());
  for (std::size_t t = 0; t < centroids.size(); ++t) {
    Vec3 sum = Vec3::Zero();
    for (const VertexId v : model.mesh.tets[t]) sum += model.mesh.vertices[v.index()];
    centroids[t] = 0.25 * sum;
  }
  return bisect(centroids, kTetsPerRun);
}

/// Gives each run in turn the first colour that no run with a common vertex has.
std::vector<int> color_runs(const TissueModel& model, const Aggregates& runs) {
  std::vector<int> color(runs.count(), -1);
  std::vector<char> is_taken;
  for (std::size_t run = 0; run < runs.count(); ++run) {
    is_taken.assign(is_taken.size(), 0);
    for (const std::int32_t tet : runs.members(run)) {
      for (const VertexId v : model.mesh.tets[static_cast<std::size_t>(tet)]) {
        for (const std::int32_t other : model.corners_at(v.index())) {
          const int taken = color[static_cast<std::size_t>(runs.of_vertex[static_cast<std::size_t>(other / 4)])];
          if (taken >= 0) is_taken[static_cast<std::size_t>(taken)] = 1;
        }
      }
    }
    const auto free = std::find(is_taken.begin(), is_taken.end(), 0);
    color[run] = static_cast<int>(free - is_taken.begin());
    if (free == is_taken.end()) is_taken.push_back(0);
  }
  return color;
}

void put_tet(const TissueModel& model, std::size_t tet, TetBatch& batch, std::size_t lane) {
  const Tet& corners = model.mesh.tets[tet];
  std::array<std::size_t, 4> order{0, 1, 2, 3};
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return corners[a].index() < corners[b].index(); });
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < 3; ++i) {
      batch.gradients[c][i][lane] = model.gradients[tet][order[c + 1]][static_cast<Eigen::Index>(i)];
    }
  }
  batch.lambda[lane] = model.volumes_mm3[tet] * model.lame[tet].lambda_kpa;
  batch.mu[lane] = model.volumes_mm3[tet] * model.lame[tet].mu_kpa;
  std::size_t pair = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    batch.vertices[a][lane] = corners[order[a]].value;
    for (std::size_t b = a; b < 4; ++b) batch.slots[pair++][lane] = model.tet_slots[tet][4 * order[a] + order[b]];
  }
  batch.tets[lane] = static_cast<std::int32_t>(tet);
}

/// Appends a run. Neighbours go to one lane of successive batches, not to the lanes of one batch: those add to blocks
/// one right after another, and a block that two of them share would have to wait for its last store.
void add_run(const TissueModel& model, std::span<const std::int32_t> tets, TetBatches& result) {
  const std::size_t first = result.batches.size();
  const std::size_t count = (tets.size() + kBatchTets - 1) / kBatchTets;
  TetBatch empty{};
  std::fill(std::begin(empty.tets), std::end(empty.tets), -1);
  result.batches.resize(first + count, empty);
  for (std::size_t i = 0; i < tets.size(); ++i) {
    put_tet(model, static_cast<std::size_t>(tets[i]), result.batches[first + i % count], i / count);
  }
  result.run_start.push_back(static_cast<std::int32_t>(result.batches.size()));
}

using Run = std::vector<std::int32_t>;  // tets

/// @param runs  sorted by colour.  @param color_start  colours + 1, into the runs.
std::shared_ptr<const TetBatches> batches_of(const TissueModel& model, const std::vector<Run>& runs,
                                             std::vector<std::int32_t> color_start) {
  auto result = std::make_shared<TetBatches>();
  result->batches.reserve(model.mesh.tets.size() / kBatchTets + runs.size());
  result->run_start.push_back(0);
  for (const Run& run : runs) add_run(model, run, *result);
  result->color_start = std::move(color_start);
  result->mirror = transposed_slots(*model.pattern);
  return result;
}

}  // namespace

std::vector<std::int32_t> transposed_slots(const BlockPattern& pattern) {
  std::vector<std::int32_t> mirror(pattern.blocks());
  std::vector<std::int32_t> next(pattern.row_start.begin(), pattern.row_start.end() - 1);
  // Rows ascend, so the blocks of a column are visited in the order in which the row of the same number lists them.
  for (std::size_t row = 0; row < pattern.rows(); ++row) {
    for (auto slot = pattern.row_start[row]; slot < pattern.row_start[row + 1]; ++slot) {
      const std::int32_t column = pattern.column[static_cast<std::size_t>(slot)];
      mirror[static_cast<std::size_t>(slot)] = next[static_cast<std::size_t>(column)]++;
    }
  }
  return mirror;
}

std::shared_ptr<const TetBatches> make_tet_batches(const TissueModel& model) {
  const Aggregates groups = group_tets(model);
  const std::vector<int> color = color_runs(model, groups);
  std::vector<std::size_t> order(groups.count());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return color[a] < color[b]; });
  std::vector<Run> runs;
  std::vector<std::int32_t> color_start;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || color[order[i]] != color[order[i - 1]]) color_start.push_back(static_cast<std::int32_t>(i));
    const auto tets = groups.members(order[i]);
    runs.emplace_back(tets.begin(), tets.end());
  }
  color_start.push_back(static_cast<std::int32_t>(runs.size()));
  return batches_of(model, runs, std::move(color_start));
}

std::shared_ptr<const TetBatches> make_split_batches(const TissueModel& model, const TissueModel& whole,
                                                     const MeshSplits& splits) {
  const TetBatches& before = *whole.batches;
  const std::size_t whole_tets = whole.mesh.tets.size();
  std::vector<Run> runs(before.runs());
  std::vector<std::size_t> run_of(whole_tets);
  for (std::size_t run = 0; run < runs.size(); ++run) {
    const auto first = static_cast<std::size_t>(before.run_start[run]);
    const auto last = static_cast<std::size_t>(before.run_start[run + 1]);
    for (std::size_t lane = 0; lane < kBatchTets; ++lane) {  // the order of add_run
      for (std::size_t batch = first; batch < last; ++batch) {
        const std::int32_t tet = before.batches[batch].tets[lane];
        if (tet < 0) continue;
        runs[run].push_back(tet);
        run_of[static_cast<std::size_t>(tet)] = run;
      }
    }
  }
  for (std::size_t i = 0; i < splits.copies.size(); ++i)
    runs[run_of[splits.copies[i].whole.index()]].push_back(static_cast<std::int32_t>(whole_tets + i));
  return batches_of(model, runs, before.color_start);
}

void mirror_row(BlockMatrix& matrix, std::span<const std::int32_t> mirror, std::size_t row) {
  const BlockPattern& pattern = *matrix.pattern;
  for (auto slot = pattern.row_start[row]; slot < pattern.diagonal[row]; ++slot) {
    matrix.at(slot) = matrix.at(mirror[static_cast<std::size_t>(slot)]).transpose();
  }
}

void mirror_upper(BlockMatrix& matrix, std::span<const std::int32_t> mirror, Workers& workers) {
  workers.for_each(matrix.pattern->rows(), kRowsPerChunk, [&](std::size_t row) { mirror_row(matrix, mirror, row); });
}

}  // namespace incise
