#include "virtual_bench/relaxation.hpp"

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr int kVerticesPerAggregate = 140;
constexpr double kMostStepMm = 1.0;     // of a vertex in one solution
constexpr double kForceFloorMn = 3.0;   // scale of the stopping test where nothing pulls

double norm_of(std::span<const Vec3> values) {
  double sum = 0.0;
  for (const Vec3& v : values) sum += v.squaredNorm();
  return std::sqrt(sum);
}

}  // namespace

Relaxation::Relaxation(const TissueModel& tissue, const TissueModel& twin, std::span<const Vec3> positions)
    : tissue_(tissue),
      twin_(twin),
      stiffness_(twin),
      solver_(twin.pattern, positions, kVerticesPerAggregate, Precision::Single),
      twin_state_(rest_state(twin)),
      forces_(tissue.mesh.vertices.size()),
      right_side_(forces_.size()),
      ignored_(forces_.size()),
      increment_(forces_.size()),
      drag_sum_(forces_.size()),
      is_orphan_(forces_.size(), 0) {}

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
        double* block = stiffness_.matrix().block(twin_.tet_slots[drag.tet][4 * a + b]);
        const double value = drag.viscosity_mn_s_mm / step_s * drag.weights[a] * drag.weights[b];
        for (const int i : {0, 4, 8}) block[i] += value;
      }
    }
  }
  report.pull_mn = norm_of(drag_sum_);
  for (std::size_t v = 0; v < drag_sum_.size(); ++v) right_side_[v] += drag_sum_[v];
}

RelaxReport Relaxation::solve(TissueState& state, std::span<const Vec3> before, double step_s,
                              std::span<const DragPoint> drags, const Vec3& tool_mm_s, bool is_fresh, double tolerance,
                              Workers& workers) {
  RelaxReport report;
  std::copy(tissue_.dead_load_mn.begin(), tissue_.dead_load_mn.end(), forces_.begin());
  add_elastic_response(tissue_, state, forces_, nullptr, workers);
  add_viscous_response(tissue_, state, step_s, forces_, nullptr, workers);
  add_support_response(tissue_, state, forces_, nullptr);
  right_side_ = forces_;

  twin_state_.positions = state.positions;
  twin_state_.is_live = state.is_live;
  std::fill(ignored_.begin(), ignored_.end(), Vec3::Zero());
  stiffness_.begin(twin_, twin_state_, 1.0, is_fresh, ignored_, workers);
  for (const DragPoint& drag : drags) stiffness_.lend(twin_, TetId(drag.tet));
  add_drags(state, before, step_s, drags, tool_mm_s, report);

  std::fill(is_orphan_.begin(), is_orphan_.end(), 1);
  for (std::size_t t = 0; t < state.is_live.size(); ++t) {
    if (state.is_live[t] == 0) continue;
    for (const VertexId v : tissue_.mesh.tets[t]) is_orphan_[v.index()] = 0;
  }
  stiffness_.hold(twin_, right_side_, is_orphan_, workers);
  report.residual_mn = norm_of(right_side_);
  solver_.update(stiffness_.matrix(), is_fresh, workers, stiffness_.changed_rows());
  PcgSettings settings;
  settings.relative_tolerance = tolerance;
  settings.reference_mn = std::max(report.pull_mn, 0.02 * report.residual_mn);
  settings.floor_mn = kForceFloorMn;
  const PcgReport solved = solver_.solve(stiffness_.matrix(), right_side_, increment_, settings, workers);
  report.iterations = solved.iterations;

  for (Vec3& step : increment_) {
    const double length = step.norm();
    if (!std::isfinite(length)) report.is_finite = false;
    if (length > kMostStepMm) step *= kMostStepMm / length;
    report.max_step_mm = std::max(report.max_step_mm, std::min(length, kMostStepMm));
  }
  if (!report.is_finite) return report;
  for (std::size_t v = 0; v < increment_.size(); ++v) state.positions[v] += increment_[v];
  return report;
}

}  // namespace incise
