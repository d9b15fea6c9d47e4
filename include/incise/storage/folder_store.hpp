#pragma once

#include <incise/io/manifest.hpp>
#include <incise/storage/case_file.hpp>
#include <incise/workflow/store.hpp>

#include <array>
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

namespace incise {

/// What every manifest of a study says beside settings and inputs.
struct RunContext {
  std::string command;      ///< the command line
  std::uint64_t seed = 0;
  int threads = 1;
};

/// The products of a study and the folders that hold them.
enum class Product {
  Labels,
  Mesh,
  Stretched,
  Plan,
  AsPlanned,
  Pass1,
  Pass2,
  Pass3,
  Pass4,
  Pass5,
  Pass6,
  Pass7,
  Correction,
  Corrected
};
inline constexpr std::size_t kProductCount = static_cast<std::size_t>(Product::Corrected) + 1;
static_assert(static_cast<int>(Product::Correction) - static_cast<int>(Product::AsPlanned) == 1 + kMostPasses);

/// The product that the cut of a role is.
[[nodiscard]] constexpr Product product_of(CutRole role) {
  if (role == CutRole::Corrected) return Product::Corrected;
  return static_cast<Product>(static_cast<int>(Product::AsPlanned) + static_cast<int>(role));
}

/// A Store on a folder. Each product has a folder of its own, written under a temporary name and renamed when complete:
///
///   labels/      labels.nrrd, occupancy.nrrd, segment.json
///   mesh/        mesh.vtu, planned_cut_rest.csv, quality.json
///   stretched/   deformed.vtu, deform.json
///   plan/        path.json, path.vtp, plan.json
///   as_planned/  incision.json, centerline.csv, inner_edge.csv, tumor_edge_final.csv, steps.csv, removed.vtu,
///                frames.pvd, frames/, kerf.vtp, depth.csv, lag.csv, centerline_DEPTHmm.csv, centerline_final.csv,
///                inner_edge_reference.csv
///   pass_1/ …    as as_planned/: cuts on the way to the correction, gone when it is found
///   correction/  path.json, path.vtp, compensate.json, history.csv, errors.csv
///   corrected/   as as_planned/
///   robust/      path.json, path.vtp, robust.json: see write_robust; removed when a product it depends on is remade
///   assessment/  assess.json: see write_assessment; removed likewise
///
/// and while a cut is under way or interrupted, beside them, as_planned.checkpoint, pass_1.checkpoint … (see
/// CheckpointFile), and in each `manifest.json` and `stage.json`, whose key is the hash of the settings and inputs that
/// the product depends on: a product with another key is stale and counts as absent. The key holds what the product is
/// made with and from, and no names of files: a case folder may be moved. A cut whose judgement alone has changed
/// (thermal, plan.close_margin_mm) is judged anew when it is loaded, in its files too. `stage.json` also holds a digest
/// of each file of the product (of a path: without its verdict): what was changed since is refused, not taken for what
/// was computed.
class FolderStore : public Store {
 public:
  /// @param root  is made if missing. @throws DataError if that fails.
  /// @param checkpoint_s  least wall time between two checkpoints of a cut under way.
  FolderStore(CaseFile file, std::filesystem::path root, RunContext context, double checkpoint_s = 30.0);

  [[nodiscard]] const CaseFile& case_file() const { return file_; }
  [[nodiscard]] const std::filesystem::path& root() const { return root_; }
  [[nodiscard]] std::filesystem::path folder(Product product) const;
  [[nodiscard]] bool is_current(Product product);
  /// Hash of the settings, inputs and version that a product of this case depends on.
  [[nodiscard]] const std::string& product_key(Product product) { return key(product); }

  CtVolume read_ct(Monitor& monitor) override;
  std::optional<TetMesh> read_specimen_mesh(Monitor& monitor) override;
  std::optional<Contour> read_tumor_edge() override;
  std::optional<TriMesh> read_tumor_surface() override;
  std::optional<Contour> read_line() override;
  std::optional<ToolPath> read_given_path() override;

  std::optional<Segmentation> load_segmentation() override;
  void save_segmentation(const Segmentation& segmentation, double wall_s) override;
  std::optional<TetMesh> load_mesh() override;
  void save_mesh(const MeshProduct& product, double wall_s) override;
  std::optional<StaticResult> load_stretched(const TissueModel& model) override;
  void save_stretched(const TissueModel& model, const StaticResult& result, double wall_s) override;
  std::optional<ToolPath> load_plan() override;
  void save_plan(const ToolPath& path, double wall_s) override;
  std::optional<SimulatedCut> load_cut(CutRole role) override;
  void save_cut(CutRole role, const TissueModel& model, const StaticResult& stretched, const SimulatedCut& cut,
                double wall_s) override;
  std::optional<IncisionProgress> load_progress(CutRole role, const TissueModel& model, Monitor& monitor) override;
  void keep_progress(CutRole role, const IncisionProgress& progress, bool is_interrupted) override;
  std::optional<Correction> load_correction() override;
  void save_correction(const Correction& correction, double wall_s) override;
  bool adopt_cut(CutRole from) override;
  void save_verdicts(const std::optional<Verdict>& of_planned, const std::optional<Verdict>& of_corrected) override;

  /// Adds what an earlier `assess` of this folder advised against the path: as planned, that the simulation is not to
  /// be used; corrected, anything but to compensate.
  void add_advice_to(Verdict& verdict, bool is_corrected) const;

  /// Removes a program that was made with other settings or inputs than the case's, and the verdict in the file of a
  /// correction that was judged by other limits: neither may pass for one of this case. Says so. @throws DataError
  /// where an input cannot be read.
  void remove_what_is_out_of_date(Monitor& monitor);

  /// Where the checkpoint of a cut is, if there is one.
  [[nodiscard]] std::filesystem::path checkpoint(CutRole role) const;
  /// The checkpoint that this store wrote last; empty: none, or its cut was finished since.
  [[nodiscard]] const std::filesystem::path& last_checkpoint() const { return last_checkpoint_; }
  /// Asks for a checkpoint from which a cut of this case can go on. @throws DataError naming both when it is of another case, other
  /// settings, inputs or build, or damaged. @pre checkpoint(role) exists.
  void require_fitting_checkpoint(CutRole role);

  /// Of the case, or of its scan or mesh. @throws DataError where that cannot be read.
  [[nodiscard]] std::string specimen_id();
  /// A manifest for an output folder of this study. @param verdict  of the run; null: the folder has none.
  void write_manifest_to(const std::filesystem::path& folder, double wall_s, const Verdict* verdict = nullptr);

 private:
  [[nodiscard]] ToolPath with_specimen(ToolPath path);
  [[nodiscard]] const std::string& key(Product product);
  [[nodiscard]] std::string settings_with(const std::vector<std::string>& prefixes, const std::vector<std::string>& but) const;
  [[nodiscard]] std::string input_hash(const std::filesystem::path& path);
  /// Hash of the settings that a cut is judged by once it is made.
  [[nodiscard]] std::string judgement_key() const;
  [[nodiscard]] bool is_judged_anew(Product product);
  /// Writes what a cut that is judged by the case's settings now says of itself.
  void write_judged_anew(Product product, const nlohmann::ordered_json& incision);
  /// @throws DataError naming a file of the product that was changed, added or removed since it was written.
  void require_unchanged(Product product);
  [[nodiscard]] Manifest manifest_now(double wall_s);
  /// Whether a result's manifest has the settings, inputs, version and specimen that this case has now.
  [[nodiscard]] bool is_made_as_now(const std::filesystem::path& result);
  /// Made, and from other settings or inputs than the case's.
  [[nodiscard]] bool is_stale(Product product);
  void remove_checkpoints_of_no_use(Product saved);
  /// What the cuts on the way to the correction left, once there is a corrected one.
  void remove_passes();
  void remove_what_it_was_made_from(CutRole role);
  void save(Product product, double wall_s, const std::function<void(const std::filesystem::path&)>& write);

  CaseFile file_;
  std::filesystem::path root_;
  RunContext context_;
  std::chrono::duration<double> checkpoint_period_;
  std::chrono::steady_clock::time_point last_kept_ = std::chrono::steady_clock::now();
  std::filesystem::path last_checkpoint_;
  std::array<std::string, kProductCount> keys_;          ///< empty: not computed yet
  std::map<std::filesystem::path, std::string> hashes_;  ///< of input files
};

/// The rest mesh with what a deformation did to it: point data `displacement_mm` and `position_mm`, cell data `von_mises_kpa`.
[[nodiscard]] TetMesh deformed_mesh(const TissueModel& model, const TissueState& state);

}  // namespace incise
