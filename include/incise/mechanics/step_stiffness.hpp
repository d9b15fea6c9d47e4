#pragma once

#include <incise/core/workers.hpp>
#include <incise/mechanics/tissue.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace incise {

/// The stiffness of tissue that changes little from step to step: tangent, inertia M/Δt², support,
/// what the caller adds for one step, and held axes. With rotations frozen, of plain corotational tissue only tets are assembled anew that
/// were carved or that turned by more than some 0.01 rad since they were assembled last; forces are those of every tet
/// and exact. Other tissue, and other tangents, are assembled anew in each step. Order of use in a step: begin, lend and add, hold. Same bits
/// at any thread count; what is kept depends on the steps since the last one that began fresh.
class StepStiffness {
 public:
  explicit StepStiffness(const TissueModel& model);
  ~StepStiffness();
  StepStiffness(StepStiffness&&) noexcept;

  /// Adds the elastic and support forces at state.positions to `forces`, mN, and brings the matrix up to date. Updates
  /// state.rotations.
  /// @param viscous_s  how long the step takes for viscous tissue, s: its viscous forces are added, and it is assembled
  /// anew in each step; absent: the long-time response.
  /// @param is_fresh  every tet is assembled anew, so that nothing depends on earlier steps. So it is at the first
  /// step, and where
  ///                  step_s is not that of the last.
  void begin(const TissueModel& model, TissueState& state, double step_s, bool is_fresh, Tangent tangent,
             std::span<Vec3> forces, Workers& workers, const std::optional<double>& viscous_s = {});
  /// Allows the caller to add to the sixteen blocks of a tet: what it adds is taken back at the next begin().
  void lend(const TissueModel& model, TetId tet);
  /// Identity rows for held axes, as hold_constrained.
  void hold(const TissueModel& model, std::span<Vec3> right_side, std::span<const std::uint8_t> also_held,
            Workers& workers);

  [[nodiscard]] BlockMatrix& matrix();
  /// Per row: 1 where a block differs from that of the step before.
  [[nodiscard]] std::span<const std::uint8_t> changed_rows() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace incise
