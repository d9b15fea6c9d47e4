#pragma once

#include <incise/mechanics/solvers.hpp>
#include <incise/mechanics/step_stiffness.hpp>
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
  double max_step_mm = 0.0;
  int iterations = 0;
  bool is_finite = true;
};

/// Moves tissue towards equilibrium by linear systems whose matrix stands in for the tangent: that of a plain
/// corotational twin, cheap to keep up to date, with the stiffness of the first moment (viscous branches included).
/// Forces are those of the true law, so what is reached is its equilibrium; the matrix only sets how fast.
class Relaxation {
 public:
  Relaxation(const TissueModel& tissue, const TissueModel& twin, std::span<const Vec3> positions);

  /// One linear solution for a step that began at `before` and ends at the state's new positions.
  /// @param is_fresh  nothing that was kept from earlier steps is used.
  RelaxReport solve(TissueState& state, std::span<const Vec3> before, double step_s, std::span<const DragPoint> drags,
                    const Vec3& tool_mm_s, bool is_fresh, double tolerance, Workers& workers);
  /// Forces of the tissue, the platform and gravity at the state, mN, held vertices included.
  [[nodiscard]] std::span<const Vec3> forces() const { return forces_; }

 private:
  void add_drags(const TissueState& state, std::span<const Vec3> before, double step_s,
                 std::span<const DragPoint> drags, const Vec3& tool_mm_s, RelaxReport& report);

  const TissueModel& tissue_;
  const TissueModel& twin_;
  StepStiffness stiffness_;
  TwoLevelPcg solver_;
  TissueState twin_state_;
  Points forces_;
  Points right_side_;
  Points ignored_;
  Points increment_;
  Points drag_sum_;
  std::vector<std::uint8_t> is_orphan_;
};

}  // namespace incise
