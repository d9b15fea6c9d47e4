#include "test_body.hpp"

#include <incise/cutting/carving.hpp>

#include <benchmark/benchmark.h>

namespace incise::bench {
namespace {

/// Steps of 0.26 mm of a straight cut through the middle of the stretched block. Accuracy: the residual of each step's solve, relative to
/// the tolerance that it had to meet, is 1 or less.
void CutStep(benchmark::State& timing) {
  const TissueModel model = pulled_block(static_cast<double>(timing.range(0)));
  Workers workers(static_cast<int>(timing.range(1)));
  Monitor silent;
  const StaticResult stretched = solve_static(model, StaticSettings{}, workers, silent);
  const CutSettings settings;
  const Needle needle;
  const auto pose = [](int step) { return ToolPose{Vec3(40.0 + 0.26 * step, 25.0, 18.0), -Vec3::UnitZ()}; };
  CutState state = begin_cut(model, stretched.state, pose(0));
  CutWorkspace workspace(model, stretched.state.positions);
  int step = 0;
  double iterations = 0.0;
  bool has_converged = true;
  for (auto run : timing) {
    static_cast<void>(run);
    const CutStepReport report = advance(model, settings, needle, state, workspace, pose(++step), settings.step_s(), workers);
    iterations += report.solve.iterations;
    has_converged = has_converged && report.solve.converged;
  }
  timing.counters["tets"] = static_cast<double>(model.mesh.tets.size());
  timing.counters["iterations"] = iterations / step;
  timing.counters["all_converged"] = has_converged ? 1.0 : 0.0;
}
BENCHMARK(CutStep)->ArgNames({"tets", "threads"})->ArgsProduct({{10000, 40000}, {1, 2}})->Iterations(40)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace incise::bench
