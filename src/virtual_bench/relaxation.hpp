#pragma once

#include <incise/mechanics/solvers.hpp>
#include <incise/mechanics/tissue.hpp>

#include <array>
#include <span>
#include <vector>

namespace incise {

/// A point of a tet on which the electrode drags: force = viscosity · (tool's velocity - the point's velocity).
struct DragPoint {
  std::size_t tet = 0;
  std::array<double, 4> weights{};  ///< barycentric
  double viscosity_mn_s_mm = 0.0;
};

struct RelaxReport {
  double residual_mn = 0.0;  ///< norm of the free forces before the solution, drag included
  double pull_mn = 0.0;      ///< norm of the drag forces
  double max_step_mm = 0.0;  ///< greatest motion of a vertex, before it is shortened to kMostStepMm
  int iterations = 0;        ///< of the linear solver
  bool is_finite = true;
};

/// Moves tissue towards equilibrium by Newton's method with the projected tangent of the exact law, viscosity included.
/// Tets marked as lively get a new tangent at every solution, the others only at a renewal. Forces are exact, so the
/// iteration converges to the exact equilibrium; an older tangent only slows it.
class Relaxation {
 public:
  static constexpr double kMostStepMm = 1.0;  ///< greatest motion of a vertex in one solution

  /// Keeps a reference to `tissue`.
  Relaxation(const TissueModel& tissue, std::span<const Vec3> positions);

  /// Computes the tangent of all live tets that are not lively, for steps of `step_s`.
  /// @param is_lively  one flag per tet, kept until the next renewal.
  void renew(TissueState& state, double step_s, std::vector<std::uint8_t> is_lively, Workers& workers);

  /// Does one linear solution for a step that began at `before`, and moves the state's positions.
  /// @param step_s     as in the last renewal.
  /// @param drags      of the electrode.
  /// @param tool_mm_s  velocity of the electrode.
  /// @param tolerance  of the linear solve, relative.
  /// @throws InvalidArgument before the first renewal.
  RelaxReport solve(TissueState& state, std::span<const Vec3> before, double step_s, std::span<const DragPoint> drags,
                    const Vec3& tool_mm_s, double tolerance, Workers& workers);

 private:
  void add_tangent(TissueState& state, double step_s, const std::vector<std::uint8_t>& is_wanted, BlockMatrix& matrix,
                   Workers& workers);
  void add_drags(const TissueState& state, std::span<const Vec3> before, double step_s,
                 std::span<const DragPoint> drags, const Vec3& tool_mm_s, RelaxReport& report);

  const TissueModel& tissue_;
  TwoLevelPcg solver_;
  BlockMatrix kept_;    // tangent of tets that are not lively, and inertia
  BlockMatrix matrix_;  // of the solution
  std::vector<std::uint8_t> is_lively_;
  std::vector<std::uint8_t> wanted_;
  bool is_renewed_ = false;
  Points right_side_;
  Points ignored_;
  Points increment_;
  Points drag_sum_;
  std::vector<std::uint8_t> is_orphan_;
};

}  // namespace incise
