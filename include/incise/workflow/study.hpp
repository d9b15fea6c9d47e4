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
  v("name", r.stage, "Name of the stage.");
  v("state", r.state, "Whether the stage was computed, reused or skipped.");
  v("wall_s", r.wall_s, "Time that the stage took.");
}

/// Results of a study so far. Later parts are absent if the study was asked to stop earlier or could not continue.
struct Study {
  std::vector<StageReport> stages;
  std::optional<Segmentation> segmentation;   ///< absent when not needed
  std::shared_ptr<const TissueModel> model;
  std::optional<StaticResult> stretched;
  std::optional<ToolPath> plan;      ///< the intended path
  std::optional<ToolPath> followed;  ///< path of the first cut: the planned path, or the given one
  std::optional<SimulatedCut> as_planned;
  std::optional<Correction> correction;
  std::optional<SimulatedCut> corrected;
  bool is_accepted = false;     ///< whether the correction is accepted: objection_to finds nothing
  std::string correction_note;  ///< why it is not accepted, as the end of a sentence; empty: it is, or there is none
  Verdict about_inputs;   ///< objections before any cut: scan, elasticity map, tumour edge against surface
  Verdict verdict;        ///< of the run, see verdict_of_run; complete once the last requested stage has run
  /// Outcome of the last simulated cut, or NotConverged/Cancelled of the stage that could not continue.
  Outcome outcome = Outcome::Success;
};

/// Returns the cut along the path that a program would follow: the corrected path if the correction is accepted,
/// otherwise the path that was cut first. Null: no such cut.
[[nodiscard]] const SimulatedCut* verifying_cut(const Study& study);

/// Greatest number of passes after the first cut: usually, and if there is an objection to the nearest ring.
inline constexpr int kUsualPasses = 3;
inline constexpr int kMostPasses = 7;
/// Returns the name of the cut of a pass: as_planned for pass 0.
[[nodiscard]] std::string name_of_pass(int pass);

/// Thrown if a cut is interrupted; its progress is kept.
class CutInterrupted : public Cancelled {
 public:
  CutInterrupted(const std::string& what, std::string slot) : Cancelled(what), slot_(std::move(slot)) {}
  /// Slot of the cache that holds its checkpoint.
  [[nodiscard]] const std::string& slot() const { return slot_; }

 private:
  std::string slot_;
};

/// Called during a cut, at each step from which it could be resumed (see ProgressKeeper). @param cut  as_planned,
/// pass_1 …, corrected.
using CutWatch =
    std::function<void(const std::string& cut, const TissueModel& model, const IncisionProgress& progress)>;

/// How far a run goes, and how it treats interrupted cuts.
struct RunOptions {
  Stage until = Stage::Verify;
  bool must_resume =
      false;  ///< continue from the checkpoint of the next cut, or refuse before anything is computed
  double checkpoint_s =
      30.0;  ///< least time between two checkpoints of a cut; an interrupted cut always leaves one
  CutWatch watch = {};  ///< may be empty
};

/// Runs the loop of the paper on one specimen up to `until`: segment, mesh around the planned cut, clamp and stretch,
/// plan, cut, correct the path by the measured error and cut again, once or until the cut lies where it was intended.
/// Products in the cache are reused; new ones are kept as soon as they are complete, a cut in progress at each
/// checkpoint.
/// @throws CaseError or DataError of the stage that cannot use its inputs; Cancelled when the monitor asks to stop
/// between products; CutInterrupted when it asks to stop within a cut.
[[nodiscard]] Study run_study(const Case& settings, Inputs& inputs, Cache& cache, const RunOptions& options,
                              Workers& workers, Monitor& monitor, ProductSink& sink);
[[nodiscard]] Study run_study(const Case& settings, Inputs& inputs, Cache& cache, const RunOptions& options,
                              Workers& workers, Monitor& monitor);

// The single stages, for inputs in memory.

/// Evaluates a simulated incision: mid-line and, for a ring, inner edge; and heat along the path. The verdict expects
/// no errors beyond the simulation, see verdict_of_cut.
/// @param followed  path of the tool; its speeds and depths determine the heat.
/// @param tets      number of tets of the mesh before the cut.
[[nodiscard]] SimulatedCut judge(const Case& settings, IncisionResult incision, const ToolPath& followed,
                                 const ToolPath& intended, std::size_t tets);
/// Makes a mesh of the unstretched body that is fine around the planned cut: stretches a coarse mesh, plans on it, and
/// carries the path back to rest.
/// @throws CaseError as plan_on and tissue_of, without equilibrium of the coarse mesh, or for fine_mm above coarse_mm.
[[nodiscard]] MeshProduct mesh_around_planned_cut(const Case& settings, const GrayVolume& occupancy,
                                                  const std::optional<Contour>& tumor_edge,
                                                  const std::optional<Contour>& line, Workers& workers,
                                                  Monitor& monitor, const MadeSkin& made_skin = {},
                                                  const MaterialSources& sources = {});
/// Returns the specimen as the case holds it: material (varied by tet), constraints (the default ones if none are
/// given) and gravity on a mesh. @throws CaseError as make_tissue_model, material_field, toughness_of and
/// default_constraints.
[[nodiscard]] TissueModel tissue_of(const Case& settings, TetMesh mesh);
/// Finds the equilibrium of the clamped and stretched tissue.
[[nodiscard]] StaticResult stretch(const TissueModel& model, Workers& workers, Monitor& monitor);
/// Plans the intended path on the stretched skin. The refusal of a margin that does not fit names the greatest that
/// does.
/// @param made_skin  of the tissue at rest; empty for a specimen given as a mesh.
/// @throws CaseError as project_tumor_edge, project_line, plan_ring and plan_line.
[[nodiscard]] ToolPath plan_on(const Case& settings, const TissueModel& model, std::span<const Vec3> stretched,
                               const std::optional<Contour>& tumor_edge, const std::optional<Contour>& line,
                               const MadeSkin& made_skin = {});
/// Places the tumour's surface in the stretched tissue. Like its edge, it is moved along the approach onto the skin:
/// each vertex by the weighted moves of the edge's points near it. If it was drawn on the tissue as scanned, it then
/// follows the tissue's deformation.
/// @param drawn_edge  as given, in the surface's configuration; absent: the surface is not moved onto the skin.
/// @throws CaseError (field tumor.contour) for an edge point beside the tissue, (tumor.surface) for a vertex farther
/// than surface_tolerance_mm from it.
[[nodiscard]] TriMesh tumor_in_stretched(const Case& settings, const TissueModel& model, std::span<const Vec3> stretched,
                                         TriMesh surface, const std::optional<Contour>& drawn_edge);
/// Returns the settings of a simulated cut along a path, without the tumour's surface.
[[nodiscard]] IncisionSettings incision_settings(const Case& settings, const ToolPath& path);
/// Returns the same settings with the tumour's surface, and with layers down to the path's deepest place.
/// @param tumor_surface  closed, stretched tissue before the cut, mm; without triangles: not known.
[[nodiscard]] IncisionSettings incision_settings_for(const Case& settings, const ToolPath& path,
                                                     const TriMesh& tumor_surface);
/// Simulates a cut along a path from its beginning, without the tumour's surface, and evaluates it.
[[nodiscard]] SimulatedCut cut_and_judge(const Case& settings, const TissueModel& model, const TissueState& stretched,
                                         const ToolPath& path, const ToolPath& intended, Workers& workers,
                                         Monitor& monitor);

}  // namespace incise
