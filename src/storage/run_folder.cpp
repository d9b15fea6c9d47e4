#include <incise/core/error.hpp>
#include <incise/core/isa.hpp>
#include <incise/core/version.hpp>
#include <incise/geometry/contour_checks.hpp>
#include <incise/io/abandoned_files.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/entry_folder.hpp>
#include <incise/io/input_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/volume_io.hpp>
#include <incise/storage/result_json.hpp>
#include <incise/storage/run_folder.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>

namespace incise {
namespace {

constexpr const char* kStageFile = "stage.json";
/// The folders of a run's products, each after those that it is made from.
constexpr std::array kProducts{"labels", "mesh", "stretched", "plan", "as_planned", "correction", "corrected"};
/// Folders made from the products.
constexpr std::array kMadeOfThem{"program", "robust", "assessment"};

/// Returns a digest of each file of a product, without the verdict in a path's file, which may change.
nlohmann::ordered_json digests_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> digests;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (!entry.is_regular_file() || name == "manifest.json" || name == kStageFile) continue;
    digests[name] =
        name == "path.json" ? sha256_of_text(path_json(read_tool_path(entry.path()))) : sha256_of_file(entry.path());
  }
  return digests;
}

/// Whether a product's folder exists and was written for that key. @throws DataError if it has that key but a file was
/// changed, removed or added since, because the change may be somebody's work. Added files are ignored, such as a note
/// or a picture, unless their extension is one of the products' formats.
bool is_written(const std::filesystem::path& folder, const std::string& key) {
  if (!std::filesystem::exists(folder / kStageFile)) return false;
  const auto refuse = [&folder](const std::filesystem::path& file, const std::string& found) {
    throw DataError(file, "", found, "the product as it was computed",
                    fmt::format("Remove the folder {} to have it written again", folder.string()));
  };
  nlohmann::ordered_json written, found;
  try {
    const nlohmann::ordered_json stage = read_json(folder / kStageFile);
    if (stage.at("key") != key) return false;
    written = stage.at("files");
    found = digests_in(folder);
  } catch (const DataError& damaged) {
    refuse(damaged.path(), "a damaged file");
  } catch (const nlohmann::json::exception&) {
    refuse(folder / kStageFile, "a damaged file");
  }
  for (const auto& [name, digest] : written.items()) {
    if (!found.contains(name)) refuse(folder / name, "no such file any more");
    if (found.at(name) != digest) refuse(folder / name, "a file that was changed since it was computed");
  }
  for (const auto& [name, digest] : found.items()) {
    const std::string ending = std::filesystem::path(name).extension().string();
    const bool could_be_read =
        ending == ".csv" || ending == ".json" || ending == ".vtu" || ending == ".vtp" || ending == ".nrrd";
    if (could_be_read && !written.contains(name)) refuse(folder / name, "a file that was added since");
  }
  return true;
}

/// Checks that labels lie in a scan. @throws DataError if a labelled voxel lies more than one voxel outside the scan.
void require_inside(const LabelVolume& labels, const std::filesystem::path& file, const VolumeGrid& scan,
                    const std::filesystem::path& scan_file) {
  const Vec3 last(scan.size[0], scan.size[1], scan.size[2]);
  const VolumeGrid& grid = labels.grid;
  for (std::size_t v = 0; v < labels.voxels.size(); ++v) {
    if (labels.voxels[v] == 0) continue;
    const auto [i, j, k] = grid.voxel_at(v);
    const Vec3 world = grid.world_from_index(Vec3(i, j, k));
    const Vec3 at = scan.index_from_world(world);
    if ((at.array() >= -1.0).all() && (at.array() <= last.array()).all()) continue;
    throw DataError(file, "labels", fmt::format("tissue at {:.1f}, {:.1f}, {:.1f} mm", world.x(), world.y(), world.z()),
                    fmt::format("tissue inside the volume {}", scan_file.string()),
                    "Labels and volume must belong to one scan, in one frame");
  }
}

/// Removes the verdict from a path's file. Refusals stay until a run cuts the path again: nobody may accept them.
void take_verdict_from(const std::filesystem::path& file) {
  const Verdict older = read_path_verdict(file);
  if (older.status() != VerdictStatus::Refused) return write_tool_path(file, read_tool_path(file));
  write_tool_path(file, read_tool_path(file),
                  refusals_of(older, "a later run has not yet reached the cut along this path"));
}

}  // namespace

void take_products(const std::filesystem::path& from, const std::filesystem::path& to, Stage until) {
  static_assert(kProducts.size() == kStageNames.size());
  EntryFolder there(from / "cache"), here(to / "cache");
  for (std::size_t i = 0; i <= static_cast<std::size_t>(until); ++i) {
    if (here.holds(kProducts[i])) continue;
    if (const std::optional<std::string> entry = there.load(kProducts[i])) here.save(kProducts[i], *entry);
  }
}

RunFolder::RunFolder(CaseFile file, std::filesystem::path root, RunContext context)
    : file_(std::move(file)),
      root_(std::move(root)),
      context_(std::move(context)),
      cache_(std::make_unique<EntryFolder>(root_ / "cache")) {
  make_folder(root_);
  for (const std::filesystem::path& folder : {root_, root_ / "cache"})
    remove_abandoned_temporaries(folder);  // of a run that was killed
}

bool RunFolder::has_products() const {
  return std::ranges::any_of(kProducts, [this](const char* name) { return std::filesystem::exists(root_ / name); });
}

std::string RunFolder::input_hash(const std::filesystem::path& path) {
  if (path.empty()) return "none";
  std::string& hash = hashes_[path];
  if (hash.empty()) hash = sha256_of_input(path);
  return hash;
}

std::string RunFolder::specimen_id() {
  return specimen_id_of_case(file_, [this](const std::filesystem::path& input) { return input_hash(input); });
}

ToolPath RunFolder::with_specimen(ToolPath path) {
  path.specimen_id = specimen_id();
  path.is_virtual = file_.settings.is_virtual;
  return path;
}

Manifest RunFolder::manifest_now(double wall_s) {
  Manifest manifest;
  manifest.specimen_id = specimen_id();
  manifest.version = version();
  manifest.commit = source_commit();
  manifest.command = context_.command;
  manifest.settings_json = settings_json(file_);
  manifest.seed = context_.seed;
  manifest.threads = context_.threads;
  manifest.instruction_set = to_string(active_isa());
  manifest.wall_s = wall_s;
  manifest.machine = machine_description();
  const CaseInputs& in = file_.inputs;
  std::vector<std::filesystem::path> inputs{file_.file,        in.ct_volume,     in.ct_labels,
                                            in.specimen_mesh,  in.tumor_contour, in.tumor_surface,
                                            in.elasticity_map, in.line_contour,  in.tool_path};
  inputs.insert(inputs.end(), in.holders.begin(), in.holders.end());
  for (const std::filesystem::path& path : inputs) {
    if (!path.empty())
      manifest.inputs.push_back(
          {std::filesystem::absolute(path).lexically_proximate(file_.folder).string(), input_hash(path)});
  }
  return manifest;
}

void RunFolder::write_manifest_to(const std::filesystem::path& folder, double wall_s, const Verdict* verdict) {
  Manifest manifest = manifest_now(wall_s);
  if (verdict != nullptr) manifest.verdict = *verdict;
  write_manifest(folder, manifest);
}

void RunFolder::write(const ProductNote& note, const std::function<void(const std::filesystem::path&)>& fill) {
  const std::filesystem::path target_folder = folder(note.name);
  const auto place = std::ranges::find(kProducts, note.name);
  INCISE_REQUIRE(place != kProducts.end(), fmt::format("expected a product of a run, found '{}'", note.name));
  // The key includes the specimen, which the manifest and the path's file name, although nothing is computed from it.
  const std::string key =
      sha256_of_text(fmt::format("{} {} {}", note.key, specimen_id(), file_.settings.is_virtual ? "virtual" : "real"));
  if (is_written(target_folder, key)) return;
  require_replaceable(target_folder);
  for (auto later = place + 1; later != kProducts.end(); ++later) require_replaceable(folder(*later));
  for (const char* made_of_it : kMadeOfThem) require_replaceable(root_ / made_of_it);
  AtomicFolder target(target_folder);
  fill(target.path());
  write_manifest_to(target.path(), note.wall_s);
  write_json(target.path() / kStageFile, {{"key", key}, {"wall_s", note.wall_s}, {"files", digests_in(target.path())}});
  // Results made from the older product are obsolete, and a report must not mix the two. They are removed first: if the
  // run is killed here, nothing is left that would seem to belong to the new product.
  for (const char* made_of_it : kMadeOfThem) remove_replaceable(root_ / made_of_it);
  for (auto later = place + 1; later != kProducts.end(); ++later) remove_replaceable(folder(*later));
  target.commit();
}

CacheKey RunFolder::key_of_case() {
  const Manifest now = manifest_now(0.0);
  CacheKey key("verdicts");
  key.add_text(now.settings_json).add_text(now.specimen_id);
  for (std::size_t i = 1; i < now.inputs.size(); ++i) key.add_text(now.inputs[i].sha256);  // 0: the case's own file
  return key;
}

bool RunFolder::is_made_as_now(const std::filesystem::path& result) {
  const auto what_was_read = [](const Manifest& manifest) {
    std::string text;
    for (std::size_t i = 1; i < manifest.inputs.size(); ++i)
      text += manifest.inputs[i].sha256 + " ";  // the first is the case's own file
    return text;
  };
  const Manifest now = manifest_now(0.0);
  try {
    const Manifest then = read_manifest(result);
    return nlohmann::json::parse(then.settings_json) == nlohmann::json::parse(now.settings_json) &&
           what_was_read(then) == what_was_read(now) && then.version == now.version && then.commit == now.commit &&
           then.specimen_id == now.specimen_id;
  } catch (const DataError&) {
    return false;
  }
}

void RunFolder::remove_what_is_out_of_date(Stage until, Monitor& monitor) {
  if (has_products() && !std::filesystem::exists(root_ / "cache")) {
    monitor.message(Severity::Notice, fmt::format("{}: its results have no cache beside them, as in version 0.1.0. "
                                                  "All of them are computed again",
                                                  root_.string()));
  }
  // A verdict depends on more than the path; a run that cuts writes it again at its end.
  const bool stays = until < Stage::Simulate && is_own_manifest(root_ / "manifest.json") && is_made_as_now(root_);
  for (const char* product : {"plan", "correction"}) {
    const std::filesystem::path path = folder(product) / "path.json";
    if (stays || !std::filesystem::exists(path) || !std::filesystem::exists(folder(product) / kStageFile)) continue;
    try {
      take_verdict_from(path);
    } catch (const DataError&) {  // damaged: nobody can follow it, and the run refuses it by name
    }
  }
  if (is_own_manifest(root_ / "manifest.json") && !is_made_as_now(root_)) {
    // The summary is of another run: its verdict and program do not belong to this case.
    const std::filesystem::path record = root_ / "study.json";
    nlohmann::ordered_json kept = nlohmann::ordered_json::object();
    if (std::filesystem::exists(record)) {
      const nlohmann::ordered_json older = read_json(record);
      if (older.is_object() && older.contains("case_file")) kept["case_file"] = older.at("case_file");
      write_json(record, kept);
    }
    std::filesystem::remove(root_ / "manifest.json");
  }
  const std::filesystem::path program = root_ / "program";
  if (!is_own_manifest(program / "manifest.json") || is_made_as_now(program)) return;
  remove_replaceable(program);
  monitor.message(Severity::Warning, fmt::format("{}: removed, because the settings, the inputs or their places, or "
                                                 "the version have changed since it was made",
                                                 program.string()));
}

void RunFolder::remove_program_made_without(const Verdict& advice, Monitor& monitor) {
  const std::filesystem::path program = root_ / "program";
  if (advice.reasons().empty() || !is_own_manifest(program / "manifest.json")) return;
  const std::optional<Verdict> known = read_manifest(program).verdict;
  const auto is_known = [&known](const VerdictReason& reason) {
    return known &&
           std::any_of(known->reasons().begin(), known->reasons().end(), [&reason](const VerdictReason& other) {
             return other.id == reason.id && other.message == reason.message;
           });
  };
  if (std::all_of(advice.reasons().begin(), advice.reasons().end(), is_known)) return;
  remove_replaceable(program);
  monitor.message(Severity::Warning,
                  fmt::format("{}: removed, because it was written before this advice", program.string()));
}

void RunFolder::absent(const std::string& name) {
  if (std::filesystem::exists(folder(name) / kStageFile)) remove_replaceable(folder(name));
}

CtVolume RunFolder::read_ct(Monitor& monitor) {
  return incise::read_ct(file_.inputs.ct_volume, file_.ct_reading, monitor).volume;
}

std::optional<LabelVolume> RunFolder::read_labels(Monitor& monitor) {
  const CaseInputs& in = file_.inputs;
  if (in.ct_labels.empty()) return std::nullopt;
  LabelVolume labels = incise::read_labels(in.ct_labels);
  if (!in.ct_volume.empty()) require_inside(labels, in.ct_labels, read_ct(monitor).grid, in.ct_volume);
  return labels;
}

std::optional<TetMesh> RunFolder::read_specimen_mesh(Monitor& monitor) {
  if (file_.inputs.specimen_mesh.empty()) return std::nullopt;
  return incise::read_specimen_mesh(file_, monitor);
}

std::optional<Contour> RunFolder::read_tumor_edge() {
  if (file_.inputs.tumor_contour.empty()) return std::nullopt;
  Contour edge = read_contour(file_.inputs.tumor_contour, true);
  if (const auto problem = size_problem(edge, "a tumour", kLargestTumorMm))
    throw DataError(file_.inputs.tumor_contour, "", problem->found, problem->expected);
  return edge;
}

std::optional<TriMesh> RunFolder::read_tumor_surface() {
  if (file_.inputs.tumor_surface.empty()) return std::nullopt;
  TriMesh surface = read_surface(file_.inputs.tumor_surface);
  require_closed_manifold(surface, file_.inputs.tumor_surface);
  return surface;
}

std::optional<GrayVolume> RunFolder::read_elasticity_map() {
  if (file_.inputs.elasticity_map.empty()) return std::nullopt;
  return read_gray(file_.inputs.elasticity_map);
}

std::optional<Contour> RunFolder::read_line() {
  if (file_.inputs.line_contour.empty()) return std::nullopt;
  return read_contour(file_.inputs.line_contour, false);
}

std::optional<ToolPath> RunFolder::read_given_path() {
  if (file_.inputs.tool_path.empty()) return std::nullopt;
  ToolPath path = read_tool_path(file_.inputs.tool_path);
  require_same_specimen(file_.inputs.tool_path, specimen_id(), "the case's");
  if (path.frame != PathFrame::SimStretched) {
    throw DataError(file_.inputs.tool_path, "frame", std::string(to_string(path.frame)), "sim_stretched");
  }
  return path;
}

std::string RunFolder::scan_digest(Monitor&) {
  const CaseInputs& in = file_.inputs;
  const std::string scan = sha256_of_text(input_hash(in.ct_volume) + bytes_of(file_.ct_reading));
  return in.ct_labels.empty() ? scan : sha256_of_text(scan + input_hash(in.ct_labels));
}

void RunFolder::labels(const ProductNote& note, const Segmentation& segmentation) {
  write(note, [&](const std::filesystem::path& to) {
    write_labels(to / "labels.nrrd", segmentation.labels);
    write_gray(to / "occupancy.nrrd", segmentation.occupancy);
    write_json(to / "segment.json", to_json(segmentation));
  });
}

void RunFolder::mesh(const ProductNote& note, const MeshProduct& product) {
  write(note, [&](const std::filesystem::path& to) {
    write_vtu(to / "mesh.vtu", product.meshing.mesh);
    write_contour_csv(to / "planned_cut_rest.csv", product.planned_cut_rest);
    write_json(to / "quality.json", to_json(product.meshing));
  });
}

void RunFolder::stretched(const ProductNote& note, const TissueModel& model, const StaticResult& result) {
  write(note, [&](const std::filesystem::path& to) {
    TetMesh mesh = model.mesh;
    DataArray displacement{3, {}};
    for (std::size_t v = 0; v < result.state.positions.size(); ++v) {
      const Vec3 moved = result.state.positions[v] - model.mesh.vertices[v];
      displacement.values.insert(displacement.values.end(), {moved.x(), moved.y(), moved.z()});
    }
    mesh.point_data["displacement_mm"] = std::move(displacement);
    mesh.cell_data["von_mises_kpa"] = {1, von_mises_kpa(model, result.state)};
    write_vtu(to / "rest.vtu", mesh);
    mesh.vertices = result.state.positions;
    write_vtu(to / "deformed.vtu", mesh);
    write_json(to / "deform.json", to_json(result));
  });
}

void RunFolder::plan(const ProductNote& note, const ToolPath& path) {
  write(note, [&](const std::filesystem::path& to) {
    write_tool_path(to / "path.json", with_specimen(path));
    write_contour_vtp(to / "path.vtp", entry_contour(path));
    if (!path.tumor_edge.points.empty()) write_contour_csv(to / "tumor_edge.csv", path.tumor_edge);
    write_json(to / "plan.json", plan_summary_json(path));
  });
}

}  // namespace incise
