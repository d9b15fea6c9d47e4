#pragma once

#include <incise/core/cache.hpp>
#include <incise/core/error.hpp>
#include <incise/core/monitor.hpp>
#include <incise/core/names.hpp>
#include <incise/core/workers.hpp>
#include <incise/imaging/made_skin.hpp>
#include <incise/workflow/case.hpp>
#include <incise/workflow/inputs.hpp>
#include <incise/workflow/material_sources.hpp>
#include <incise/workflow/product_sink.hpp>
#include <incise/workflow/products.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// The steps from a scan to a corrected path, in order; each needs those before it.
enum class Stage { Segment, Mesh, Stretch, Plan, Simulate, Compensate, Verify };
inline constexpr std::array<std::string_view, 7> kStageNames{"segment",  "mesh",       "stretch", "plan",
                                                             "simulate", "compensate", "verify"};
[[nodiscard]] constexpr Names names_of(Stage) {
  return kStageNames;
}

enum class StageState {
  Computed,
  Reused,   ///< the cache had it, made from the same settings and inputs
  Skipped,  ///< not needed: the product was given, or a later product was reused
};
inline constexpr std::array<std::string_view, 3> kStageStateNames{"computed", "reused", "skipped"};
[[nodiscard]] constexpr Names names_of(StageState) {
  return kStageStateNames;
}

struct StageReport {
  Stage stage;
  StageState state = StageState::Computed;
  double wall_s = 0.0;
};
inline void describe(Visitor& v, StageReport& r) {
  v("name", r.stage, "Of the stage.");
  v("state", r.state, "Whether it was computed.");
  v("wall_s", r.wall_s, "Time that it took.");
}

/// What a study has made so far; later parts are absent when it was asked to stop earlier or could not go on.
struct Study {
  std::vector<StageReport> stages;
  std::optional<Segmentation> segmentation;   ///< absent when not needed
  std::shared_ptr<const TissueModel> model;
  std::optional<StaticResult> stretched;
  std::optional<ToolPath> plan;               ///< the intended path
  std::optional<ToolPath> followed;           ///< by the first cut: the planned path, or the one that was given
  std::optional<SimulatedCut> as_planned;
  std::optional<Correction> correction;
  std::optional<SimulatedCut> corrected;
  bool is_accepted = false;     ///< whether the correction is accepted: objection_to finds nothing
  std::string correction_note;  ///< why it is not, as the end of a sentence; empty: it is, or there is none
  Verdict about_inputs;   ///< what was found before anything was cut: scan, contour against surface
  Verdict verdict;        ///< of the run, see verdict_of_run; complete once the last stage asked for has run
  /// How it ended: that of the last simulated cut, or NotConverged/Cancelled of the stage that could not go on.
  Outcome outcome = Outcome::Success;
};

/// The cut along the path that a program would follow: the corrected one where the correction is accepted, else the first. Null: none.
[[nodiscard]] const SimulatedCut* verifying_cut(const Study& study);

/// Most passes of the compensation after the first cut; four more where something argues against the nearest ring.
inline constexpr int kUsualPasses = 3;
inline constexpr int kMostPasses = 7;
/// The name of a cut along the path of a pass; that of pass 0 is as_planned.
[[nodiscard]] std::string name_of_pass(int pass);
/// The slot of a cache in which a cut under way is kept. @param cut  as_planned, pass_1 …, corrected.
[[nodiscard]] std::string checkpoint_slot(const std::string& cut);

/// A cut was interrupted; what was done of it is kept.
class CutInterrupted : public Cancelled {
 public:
  CutInterrupted(const std::string& what, std::string slot) : Cancelled(what), slot_(std::move(slot)) {}
  /// Of the cache, in which its checkpoint is.
  [[nodiscard]] const std::string& slot() const { return slot_; }

 private:
  std::string slot_;
};

/// Called during a cut, at each step from which it could be resumed (see ProgressKeeper). @param cut  as_planned,
/// pass_1 …
using CutWatch =
    std::function<void(const std::string& cut, const TissueModel& model, const IncisionProgress& progress)>;

/// How far a run goes, and what it does with cuts that were interrupted.
struct RunOptions {
  Stage until = Stage::Verify;
  bool must_resume =
      false;  ///< go on from the checkpoint of the cut that comes next, or refuse before anything is computed
  double checkpoint_s =
      30.0;  ///< least time between two checkpoints of a cut; one that is interrupted always leaves one
  CutWatch watch = {};  ///< may be empty
};

/// Runs the loop of the paper on one specimen up to `until`: segment, mesh around the planned cut, clamp and stretch,
/// plan, cut, correct the path by the measured error and cut again, once or until the cut lies where it was intended.
/// Products that the cache already has are used; new ones are kept as soon as they are made, a cut under way at each
/// checkpoint.
/// @throws CaseError or DataError of the stage that cannot use what it was given; Cancelled when the monitor asks to
/// stop between products; CutInterrupted when it asks to within a cut.
[[nodiscard]] Study run_study(const Case& settings, Inputs& inputs, Cache& cache, const RunOptions& options,
                              Workers& workers, Monitor& monitor, ProductSink& sink);
[[nodiscard]] Study run_study(const Case& settings, Inputs& inputs, Cache& cache, const RunOptions& options,
                              Workers& workers, Monitor& monitor);

/// The single stages, for those who have the inputs in memory.
/// Evaluates a simulated incision: mid-line and, for a ring, inner edge; and heat along the path.
/// @param followed  by the tool: its speeds and depths count for heat.  @param tets  of the mesh before the cut.
/// Its verdict expects nothing beyond the simulation, see verdict_of_cut.
[[nodiscard]] SimulatedCut judge(const Case& settings, IncisionResult incision, const ToolPath& followed,
                                 const ToolPath& intended, std::size_t tets);
[[nodiscard]] MeshProduct mesh_around_planned_cut(const Case& settings, const GrayVolume& occupancy,
                                                  const std::optional<Contour>& tumor_edge,
                                                  const std::optional<Contour>& line, Workers& workers,
                                                  Monitor& monitor, const MadeSkin& made_skin = {},
                                                  const MaterialSources& sources = {});
/// The specimen as the case holds it: material (label by label, where it varies), constraints (the default ones, where none are given)
/// and gravity on a mesh. @throws CaseError as make_tissue_model and material_field.
[[nodiscard]] TissueModel tissue_of(const Case& settings, TetMesh mesh);
[[nodiscard]] StaticResult stretch(const TissueModel& model, Workers& workers, Monitor& monitor);
/// The intended path on the stretched skin. A margin that does not fit is refused with the greatest that does.
/// @param made_skin  of the tissue at rest; none for a specimen that was given as a mesh.
/// @throws CaseError as project_tumor_edge, project_line, plan_ring and plan_line.
[[nodiscard]] ToolPath plan_on(const Case& settings, const TissueModel& model, std::span<const Vec3> stretched,
                               const std::optional<Contour>& tumor_edge, const std::optional<Contour>& line,
                               const MadeSkin& made_skin = {});
/// The tumour's surface in the stretched tissue: placed as its edge is (each vertex is moved along the approach by what the edge's points
/// near it are moved when they are laid onto the skin) and, where it was drawn on the tissue as scanned, carried along with that.
/// @param drawn_edge  as given, in the surface's configuration; absent: the surface is taken as it lies.
/// @throws CaseError (field tumor.surface) for a vertex farther than surface_tolerance_mm from the tissue.
[[nodiscard]] TriMesh tumor_in_stretched(const Case& settings, const TissueModel& model, std::span<const Vec3> stretched,
                                         TriMesh surface, const std::optional<Contour>& drawn_edge);
/// How a case's cut along a path is simulated; the tumour's surface is not in it.
[[nodiscard]] IncisionSettings incision_settings(const Case& settings, const ToolPath& path);
/// The same with layers down to the path's deepest place. @param tumor_surface  closed, stretched
/// tissue before the cut, mm; without triangles: not known.
[[nodiscard]] IncisionSettings incision_settings_for(const Case& settings, const ToolPath& path,
                                                     const TriMesh& tumor_surface);
/// A cut along a path from its beginning, the tumour's surface not known, and its evaluation.
[[nodiscard]] SimulatedCut cut_and_judge(const Case& settings, const TissueModel& model, const TissueState& stretched,
                                         const ToolPath& path, const ToolPath& intended, Workers& workers,
                                         Monitor& monitor);

}  // namespace incise
