#pragma once

#include <incise/core/cache.hpp>
#include <incise/io/manifest.hpp>
#include <incise/storage/case_file.hpp>
#include <incise/workflow/inputs.hpp>
#include <incise/workflow/product_sink.hpp>
#include <incise/workflow/study.hpp>

#include <filesystem>
#include <functional>
#include <map>
#include <string>

namespace incise {

/// What every manifest of a run says beside settings and inputs.
struct RunContext {
  std::string command;  ///< the command line
  std::uint64_t seed = 0;
  int threads = 1;
};

/// The folder of a run: what its case is given comes from the case's files, what it makes is kept in a cache, and each
/// product that people look at has a folder of its own, written under a temporary name and renamed when complete:
///
///   cache/       what the next run takes in place of computing it: a file for each stage, and for a cut under way
///                (as_planned.checkpoint.bin); may be removed at any time
///   labels/      labels.nrrd, occupancy.nrrd, segment.json
///   mesh/        mesh.vtu, planned_cut_rest.csv, quality.json
///   stretched/   deformed.vtu, deform.json
///   plan/        path.json, path.vtp, plan.json
///   as_planned/  incision.json, centerline.csv, inner_edge.csv, tumor_edge_final.csv, steps.csv, removed.vtu,
///                frames.pvd, frames/, kerf.vtp, depth.csv, lag.csv, centerline_DEPTHmm.csv, centerline_final.csv,
///                inner_edge_reference.csv
///   correction/  path.json, path.vtp, compensate.json, history.csv, errors.csv
///   corrected/   as as_planned/
///   robust/      path.json, path.vtp, robust.json: see write_robust; removed when a product it depends on is remade
///   assessment/  assess.json: see write_assessment; removed likewise
///
/// and in each `manifest.json` and `stage.json`: the key of what is in it and a digest of each of its files. No run
/// reads a product's folder: one of another key is written anew, and one of which a file was changed since is refused.
/// When a product changes, the folders of those after it are removed; the run that goes on writes them again.
class RunFolder : public Inputs, public ProductSink {
 public:
  /// @param root  is made if missing. @throws DataError if that fails.
  RunFolder(CaseFile file, std::filesystem::path root, RunContext context);

  [[nodiscard]] const CaseFile& case_file() const { return file_; }
  [[nodiscard]] const std::filesystem::path& root() const { return root_; }
  [[nodiscard]] Cache& cache() { return cache_; }
  /// Of a product. @param name  see ProductNote.
  [[nodiscard]] std::filesystem::path folder(const std::string& name) const { return root_ / name; }
  /// Whether any product is there.
  [[nodiscard]] bool has_products() const;

  CtVolume read_ct(Monitor& monitor) override;
  /// @throws DataError also where the CT that is given beside them does not hold the labelled tissue.
  std::optional<LabelVolume> read_labels(Monitor& monitor) override;
  std::string scan_digest(Monitor& monitor) override;
  std::optional<TetMesh> read_specimen_mesh(Monitor& monitor) override;
  std::optional<Contour> read_tumor_edge() override;
  std::optional<TriMesh> read_tumor_surface() override;
  std::optional<GrayVolume> read_elasticity_map() override;
  std::optional<Contour> read_line() override;
  std::optional<ToolPath> read_given_path() override;
  /// Of the case, or of its scan or mesh. @throws DataError where that cannot be read.
  [[nodiscard]] std::string specimen_id() override;
  /// The file of a path that was given, else the case's.
  [[nodiscard]] std::filesystem::path path_name() const override {
    return file_.inputs.tool_path.empty() ? file_.file : file_.inputs.tool_path;
  }
  [[nodiscard]] Verdict advice_against(bool is_corrected) const override;

  /// Removes a program whose verdict does not hold this advice: it was written before the advice was known. Says so.
  void remove_program_made_without(const Verdict& advice, Monitor& monitor);

  void labels(const ProductNote& note, const Segmentation& segmentation) override;
  void mesh(const ProductNote& note, const MeshProduct& product) override;
  void stretched(const ProductNote& note, const TissueModel& model, const StaticResult& result) override;
  void plan(const ProductNote& note, const ToolPath& path) override;
  void cut(const ProductNote& note, const TissueModel& model, const StaticResult& stretched,
           const SimulatedCut& cut) override;
  void correction(const ProductNote& note, const Correction& correction) override;
  void absent(const std::string& name) override;
  /// Writes each verdict, with the advice of an assessment, beside its path. A path without one gets the verdict of its
  /// last cut back, if the last run that cut was made with the settings and inputs that the case has now. A verdict
  /// without a cut adds what it refuses to what is known.
  void verdicts(const std::optional<Verdict>& of_planned, const std::optional<Verdict>& of_corrected) override;

  /// Before a run up to a stage: removes a program and a summary that were made with other settings or inputs than the
  /// case's, and says so; and the verdicts beside the paths, which a run that cuts notes again at its end. Where the
  /// run ends before it cuts, the verdicts of the case as it is stay. What a verdict refuses stays in any case.
  /// @throws DataError where an input cannot be read.
  void remove_what_is_out_of_date(Stage until, Monitor& monitor);

  /// A manifest for an output folder of this run. @param verdict  of the run; null: the folder has none.
  void write_manifest_to(const std::filesystem::path& folder, double wall_s, const Verdict* verdict = nullptr);

 private:
  [[nodiscard]] ToolPath with_specimen(ToolPath path);
  [[nodiscard]] std::string input_hash(const std::filesystem::path& path);
  [[nodiscard]] Manifest manifest_now(double wall_s);
  /// Of everything that a verdict depends on beside its path.
  [[nodiscard]] CacheKey key_of_case();
  /// Whether a result's manifest has the settings, inputs, version and specimen that this case has now.
  [[nodiscard]] bool is_made_as_now(const std::filesystem::path& result);
  /// Writes the folder of a product, unless it is there already. @throws DataError where a file of it was changed
  /// since.
  void write(const ProductNote& note, const std::function<void(const std::filesystem::path&)>& fill);

  CaseFile file_;
  std::filesystem::path root_;
  RunContext context_;
  Cache cache_;
  std::map<std::filesystem::path, std::string> hashes_;  ///< of input files
};

/// Copies products that the cache of one run holds into that of another which has none of that name. Their keys tell
/// which of them fit its case, so that runs of one specimen make their common stages once. If `from` has no cache,
/// nothing is copied.
/// @param from, to  roots of runs.  @param until  the last stage whose product is copied.
/// @throws DataError as EntryFolder.
void take_products(const std::filesystem::path& from, const std::filesystem::path& to, Stage until);

/// In the folder of a cut that has divided tets: all of them before the cut, with the cell data `skin_faces` (bit f is
/// set where face f is on the skin) and `gone_step`. The frames name them by the cell data `cell`.
inline constexpr const char* kUncutFile = "frames/uncut.vtu";

/// The mesh at rest with what a deformation did to it: point data `displacement_mm`, cell data `von_mises_kpa`.
[[nodiscard]] TetMesh rest_mesh(const TissueModel& model, const TissueState& state);
/// The same with its vertices where they were moved to.
[[nodiscard]] TetMesh deformed_mesh(const TissueModel& model, const TissueState& state);

}  // namespace incise
