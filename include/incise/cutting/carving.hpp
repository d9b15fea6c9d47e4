#pragma once

#include <incise/core/workers.hpp>
#include <incise/cutting/cut_points.hpp>
#include <incise/cutting/cut_record.hpp>
#include <incise/cutting/cut_settings.hpp>
#include <incise/cutting/tool.hpp>
#include <incise/mechanics/solvers.hpp>
#include <incise/mechanics/tissue.hpp>

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace incise {

/// The hold of the tool on one tet, from first contact until the tet is removed or out of reach.
struct Bond {
  TetId tet;
  /// From the tool's tip to the holding place: the tet's centroid at first contact, shifted by each slip since, mm. It
  /// turns with the tool.
  Vec3 offset_mm = Vec3::Zero();
};
inline void describe(Visitor& v, Bond& b) {
  v("tet", b.tet, "The tet that is held.");
  v("offset_mm", b.offset_mm,
    "Vector from the tool's tip to the tet's centroid at first contact, less its slip since.");
}

/// A simulated cut as a value: tissue, doses, bonds, and the record of removed tets.
struct CutState {
  TissueState tissue;
  std::vector<double> dose;       ///< per tet: progress towards removal, >= 0; removed at 1. Kept when contact is lost,
                                  ///< unless ContactCount::Reset applies
  std::vector<double> tear_dose;  ///< per tet: the part of `dose` that comes from the tool's work
  std::vector<Bond> bonds;        ///< ascending tet
  CutPoints points;               ///< of a cut by points; otherwise empty
  MeshSplits splits;              ///< of the whole mesh, by a cut by points; all lists here are of the split mesh
  int split_step = 0;             ///< step of the last search for tets that have come apart
  ToolPose tool;
  double time_s = 0.0;  ///< since the tool began to plunge
  int step = 0;         ///< number of steps done
  CutRecord record;
};
inline void describe(Visitor& v, CutState& s) {
  v("tissue", s.tissue, "The tissue.");
  v("dose", s.dose, "Dose of each tet; it is removed at 1.");
  v("tear_dose", s.tear_dose, "Part of the dose that comes from the tool's work.");
  v("bonds", s.bonds, "Bonds, in ascending order of their tets.");
  v("points", s.points, "Points of a cut by points.");
  v("splits", s.splits, "Splits of the mesh by a cut by points.");
  v("split_step", s.split_step, "Step of the last search for tets that have come apart.", kNotNegative);
  v("tool", s.tool, "Pose of the tool.");
  v("time_s", s.time_s, "Time since the tool began to plunge.");
  v("step", s.step, "Number of steps done.", kNotNegative);
  v("record", s.record, "Every tet that was removed.");
}
/// Returns the state before the first step: no doses, no bonds, nothing removed.
[[nodiscard]] CutState begin_cut(const TissueModel& model, TissueState stretched, const ToolPose& tool);

/// Returns whether the next step rebuilds everything that a workspace carries from step to step (every 20th step does).
/// Save a cut only in such a state: from it a new workspace, even in another process, gives the same bits as the
/// workspace that led to it.
[[nodiscard]] bool is_renewal_step(const CutState& state);

/// Report on one step.
struct CutStepReport {
  PcgReport solve;
  std::size_t tets_in_contact = 0;
  std::size_t removed = 0;             ///< tets whose dose became full
  std::size_t loose_removed = 0;       ///< tets of loose fragments
  std::size_t held_back_vertices = 0;  ///< vertices whose motion was shortened to CutSettings::max_step_mm
  std::size_t slipped = 0;             ///< bonds, or points of a cut by points, that slipped
  Vec3 tool_force_mn = Vec3::Zero();          ///< of the tissue on the tool
  Vec3 tool_torque_mn_mm = Vec3::Zero();      ///< of the tissue on the tool, about its tip
  double max_step_mm = 0.0;  ///< greatest motion of a vertex, at most CutSettings::max_step_mm with the tool in. With
                             ///< the tool out, if no part of the step lowers the energy: the motion that was rejected
  bool is_finite = true;                      ///< false: the step gave non-finite numbers, and positions are unchanged
};

/// Memory, stiffness and factorisations that steps reuse. Affects results only within the solver's tolerance. A cut
/// that continues from a state for which is_renewal_step() holds gives the same bits in any workspace made with the
/// same positions and precision.
class CutWorkspace {
 public:
  /// @param positions  of the model's vertices, N x 3, mm: the stretched tissue.
  /// @param precision  of the linear solves; single precision suffices for tolerances of 1e-2 or more.
  explicit CutWorkspace(const TissueModel& model, std::span<const Vec3> positions, Precision precision = Precision::Single);
  ~CutWorkspace();
  CutWorkspace(CutWorkspace&&) noexcept;
  struct Data;
  [[nodiscard]] Data& data() { return *data_; }

  /// Returns the model on the split mesh of a cut; `whole` itself without splits. Rebuilds the workspace if the splits
  /// differ from those of the last call. The reference is valid until the next rebuild.
  /// @param whole  the model that the workspace was made for.
  const TissueModel& model_for(const TissueModel& whole, const MeshSplits& splits);

 private:
  std::unique_ptr<Data> data_;
  MeshSplits splits_;
  Points positions_;
  Precision precision_;
};

/// Removes live tets as if their dose were full, and the loose fragments that result. The record gives them the step
/// number of the state. Ignores tets that are not live.
/// @returns the number of tets removed, fragments included.
/// @throws InvalidArgument for a tet that is not in the mesh.
std::size_t remove_tets(const TissueModel& model, CutState& state, CutWorkspace& workspace, std::span<const TetId> tets);

/// Advances the cut by one quasi-static step (implicit Euler, one linear solve). The tool moves from state.tool to
/// `next`, held tissue follows or slips, and the dose of touched tets grows. Tets whose dose is full are removed, with
/// the loose fragments that result. A cut by points also splits the mesh: see CutState::splits.
/// @param whole   the model of the whole mesh.
/// @param next    pose of the tool at the end of the step; absent: the tool is out, its bonds are dropped, and the
///                tissue takes one step of Newton's method towards rest.
/// @param step_s  time in which the tool moves, s, finite and > 0.
/// @throws InvalidArgument for a step that is not above 0.
CutStepReport advance(const TissueModel& whole, const CutSettings& settings, const Tool& tool, CutState& state,
                      CutWorkspace& workspace, const std::optional<ToolPose>& next, double step_s, Workers& workers);

}  // namespace incise
