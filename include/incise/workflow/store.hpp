#pragma once

#include <incise/core/monitor.hpp>
#include <incise/geometry/contour.hpp>
#include <incise/geometry/tool_path.hpp>
#include <incise/geometry/volume.hpp>
#include <incise/imaging/segmentation.hpp>
#include <incise/mechanics/statics.hpp>
#include <incise/workflow/products.hpp>

#include <array>
#include <optional>

namespace incise {

/// Which of the simulated cuts of a study: the first, those on the way to the correction, and the one that the correction ended with.
enum class CutRole { AsPlanned, Pass1, Pass2, Pass3, Pass4, Pass5, Pass6, Pass7, Corrected };
inline constexpr std::array kCutRoles{CutRole::AsPlanned, CutRole::Pass1, CutRole::Pass2,
                                      CutRole::Pass3,     CutRole::Pass4, CutRole::Pass5,
                                      CutRole::Pass6,     CutRole::Pass7, CutRole::Corrected};
/// Most passes after the first cut; four more where something is held against the nearest ring.
inline constexpr int kUsualPasses = 3;
inline constexpr int kMostPasses = 7;
static_assert(static_cast<int>(CutRole::Corrected) == 1 + kMostPasses);
/// The cut of a pass: 0 is the one as planned. @pre 0 <= pass <= kMostPasses.
[[nodiscard]] constexpr CutRole role_of_pass(int pass) { return static_cast<CutRole>(pass); }

/// Where a study finds what it was given and keeps what it makes. A load returns nothing when the product is absent or was made from other
/// settings or inputs than today's: then the stage runs. `wall_s` is how long the stage took.
class Store {
 public:
  virtual ~Store() = default;

  virtual CtVolume read_ct(Monitor& monitor) = 0;
  virtual std::optional<TetMesh> read_specimen_mesh(Monitor& monitor) = 0;  ///< nothing: the mesh is made from the CT
  virtual std::optional<Contour> read_tumor_edge() = 0;
  /// The tumour's closed surface, in the configuration of its edge; nothing: only the edge is known.
  virtual std::optional<TriMesh> read_tumor_surface() { return std::nullopt; }
  virtual std::optional<Contour> read_line() = 0;           ///< the curve of an open cut
  virtual std::optional<ToolPath> read_given_path() = 0;    ///< a path to follow in place of the planned one

  virtual std::optional<Segmentation> load_segmentation() = 0;
  virtual void save_segmentation(const Segmentation& segmentation, double wall_s) = 0;
  virtual std::optional<TetMesh> load_mesh() = 0;
  virtual void save_mesh(const MeshProduct& product, double wall_s) = 0;
  /// @param model  whose mesh the positions belong to.
  virtual std::optional<StaticResult> load_stretched(const TissueModel& model) = 0;
  virtual void save_stretched(const TissueModel& model, const StaticResult& result, double wall_s) = 0;
  virtual std::optional<ToolPath> load_plan() = 0;
  virtual void save_plan(const ToolPath& path, double wall_s) = 0;
  virtual std::optional<SimulatedCut> load_cut(CutRole role) = 0;
  virtual void save_cut(CutRole role, const TissueModel& model, const StaticResult& stretched, const SimulatedCut& cut,
                        double wall_s) = 0;
  /// A cut of today's settings and inputs that was interrupted, if there is one.
  /// @param model    that it was begun on.
  /// @param monitor  is told of one that is of other settings or inputs, and so of no use.
  virtual std::optional<IncisionProgress> load_progress(CutRole role, const TissueModel& model, Monitor& monitor) = 0;
  /// Is shown a cut on its way (see ProgressKeeper) and keeps as much of it as it sees fit, the last of an interrupted cut always.
  virtual void keep_progress(CutRole role, const IncisionProgress& progress, bool is_interrupted) = 0;
  virtual std::optional<Correction> load_correction() = 0;
  virtual void save_correction(const Correction& correction, double wall_s) = 0;
  /// Makes the cut of a pass the corrected one, and lets the passes go. Does nothing where there is a corrected cut of today's settings.
  /// @returns whether there is one now.
  virtual bool adopt_cut(CutRole from) = 0;
  /// Says beside the planned and beside the corrected path what the cuts along them are worth. @param of_planned  absent: the first cut did
  /// not follow the plan.  @param of_corrected  absent: there is no corrected path.
  virtual void save_verdicts(const std::optional<Verdict>& of_planned, const std::optional<Verdict>& of_corrected) {
    static_cast<void>(of_planned), static_cast<void>(of_corrected);
  }
};

}  // namespace incise
