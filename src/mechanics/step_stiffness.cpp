#include "mechanics/chunks.hpp"
#include "mechanics/corotational_response.hpp"
#include "mechanics/held_axes.hpp"
#include "mechanics/law_response.hpp"
#include "mechanics/tet_batches.hpp"

#include <incise/mechanics/step_stiffness.hpp>

#include <algorithm>
#include <array>

namespace incise {
namespace {

constexpr double kTurnRad = 2e-2;  // a tet's blocks are kept up to this turn: docs/models/solvers.md
constexpr std::size_t kBatchesPerChunk = 64;

}  // namespace

struct StepStiffness::Data {
  using Block = std::array<double, 9>;
  struct Lent {
    std::int32_t slot;
    Block before;
  };

  BlockMatrix matrix;
  std::vector<double> rotations;  // with which tets were assembled, in the order of the kernels' batches
  std::vector<double> fill;       // likewise; 0: not in the matrix
  std::vector<std::uint8_t> is_changed;
  std::vector<std::uint8_t> next_changed;  // rows that change again when lent blocks are restored
  std::vector<Lent> lent;
  std::vector<std::uint8_t> is_lent;        // per block
  std::vector<std::int32_t> support_slots;  // diagonal blocks of vertices that a support may push
  std::vector<Block> support_before;        // these blocks in the previous step, with support, before holding
  std::vector<std::uint8_t> is_supported;   // per row: its diagonal block is one of support_slots
  std::vector<std::uint8_t> held;
  double step_s = 0.0;
  bool had_viscosity = false;
  Tangent tangent = Tangent::FrozenRotations;

  explicit Data(const TissueModel& model)
      : matrix(model.pattern),
        is_changed(model.pattern->rows(), 1),
        next_changed(model.pattern->rows(), 0),
        is_lent(model.pattern->blocks(), 0),
        is_supported(model.pattern->rows(), 0),
        held(model.pattern->rows(), 0) {
    if (is_plain_corotational(model)) {
      const std::size_t places = kBatchTets * model.batches->batches.size();
      rotations.assign(9 * places, 0.0);
      fill.assign(places, 0.0);
    }
    for (const SupportPlane& support : model.supports) {
      for (const VertexId v : support.vertices) {
        support_slots.push_back(model.pattern->diagonal[v.index()]);
        is_supported[v.index()] = 1;
      }
    }
    std::sort(support_slots.begin(), support_slots.end());
    support_slots.erase(std::unique(support_slots.begin(), support_slots.end()), support_slots.end());
    support_before.assign(support_slots.size(), Block{});
  }

  [[nodiscard]] Block block(std::int32_t slot) const {
    Block copy;
    std::copy_n(matrix.block(slot), 9, copy.begin());
    return copy;
  }
  void lend(std::int32_t slot) {
    std::uint8_t& flag = is_lent[static_cast<std::size_t>(slot)];
    if (flag != 0) return;
    flag = 1;
    lent.push_back({slot, block(slot)});
  }
  void take_back() {
    for (const Lent& l : lent) {
      std::copy(l.before.begin(), l.before.end(), matrix.block(l.slot));
      is_lent[static_cast<std::size_t>(l.slot)] = 0;
    }
    lent.clear();
  }

  void assemble_all(const TissueModel& model, TissueState& state, std::span<Vec3> forces, Workers& workers);
  void renew(const TissueModel& model, TissueState& state, std::span<Vec3> forces, Workers& workers);
};

StepStiffness::StepStiffness(const TissueModel& model) : data_(std::make_unique<Data>(model)) {}
StepStiffness::~StepStiffness() = default;
StepStiffness::StepStiffness(StepStiffness&&) noexcept = default;

BlockMatrix& StepStiffness::matrix() {
  return data_->matrix;
}
std::span<const std::uint8_t> StepStiffness::changed_rows() const {
  return data_->is_changed;
}

/// Zeroes the matrix and assembles every live tet, with inertia.
void StepStiffness::Data::assemble_all(const TissueModel& model, TissueState& state, std::span<Vec3> forces,
                                       Workers& workers) {
  std::fill(is_changed.begin(), is_changed.end(), 1);
  workers.for_chunks(matrix.values.size(), 9 * kRowsPerChunk * 16,
                     [&](std::size_t, std::size_t begin, std::size_t end) {
                       std::fill(matrix.values.begin() + static_cast<std::ptrdiff_t>(begin),
                                 matrix.values.begin() + static_cast<std::ptrdiff_t>(end), 0.0);
                     });
  add_elastic_response(model, state, forces, &matrix, workers, tangent);
  for (std::size_t v = 0; v < model.vertex_mass_kg.size(); ++v) {
    double* diagonal = matrix.block(model.pattern->diagonal[v]);
    const double inertia = model.vertex_mass_kg[v] / (step_s * step_s);
    for (const int i : {0, 4, 8}) diagonal[i] += inertia;
  }
  if (fill.empty()) return;
  workers.for_each(model.batches->batches.size(), kBatchesPerChunk, [&](std::size_t b) {
    const TetBatch& batch = model.batches->batches[b];
    for (std::size_t lane = 0; lane < kBatchTets; ++lane) {
      const std::int32_t tet = batch.tets[lane];
      if (tet < 0) continue;
      fill[kBatchTets * b + lane] = filled_share(state, static_cast<std::size_t>(tet));
      const double* rotation = state.rotations[static_cast<std::size_t>(tet)].data();
      for (std::size_t k = 0; k < 9; ++k) rotations[9 * kBatchTets * b + kBatchTets * k + lane] = rotation[k];
    }
  });
}

/// Reassembles only what changed.
void StepStiffness::Data::renew(const TissueModel& model, TissueState& state, std::span<Vec3> forces,
                                Workers& workers) {
  is_changed.swap(next_changed);
  const AssembledTets assembled{model.batches->batches.data(), rotations.data(), fill.data(), is_changed.data(),
                                2.0 * kTurnRad * kTurnRad};
  renew_corotational_tangent(model, state, forces, matrix, assembled, workers);
  workers.for_each(matrix.pattern->rows(), kRowsPerChunk, [&](std::size_t row) {
    if (is_changed[row] != 0) mirror_row(matrix, model.batches->mirror, row);
  });
}

void StepStiffness::begin(const TissueModel& model, TissueState& state, double step_s, bool is_fresh, Tangent tangent,
                          std::span<Vec3> forces, Workers& workers, const std::optional<double>& viscous_s) {
  Data& d = *data_;
  d.take_back();
  const bool has_viscosity = viscous_s && is_viscous(model.material);
  if (is_fresh || has_viscosity || d.had_viscosity || tangent != Tangent::FrozenRotations ||
      d.tangent != Tangent::FrozenRotations || step_s != d.step_s || d.fill.empty()) {
    d.step_s = step_s;
    d.tangent = tangent;
    d.assemble_all(model, state, forces, workers);
  } else {
    d.renew(model, state, forces, workers);
  }
  d.had_viscosity = has_viscosity;
  if (has_viscosity) add_viscous_response(model, state, *viscous_s, forces, &d.matrix, workers, tangent);
  std::fill(d.next_changed.begin(), d.next_changed.end(), 0);
  for (const std::int32_t slot : d.support_slots) d.lend(slot);
  add_support_response(model, state, forces, &d.matrix);
  for (std::size_t i = 0; i < d.support_slots.size(); ++i) {
    const auto row = static_cast<std::size_t>(d.matrix.pattern->column[static_cast<std::size_t>(d.support_slots[i])]);
    const Data::Block now = d.block(d.support_slots[i]);
    if (now != d.support_before[i]) d.is_changed[row] = 1;
    d.support_before[i] = now;
  }
}

void StepStiffness::lend(const TissueModel& model, TetId tet) {
  Data& d = *data_;
  for (const std::int32_t slot : model.tet_slots[tet.index()]) d.lend(slot);
  for (const VertexId v : model.mesh.tets[tet.index()]) {
    d.is_changed[v.index()] = 1;
    d.next_changed[v.index()] = 1;
  }
}

void StepStiffness::hold(const TissueModel& model, std::span<Vec3> right_side, std::span<const std::uint8_t> also_held,
                         Workers& workers) {
  Data& d = *data_;
  // Flags of all rows first: the columns of a row depend on the flags of other rows.
  workers.for_each(d.held.size(), kRowsPerChunk, [&](std::size_t v) {
    if (d.is_changed[v] != 0) d.held[v] = held_axes(model, d.matrix, also_held, v);
    hold_right_side(d.held[v], right_side[v]);
  });
  workers.for_each(d.held.size(), kRowsPerChunk, [&](std::size_t v) {
    // Lent blocks are restored to their values before holding. Even if the new sum is the same, they must be held
    // again.
    if (d.is_changed[v] != 0 || d.is_supported[v] != 0) hold_row(d.matrix, d.held, v);
  });
}

}  // namespace incise
