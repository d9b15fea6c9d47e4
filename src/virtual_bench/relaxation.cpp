#include "virtual_bench/relaxation.hpp"

#include <incise/core/error.hpp>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr int kVerticesPerAggregate = 140;
constexpr double kForceFloorMn = 3.0;  // least scale of the stopping test

double norm_of(std::span<const Vec3> values) {
  double sum = 0.0;
  for (const Vec3& v : values) sum += v.squaredNorm();
  return std::sqrt(sum);
}

}  // namespace

Relaxation::Relaxation(const TissueModel& tissue, std::span<const Vec3> positions)
    : tissue_(tissue),
      solver_(tissue.pattern, positions, kVerticesPerAggregate, Precision::Single),
      kept_(tissue.pattern),
      matrix_(tissue.pattern),
      wanted_(tissue.mesh.tets.size(), 0),
      right_side_(tissue.mesh.vertices.size()),
      ignored_(right_side_.size()),
      increment_(right_side_.size()),
      drag_sum_(right_side_.size()),
      is_orphan_(right_side_.size(), 0) {}

/// Adds the tangent of the wanted live tets. `mechanics` adds the tangent of all live tets, so the others are marked as
/// not live meanwhile.
void Relaxation::add_tangent(TissueState& state, double step_s, const std::vector<std::uint8_t>& is_wanted,
                             BlockMatrix& matrix, Workers& workers) {
  for (std::size_t t = 0; t < wanted_.size(); ++t) wanted_[t] = state.is_live[t] != 0 && is_wanted[t] != 0 ? 1 : 0;
  std::fill(ignored_.begin(), ignored_.end(), Vec3::Zero());
  state.is_live.swap(wanted_);
  add_elastic_response(tissue_, state, ignored_, &matrix, workers, Tangent::Projected);
  add_viscous_response(tissue_, state, step_s, ignored_, &matrix, workers, Tangent::Projected);
  state.is_live.swap(wanted_);
}

void Relaxation::renew(TissueState& state, double step_s, std::vector<std::uint8_t> is_lively, Workers& workers) {
  is_lively_ = std::move(is_lively);
  std::vector<std::uint8_t> is_calm(is_lively_.size());
  std::transform(is_lively_.begin(), is_lively_.end(), is_calm.begin(),
                 [](std::uint8_t flag) -> std::uint8_t { return flag == 0; });
  std::fill(kept_.values.begin(), kept_.values.end(), 0.0);
  add_tangent(state, step_s, is_calm, kept_, workers);
  // Inertia over one second: negligible against stiffness, but it keeps the matrix definite for bits that hang by a
  // corner.
  for (std::size_t v = 0; v < tissue_.vertex_mass_kg.size(); ++v) {
    double* diagonal = kept_.block(tissue_.pattern->diagonal[v]);
    for (const int i : {0, 4, 8}) diagonal[i] += tissue_.vertex_mass_kg[v];
  }
  is_renewed_ = true;
}

void Relaxation::add_drags(const TissueState& state, std::span<const Vec3> before, double step_s,
                           std::span<const DragPoint> drags, const Vec3& tool_mm_s, RelaxReport& report) {
  std::fill(drag_sum_.begin(), drag_sum_.end(), Vec3::Zero());
  for (const DragPoint& drag : drags) {
    const Tet& tet = tissue_.mesh.tets[drag.tet];
    Vec3 moved = Vec3::Zero();
    for (std::size_t a = 0; a < 4; ++a)
      moved += drag.weights[a] * (state.positions[tet[a].index()] - before[tet[a].index()]);
    const Vec3 force = drag.viscosity_mn_s_mm * (tool_mm_s - moved / step_s);
    for (std::size_t a = 0; a < 4; ++a) {
      drag_sum_[tet[a].index()] += drag.weights[a] * force;
      for (std::size_t b = 0; b < 4; ++b) {
        double* block = matrix_.block(tissue_.tet_slots[drag.tet][4 * a + b]);
        const double value = drag.viscosity_mn_s_mm / step_s * drag.weights[a] * drag.weights[b];
        for (const int i : {0, 4, 8}) block[i] += value;
      }
    }
  }
  report.pull_mn = norm_of(drag_sum_);
  for (std::size_t v = 0; v < drag_sum_.size(); ++v) right_side_[v] += drag_sum_[v];
}

RelaxReport Relaxation::solve(TissueState& state, std::span<const Vec3> before, double step_s,
                              std::span<const DragPoint> drags, const Vec3& tool_mm_s, double tolerance,
                              Workers& workers) {
  INCISE_REQUIRE(!is_lively_.empty(), "expected a renewal before the first solution");
  RelaxReport report;
  std::copy(tissue_.dead_load_mn.begin(), tissue_.dead_load_mn.end(), right_side_.begin());
  add_elastic_response(tissue_, state, right_side_, nullptr, workers);
  add_viscous_response(tissue_, state, step_s, right_side_, nullptr, workers);
  matrix_.values = kept_.values;
  add_tangent(state, step_s, is_lively_, matrix_, workers);
  add_support_response(tissue_, state, right_side_, &matrix_);
  add_drags(state, before, step_s, drags, tool_mm_s, report);

  std::fill(is_orphan_.begin(), is_orphan_.end(), 1);
  for (std::size_t t = 0; t < state.is_live.size(); ++t) {
    if (state.is_live[t] == 0) continue;
    for (const VertexId v : tissue_.mesh.tets[t]) is_orphan_[v.index()] = 0;
  }
  hold_constrained(tissue_, matrix_, right_side_, is_orphan_);
  report.residual_mn = norm_of(right_side_);
  if (!std::isfinite(report.residual_mn)) {
    report.is_finite = false;
    return report;
  }
  solver_.update(matrix_, is_renewed_, workers);
  is_renewed_ = false;
  PcgSettings settings;
  settings.relative_tolerance = tolerance;
  settings.reference_mn = std::max(report.pull_mn, 0.02 * report.residual_mn);
  settings.floor_mn = kForceFloorMn;
  report.iterations = solver_.solve(matrix_, right_side_, increment_, settings, workers).iterations;

  for (Vec3& step : increment_) {
    const double length = step.norm();
    if (!std::isfinite(length)) report.is_finite = false;
    report.max_step_mm = std::max(report.max_step_mm, length);
    if (length > kMostStepMm) step *= kMostStepMm / length;
  }
  if (!report.is_finite) return report;
  for (std::size_t v = 0; v < increment_.size(); ++v) state.positions[v] += increment_[v];
  return report;
}

}  // namespace incise
