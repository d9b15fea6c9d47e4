#include "test_body.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>

namespace incise::bench {
namespace {

/// Forces and tangent of every tet, at the affine stretch. Accuracy: the sum of all forces, which is zero in exact arithmetic.
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
  timing.counters["tets"] = static_cast<double>(model.mesh.tets.size());
  timing.counters["ns_per_tet"] = benchmark::Counter(static_cast<double>(model.mesh.tets.size()) * 1e-9,
                                                     benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  timing.counters["force_sum_relative"] = sum.norm() / scale;
}
BENCHMARK(ElasticResponse)->ArgNames({"tets", "threads"})->ArgsProduct({{10000, 100000}, {1, 2}})->Unit(benchmark::kMillisecond);

/// The stretch of 20 mm from rest. Accuracy: the residual, relative to the reactions.
void StaticStretch(benchmark::State& timing) {
  const TissueModel model = pulled_block(static_cast<double>(timing.range(0)));
  Workers workers(2);
  Monitor silent;
  StaticResult result;
  for (auto run : timing) {
    static_cast<void>(run);
    result = solve_static(model, StaticSettings{}, workers, silent);
  }
  timing.counters["tets"] = static_cast<double>(model.mesh.tets.size());
  timing.counters["newton"] = result.iterations;
  timing.counters["residual"] = result.relative_residual;
}
BENCHMARK(StaticStretch)->ArgName("tets")->Arg(10000)->Arg(30000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace incise::bench
