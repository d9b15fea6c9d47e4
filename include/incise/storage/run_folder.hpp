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

/// Facts that every manifest of a run states beside settings and inputs.
struct RunContext {
  std::string command;  ///< the command line
  std::uint64_t seed = 0;
  int threads = 1;  ///< of the run; at most four of them write a cut's frames
};

/// The folder of a run. It reads inputs from the case's files, keeps results in a cache, and writes each product into a
/// separate folder for people, which has a temporary name until it is complete:
///
///   cache/       results that the next run loads instead of computing them: a file for each stage, and for an
///                unfinished cut (as_planned.checkpoint.bin); may be removed at any time
///   labels/      labels.nrrd, occupancy.nrrd, segment.json
///   mesh/        mesh.vtu, planned_cut_rest.csv, quality.json
///   stretched/   rest.vtu, deformed.vtu, deform.json
///   plan/        path.json, path.vtp, plan.json
///   as_planned/  incision.json, centerline.csv, inner_edge.csv, tumor_edge_final.csv, steps.csv, removed.vtu,
///                frames.pvd, frames/, kerf.vtp, depth.csv, lag.csv, centerline_DEPTHmm.csv, centerline_final.csv,
///                inner_edge_reference.csv
///   correction/  path.json, path.vtp, compensate.json, history.csv, errors.csv
///   corrected/   as as_planned/
///   robust/      path.json, path.vtp, robust.json: see write_robust; removed when a product it depends on is remade
///   assessment/  assess.json: see write_assessment; removed likewise
///
/// Each of these but cache/ also holds `manifest.json`; a product's folder (labels/ to corrected/) also `stage.json`,
/// with the product's key and a digest of each file. A run computes nothing from a product's folder: it rewrites a
/// folder with another key, and refuses one in which a file has changed since. When a product changes, the folders of
/// the later products, program/, robust/ and assessment/ are removed; the run writes products again as it reaches them.
class RunFolder : public Inputs, public ProductSink {
 public:
  /// Removes temporary files that a killed run left in `root` and its cache.
  /// @param root  created if missing  @throws DataError if that fails, or as EntryFolder for its cache.
  RunFolder(CaseFile file, std::filesystem::path root, RunContext context);

  [[nodiscard]] const CaseFile& case_file() const { return file_; }
  [[nodiscard]] const std::filesystem::path& root() const { return root_; }
  [[nodiscard]] Cache& cache() { return cache_; }
  /// Returns the folder of a product. @param name  see ProductNote
  [[nodiscard]] std::filesystem::path folder(const std::string& name) const { return root_ / name; }
  /// Whether the folder of any product exists.
  [[nodiscard]] bool has_products() const;

  CtVolume read_ct(Monitor& monitor) override;
  /// Reads the case's label volume; absent if it names none. @throws DataError as incise::read_labels, or if the case
  /// also names a CT and labelled tissue lies more than one voxel outside it.
  std::optional<LabelVolume> read_labels(Monitor& monitor) override;
  std::string scan_digest(Monitor& monitor) override;
  std::optional<TetMesh> read_specimen_mesh(Monitor& monitor) override;
  std::optional<Contour> read_tumor_edge() override;
  std::optional<TriMesh> read_tumor_surface() override;
  std::optional<GrayVolume> read_elasticity_map() override;
  std::optional<Contour> read_line() override;
  std::optional<ToolPath> read_given_path() override;
  /// Returns specimen_id_of_case. @throws DataError if the scan or mesh has to be read and cannot be.
  [[nodiscard]] std::string specimen_id() override;
  /// Returns the file of the given path, or else the case file.
  [[nodiscard]] std::filesystem::path path_name() const override {
    return file_.inputs.tool_path.empty() ? file_.file : file_.inputs.tool_path;
  }
  [[nodiscard]] Verdict advice_against(bool is_corrected) const override;

  /// Removes a program whose verdict lacks a reason of this advice, because it was written before the advice was known.
  /// Sends the monitor a warning.
  void remove_program_made_without(const Verdict& advice, Monitor& monitor);

  void labels(const ProductNote& note, const Segmentation& segmentation) override;
  void mesh(const ProductNote& note, const MeshProduct& product) override;
  void stretched(const ProductNote& note, const TissueModel& model, const StaticResult& result) override;
  void plan(const ProductNote& note, const ToolPath& path) override;
  void cut(const ProductNote& note, const TissueModel& model, const StaticResult& stretched,
           const SimulatedCut& cut) override;
  void correction(const ProductNote& note, const Correction& correction) override;
  void absent(const std::string& name) override;
  /// Writes each verdict, with the advice of an assessment, into the file of its path. A path that gets no verdict of a
  /// cut gets back the verdict of its last cut, if that cut was made with the case's present settings and inputs. A
  /// verdict without a cut adds its refusals to the known verdict.
  void verdicts(const std::optional<Verdict>& of_planned, const std::optional<Verdict>& of_corrected) override;

  /// Prepares the folder for a run up to a stage. Removes a program (with a warning) and a summary that were made with
  /// other settings, inputs or version than the case has now. Removes the verdicts from the paths' files, unless the
  /// run ends before it cuts and they still fit the case; a run that cuts writes them again at its end. Refusals stay
  /// in any case.
  /// @throws DataError if an input cannot be read.
  void remove_what_is_out_of_date(Stage until, Monitor& monitor);

  /// Returns the path with the case's specimen id and whether the specimen is virtual.
  [[nodiscard]] ToolPath with_specimen(ToolPath path);
  /// Writes manifest.json into an output folder of this run. @param verdict  of the run; null: none
  void write_manifest_to(const std::filesystem::path& folder, double wall_s, const Verdict* verdict = nullptr);

 private:
  [[nodiscard]] std::string input_hash(const std::filesystem::path& path);
  [[nodiscard]] Manifest manifest_now(double wall_s);
  /// Returns the key of everything that a verdict depends on beside its path.
  [[nodiscard]] CacheKey key_of_case();
  /// Whether a result's manifest states the present settings, inputs, version and specimen of this case.
  [[nodiscard]] bool is_made_as_now(const std::filesystem::path& result);
  /// Writes the folder of a product unless it is there already; removes later products and what was made from them.
  /// @throws DataError if a file in it has changed since it was written.
  void write(const ProductNote& note, const std::function<void(const std::filesystem::path&)>& fill);

  CaseFile file_;
  std::filesystem::path root_;
  RunContext context_;
  Cache cache_;
  std::map<std::filesystem::path, std::string> hashes_;  ///< of input files
};

/// Copies products from the cache of one run into the cache of another, except those whose name the other has already.
/// The other run uses those whose keys fit its case: runs of one specimen thus compute their common stages once. Copies
/// nothing if `from` has no cache.
/// @param from, to  root folders of runs  @param until  the last stage whose product is copied
/// @throws DataError as EntryFolder.
void take_products(const std::filesystem::path& from, const std::filesystem::path& to, Stage until);

/// File in the folder of a cut that has split or divided tets: all tets in the stretched tissue before the cut, with
/// the cell data `skin_faces` (bit f is set if face f is on the skin) and `gone_step`. The frames refer to its tets by
/// their cell data `cell`.
inline constexpr const char* kUncutFile = "frames/uncut.vtu";

}  // namespace incise
