#include "test_body.hpp"

#include <incise/core/isa.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace incise::bench {
namespace {

/// Forces and tangent of every tet, at the affine stretch, from rotations that are near: zeroing included. Accuracy:
/// the sum of all forces, which is zero in exact arithmetic.
void ElasticResponse(benchmark::State& timing) {
  const TissueModel model = pulled_block(static_cast<double>(timing.range(0)));
  TissueState state = rest_state(model);
  for (Vec3& p : state.positions) p.x() *= 1.2;
  Workers workers(static_cast<int>(timing.range(1)));
  BlockMatrix stiffness(model.pattern);
  Points forces(model.mesh.vertices.size());
  for (auto run : timing) {
    static_cast<void>(run);
    std::fill(forces.begin(), forces.end(), Vec3::Zero());
    std::fill(stiffness.values.begin(), stiffness.values.end(), 0.0);
    add_elastic_response(model, state, forces, &stiffness, workers);
  }
  Vec3 sum = Vec3::Zero();
  double scale = 0.0;
  for (const Vec3& force : forces) {
    sum += force;
    scale += force.norm();
  }
  timing.SetLabel(std::string(to_string(active_isa())));
  timing.counters["tets"] = static_cast<double>(model.mesh.tets.size());
  timing.counters["ns_per_tet"] =
      benchmark::Counter(static_cast<double>(model.mesh.tets.size()) * 1e-9,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  timing.counters["force_sum_relative"] = sum.norm() / scale;
}
BENCHMARK(ElasticResponse)
    ->ArgNames({"tets", "threads"})
    ->ArgsProduct({{10000, 100000}, {1, 2}})
    ->Unit(benchmark::kMillisecond);

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Sums a buffer as fast as the threads can read it: what a product of as many bytes is measured against. @returns the
/// median of some runs, s.
double read_seconds(std::size_t bytes, Workers& workers) {
  constexpr std::size_t kChunk = 65536;
  std::vector<double> buffer(bytes / sizeof(double), 1.0);
  std::vector<double> sums(Workers::chunk_count(buffer.size(), kChunk));
  std::vector<double> seconds;
  for (int i = 0; i < 21; ++i) {
    const double start = seconds_now();
    workers.for_chunks(buffer.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      constexpr std::size_t kSums = 32;  // apart, so that adding never waits
      double partial[kSums] = {};
      for (std::size_t k = begin; k + kSums <= end; k += kSums) {
        for (std::size_t j = 0; j < kSums; ++j) partial[j] += buffer[k + j];
      }
      double sum = 0.0;
      for (const double p : partial) sum += p;
      sums[chunk] = sum;
    });
    seconds.push_back(seconds_now() - start);
  }
  benchmark::DoNotOptimize(sums.data());
  std::nth_element(seconds.begin(), seconds.begin() + 10, seconds.end());
  return seconds[10];
}

/// y = A x. `over_read` is the median time over that of reading as many bytes with the same threads, in the same run.
/// Accuracy: the error against sums in long double, relative to the largest component.
void BlockProduct(benchmark::State& timing) {
  const TissueModel model = pulled_block(static_cast<double>(timing.range(0)));
  Workers workers(static_cast<int>(timing.range(1)));
  TissueState state = rest_state(model);
  for (Vec3& p : state.positions) p.x() *= 1.2;
  BlockMatrix matrix(model.pattern);
  Points forces(model.mesh.vertices.size());
  add_elastic_response(model, state, forces, &matrix, workers);
  const Points& x = state.positions;
  Points y(x.size());
  std::vector<double> seconds;
  for (auto run : timing) {
    static_cast<void>(run);
    const double start = seconds_now();
    multiply(matrix, x, y, workers);
    seconds.push_back(seconds_now() - start);
  }
  std::nth_element(seconds.begin(), seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2), seconds.end());
  const double median = seconds[seconds.size() / 2];

  const BlockPattern& pattern = *model.pattern;
  const std::size_t bytes =
      matrix.values.size() * sizeof(double) + 4 * (pattern.blocks() + pattern.rows()) + 2 * x.size() * sizeof(Vec3);
  long double worst = 0.0L;
  long double largest = 0.0L;
  for (std::size_t row = 0; row < pattern.rows(); ++row) {
    for (std::size_t i = 0; i < 3; ++i) {
      long double sum = 0.0L;
      for (auto slot = static_cast<std::size_t>(pattern.row_start[row]);
           slot < static_cast<std::size_t>(pattern.row_start[row + 1]); ++slot) {
        for (std::size_t j = 0; j < 3; ++j) {
          sum +=
              static_cast<long double>(matrix.values[9 * slot + 3 * i + j]) *
              static_cast<long double>(x[static_cast<std::size_t>(pattern.column[slot])][static_cast<Eigen::Index>(j)]);
        }
      }
      worst = std::max(worst, std::abs(sum - static_cast<long double>(y[row][static_cast<Eigen::Index>(i)])));
      largest = std::max(largest, std::abs(sum));
    }
  }
  timing.SetLabel(std::string(to_string(active_isa())));
  timing.counters["tets"] = static_cast<double>(model.mesh.tets.size());
  timing.counters["GB_per_s"] = static_cast<double>(bytes) * 1e-9 / median;
  timing.counters["over_read"] = median / read_seconds(bytes, workers);
  timing.counters["error_relative"] = static_cast<double>(worst / largest);
}
BENCHMARK(BlockProduct)
    ->ArgNames({"tets", "threads"})
    ->ArgsProduct({{100000, 1000000}, {1, 2}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace incise::bench
