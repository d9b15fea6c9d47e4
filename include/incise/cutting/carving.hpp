#pragma once

#include <incise/core/workers.hpp>
#include <incise/cutting/cut_record.hpp>
#include <incise/cutting/cut_settings.hpp>
#include <incise/cutting/tool.hpp>
#include <incise/mechanics/solvers.hpp>
#include <incise/mechanics/tissue.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace incise {

/// The hold that the tool has on one tet between first contact and removal.
struct Bond {
  TetId tet;
  Vec3 offset_mm = Vec3::Zero();  ///< of the tet's centroid from the tool's tip when first touched
};

/// A simulation of cutting as a value: tissue, contact times, bonds and what was removed so far.
struct CutState {
  TissueState tissue;
  std::vector<double> contact_s;     ///< per tet: time in contact so far; kept when contact is lost
  std::vector<Bond> bonds;           ///< ascending tet
  ToolPose tool;
  double time_s = 0.0;
  int step = 0;
  CutRecord record;
};
[[nodiscard]] CutState begin_cut(const TissueModel& model, TissueState stretched, const ToolPose& tool);

/// What one step did.
struct CutStepReport {
  PcgReport solve;
  std::size_t tets_in_contact = 0;
  std::size_t removed = 0;
  std::size_t loose_removed = 0;
  std::size_t held_back_vertices = 0;         ///< vertices whose step was cut to max_step_mm
  Vec3 tool_force_mn = Vec3::Zero();          ///< of the tissue on the tool
  double max_step_mm = 0.0;
  bool is_finite = true;                      ///< false: positions were left as before the step
};

/// Before steps whose CutState::step is a multiple of this, a workspace forgets what it keeps of earlier ones: the preconditioner's
/// coarse matrix and the stiffness may be this old.
inline constexpr int kFreshSteps = 20;

/// Memory, stiffness and factorisations that steps reuse; never affects a result beyond the solver's tolerance. A cut that goes on from
/// its state before a multiple of kFreshSteps, in a workspace made with the same positions and precision, gives the same bits.
class CutWorkspace {
 public:
  /// @param precision  of the linear solves; single suffices for tolerances of 1e-2 and more.
  explicit CutWorkspace(const TissueModel& model, std::span<const Vec3> positions, Precision precision = Precision::Single);
  ~CutWorkspace();
  CutWorkspace(CutWorkspace&&) noexcept;
  struct Data;
  [[nodiscard]] Data& data() { return *data_; }

 private:
  std::unique_ptr<Data> data_;
};

/// One quasi-static step of implicit Euler with one linear solve: the tool moves from state.tool to `next`, bonded tissue follows, contact
/// time is integrated inside the step, and tets whose time is up go, with fragments that then hang by no face.
/// Without `next` the tool is out: bonds are dropped and the tissue relaxes.
CutStepReport advance(const TissueModel& model, const CutSettings& settings, const Needle& needle, CutState& state,
                      CutWorkspace& workspace, const std::optional<ToolPose>& next, double step_s, Workers& workers);

/// Distance, mm, between a tet (solid, any orientation) and the segment from a to b; 0 where they meet. Exact.
[[nodiscard]] double distance_to_segment(const std::array<Vec3, 4>& tet, const Vec3& a, const Vec3& b);

/// Time within a step during which the distance is at most `limit`, as a fraction in [0, 1], and when it first is: distances at evenly
/// spaced moments of the step, taken as linear between them.
struct ContactInterval {
  double fraction = 0.0;
  double first = 0.0;  ///< in [0, 1]; meaningful when fraction > 0
};
[[nodiscard]] ContactInterval contact_interval(std::span<const double> distances_mm, double limit_mm);

}  // namespace incise
