#include "mechanics/corotational_response.hpp"

#include "mechanics/rotation.hpp"
#include "mechanics/tet_batches.hpp"

#include <incise/core/error.hpp>

#include <Eigen/Core>

namespace incise {
namespace {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
static_assert(sizeof(Mat3) == 9 * sizeof(double) &&
              sizeof(Vec3) == 3 * sizeof(double));  // the kernels read plain arrays

void robust_rotation(const double* f, double* r) {
  const Mat3 guess = Eigen::Map<const RowMajor>(r);
  Eigen::Map<RowMajor> rotation(r);
  rotation = nearest_rotation(Eigen::Map<const RowMajor>(f), guess);
}

SweepTangent sweep_tangent(Tangent tangent) {
  switch (tangent) {
    case Tangent::FrozenRotations:
      return SweepTangent::FrozenRotations;
    case Tangent::Exact:
      return SweepTangent::Exact;
    case Tangent::Projected:
      return SweepTangent::Projected;
  }
  return SweepTangent::None;
}

TetSweep reading_sweep(const TissueModel& model, const TissueState& state) {
  INCISE_REQUIRE(model.batches != nullptr, "expected a model from make_tissue_model");
  return {.positions = state.positions.data()->data(),
          .is_live = state.is_live.data(),
          .fill = state.fill.empty() ? nullptr : state.fill.data(),
          .rotations = state.rotations.data()->data(),
          .robust_rotation = robust_rotation};
}

TetSweep writing_sweep(const TissueModel& model, TissueState& state, std::span<Vec3> forces) {
  TetSweep sweep = reading_sweep(model, state);
  sweep.new_rotations = state.rotations.data()->data();
  sweep.forces = forces.data()->data();
  return sweep;
}

/// Returns the sweep restricted to one run of batches.
TetSweep of_run(TetSweep sweep, const TetBatches& batches, std::size_t run) {
  const auto begin = static_cast<std::size_t>(batches.run_start[run]);
  sweep.batches = batches.batches.data() + begin;
  sweep.count = static_cast<std::size_t>(batches.run_start[run + 1]) - begin;
  return sweep;
}

/// Sweeps the runs of one colour in parallel, because they share no vertex, and the colours one after another.
void sweep_all(const TetSweep& sweep, const TetBatches& batches, Workers& workers) {
  const KernelTable& table = kernels();
  for (std::size_t color = 0; color < batches.colors(); ++color) {
    const auto first = static_cast<std::size_t>(batches.color_start[color]);
    const auto count = static_cast<std::size_t>(batches.color_start[color + 1]) - first;
    workers.for_each(count, 1, [&](std::size_t i) { table.sweep_tets(of_run(sweep, batches, first + i)); });
  }
}

}  // namespace

void add_corotational_response(const TissueModel& model, TissueState& state, std::span<Vec3> forces,
                               BlockMatrix* stiffness, Tangent tangent, Workers& workers) {
  TetSweep sweep = writing_sweep(model, state, forces);
  if (stiffness != nullptr) {
    INCISE_REQUIRE(stiffness->pattern == model.pattern, "expected a matrix of the model's own pattern");
    sweep.values = stiffness->values.data();
    sweep.tangent = sweep_tangent(tangent);
  }
  sweep_all(sweep, *model.batches, workers);
  if (stiffness != nullptr) mirror_upper(*stiffness, model.batches->mirror, workers);
}

void renew_corotational_tangent(const TissueModel& model, TissueState& state, std::span<Vec3> forces, BlockMatrix& stiffness,
                                const AssembledTets& assembled, Workers& workers) {
  TetSweep sweep = writing_sweep(model, state, forces);
  sweep.values = stiffness.values.data();
  sweep.tangent = SweepTangent::FrozenRotations;
  sweep.assembled = &assembled;
  sweep_all(sweep, *model.batches, workers);
}

double corotational_energy_uj(const TissueModel& model, const TissueState& state) {
  const TetSweep sweep = reading_sweep(model, state);
  double energy = 0.0;
  for (std::size_t run = 0; run < model.batches->runs(); ++run) {
    energy += kernels().sweep_tets(of_run(sweep, *model.batches, run));
  }
  return energy;
}

}  // namespace incise
