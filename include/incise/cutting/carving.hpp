#pragma once

#include <incise/core/workers.hpp>
#include <incise/cutting/cut_points.hpp>
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
  Vec3 offset_mm = Vec3::Zero();  ///< of the tet's centroid from the tool's tip when first touched, less what it has slipped since
};
inline void describe(Visitor& v, Bond& b) {
  v("tet", b.tet, "The tet that is held.");
  v("offset_mm", b.offset_mm,
    "Of its centroid from the tool's tip when first touched, less what it has slipped since.");
}

/// A simulation of cutting as a value: tissue, doses, bonds and what was removed so far.
struct CutState {
  TissueState tissue;
  std::vector<double> dose;          ///< per tet: how much of what removes it is done, gone at 1; kept when contact is lost
  std::vector<double> tear_dose;     ///< per tet: the part of `dose` that is the tool's work
  std::vector<Bond> bonds;           ///< ascending tet
  CutPoints points;                  ///< of a cut by points
  MeshSplits splits;                 ///< of the model's mesh, by a cut by points: all lists here are of the split mesh
  int split_step = 0;                ///< when it was looked at last what has come apart
  ToolPose tool;
  double time_s = 0.0;
  int step = 0;
  CutRecord record;
};
inline void describe(Visitor& v, CutState& s) {
  v("tissue", s.tissue, "The tissue.");
  v("dose", s.dose, "Of each tet: removed at 1.");
  v("tear_dose", s.tear_dose, "The part of it that is the tool's work.");
  v("bonds", s.bonds, "Ascending tet.");
  v("points", s.points, "Of a cut by points.");
  v("splits", s.splits, "Of the mesh, by a cut by points.");
  v("split_step", s.split_step, "When it was looked at last what has come apart.", kNotNegative);
  v("tool", s.tool, "Where it is.");
  v("time_s", s.time_s, "Since the tool began to plunge.");
  v("step", s.step, "Done so far.", kNotNegative);
  v("record", s.record, "Every tet that was removed.");
}
[[nodiscard]] CutState begin_cut(const TissueModel& model, TissueState stretched, const ToolPose& tool);

/// Whether the next step from here makes everything anew that a workspace carries from step to step (every 20th step does). From such a
/// state a new workspace, in another process too, gives the same bits as the one that led there: the states that can be put by.
[[nodiscard]] bool is_renewal_step(const CutState& state);

/// What one step did.
struct CutStepReport {
  PcgReport solve;
  std::size_t tets_in_contact = 0;
  std::size_t removed = 0;
  std::size_t loose_removed = 0;
  std::size_t held_back_vertices = 0;         ///< vertices whose step was cut to max_step_mm
  std::size_t slipped = 0;                    ///< bonds, or points of a cut by points, that slipped
  Vec3 tool_force_mn = Vec3::Zero();          ///< of the tissue on the tool
  Vec3 tool_torque_mn_mm = Vec3::Zero();      ///< of the tissue on the tool, about its tip
  double max_step_mm = 0.0;  ///< farthest that a vertex moves, with the tool in at most CutSettings::max_step_mm; on
                             ///< the way to rest, where nothing lowers the energy, how far the step would move it
  bool is_finite = true;                      ///< false: positions were left as before the step
};

/// Memory, stiffness and factorisations that steps reuse; never affects a result beyond the solver's tolerance. A cut that goes on from
/// its state before a renewal step (is_renewal_step), in a workspace made with the same positions and precision, gives the same bits.
class CutWorkspace {
 public:
  /// @param precision  of the linear solves; single suffices for tolerances of 1e-2 and more.
  explicit CutWorkspace(const TissueModel& model, std::span<const Vec3> positions, Precision precision = Precision::Single);
  ~CutWorkspace();
  CutWorkspace(CutWorkspace&&) noexcept;
  struct Data;
  [[nodiscard]] Data& data() { return *data_; }

  /// The model on the split mesh of a cut: everything is made anew where the splits are others than those of the last
  /// call. Valid until then. @param whole  the model that the workspace was made for.
  const TissueModel& model_for(const TissueModel& whole, const MeshSplits& splits);

 private:
  std::unique_ptr<Data> data_;
  MeshSplits splits_;
  Points positions_;
  Precision precision_;
};

/// Removes live tets as a full dose would, with fragments that then hang by no face; the record names them as cut in the state's step.
/// @returns how many went. @throws InvalidArgument for a tet that the mesh does not have.
std::size_t remove_tets(const TissueModel& model, CutState& state, CutWorkspace& workspace, std::span<const TetId> tets);

/// One quasi-static step of implicit Euler with one linear solve: the tool moves from state.tool to `next`, bonded
/// tissue follows or slips, the dose of touched tets is integrated inside the step, and tets whose dose is full go,
/// with fragments that then hang by no face. Without `next` the tool is out: bonds are dropped and the tissue takes a
/// step of Newton's method towards rest. A cut by points splits the mesh on its way: see CutState::splits. @param whole
/// the model of the mesh before that.
CutStepReport advance(const TissueModel& whole, const CutSettings& settings, const Tool& tool, CutState& state,
                      CutWorkspace& workspace, const std::optional<ToolPose>& next, double step_s, Workers& workers);

}  // namespace incise
