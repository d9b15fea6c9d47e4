#pragma once

#include <incise/mechanics/solvers.hpp>
#include <incise/mechanics/tissue.hpp>

#include <array>
#include <span>
#include <vector>

namespace incise {

/// One point of a tet at which the electrode drags: force = viscosity (tool's velocity - the point's velocity).
struct DragPoint {
  std::size_t tet = 0;
  std::array<double, 4> weights{};  ///< barycentric
  double viscosity_mn_s_mm = 0.0;
};

struct RelaxReport {
  double residual_mn = 0.0;  ///< norm of the free forces before the solution
  double pull_mn = 0.0;      ///< norm of what the drag gave
  double max_step_mm = 0.0;  ///< longest way of a vertex, before it was shortened to kMostStepMm
  int iterations = 0;
  bool is_finite = true;
};

/// Moves tissue towards equilibrium by Newton's method with the projected tangent of the true law, viscosity included.
/// Only tets that are called lively have their tangent taken at every solution; of the others it is that of the last
/// renewal. Forces are exact, so what is reached is the true equilibrium; a tangent that is not quite up to date only
/// sets how fast.
class Relaxation {
 public:
  static constexpr double kMostStepMm = 1.0;  ///< that a vertex moves in one solution

  Relaxation(const TissueModel& tissue, std::span<const Vec3> positions);

  /// Takes the tangent of all live tets that are not lively, for steps of `step_s`.
  /// @param is_lively  one flag per tet, kept until the next renewal.
  void renew(TissueState& state, double step_s, std::vector<std::uint8_t> is_lively, Workers& workers);

  /// One linear solution for a step that began at `before` and ends at the state's new positions.
  /// @pre renewed.  @param step_s  that of the renewal.
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
