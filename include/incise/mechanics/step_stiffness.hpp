#pragma once

#include <incise/core/workers.hpp>
#include <incise/mechanics/tissue.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace incise {

/// Stiffness matrix of tissue that changes little from step to step: tangent, inertia M/Δt², supports, the caller's
/// additions for one step, and held axes. With frozen rotations, a tet of plain corotational tissue is reassembled only
/// if it was carved, its fill changed, or it turned by more than 0.02 rad since it was last assembled; the forces are
/// always exact. Other tissue and other tangents are reassembled in each step. Call in each step: begin, then lend and
/// add, then hold. Same bits at any thread count; the matrix depends on the steps since the last fresh one.
class StepStiffness {
 public:
  explicit StepStiffness(const TissueModel& model);
  ~StepStiffness();
  StepStiffness(StepStiffness&&) noexcept;

  /// Adds the elastic and support forces at state.positions to `forces` (N x 3, mN) and brings the matrix up to date.
  /// Updates state.rotations.
  /// @param step_s  Δt of the inertia, s.
  /// @param is_fresh  reassembles every tet, so that nothing depends on earlier steps. The first step, and a step with
  /// another step_s, are always fresh.
  /// @param viscous_s  duration of the step for viscous tissue, s: adds its viscous forces and reassembles every tet;
  /// absent: the long-time response.
  void begin(const TissueModel& model, TissueState& state, double step_s, bool is_fresh, Tangent tangent,
             std::span<Vec3> forces, Workers& workers, const std::optional<double>& viscous_s = {});
  /// Allows the caller to add to the sixteen blocks of a tet; the next begin() restores them.
  void lend(const TissueModel& model, TetId tet);
  /// Replaces the rows and columns of held axes by those of the identity, as hold_constrained.
  /// @pre from step to step `also_held` changes only at changed_rows().
  void hold(const TissueModel& model, std::span<Vec3> right_side, std::span<const std::uint8_t> also_held,
            Workers& workers);

  [[nodiscard]] BlockMatrix& matrix();
  /// Per row of blocks: 1 if a block may differ from the previous step's, otherwise 0.
  [[nodiscard]] std::span<const std::uint8_t> changed_rows() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace incise
