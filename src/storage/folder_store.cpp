#include "product_reading.hpp"

#include <incise/core/error.hpp>
#include <incise/core/isa.hpp>
#include <incise/core/version.hpp>
#include <incise/geometry/contour_checks.hpp>
#include <incise/io/abandoned_files.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/input_file.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/verdict_json.hpp>
#include <incise/storage/folder_store.hpp>
#include <incise/storage/result_json.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise {
namespace {

constexpr const char* kStageFile = "stage.json";
constexpr const char* kRewritten = "incision_will_be";  // in stage.json: digest of a file on its way

struct ProductInfo {
  const char* folder;
  std::vector<std::string> settings;  ///< prefixes of the settings that it is made with, beside those of what it is made from
  std::vector<std::string> but = {};  ///< of those, prefixes of settings that it is made without
};

// What is only held against a cut that was made (see FolderStore::judgement_key) makes no cut anew.
const ProductInfo& info(Product product) {
  static const std::array<ProductInfo, kProductCount> kInfo{{
      {"labels", {"ct."}},
      {"mesh",
       {"meshing.", "specimen.", "tumor.", "plan."},
       {"plan.power_w", "plan.speed_mm_s", "plan.close_margin_mm"}},
      {"stretched", {"specimen."}},
      {"plan", {"tumor.", "plan."}, {"plan.power_w", "plan.close_margin_mm"}},
      {"as_planned", {"plan.power_w", "tool.", "cut."}},
      {"pass_1", {"plan.close_margin_mm", "compensation."}},
      {"pass_2", {}},
      {"pass_3", {}},
      {"pass_4", {}},
      {"pass_5", {}},
      {"pass_6", {}},
      {"pass_7", {}},
      {"correction", {}},
      {"corrected", {}},
  }};
  return kInfo[static_cast<std::size_t>(product)];
}

bool is_cut(Product product) {
  return product != Product::Correction && product >= Product::AsPlanned;
}

/// The case without the names of its files: what is in them counts, not where they lie.
CaseFile without_paths(CaseFile file) {
  file.inputs = {};
  if (!file.settings.constraints) return file;
  for (Constraint& constraint : *file.settings.constraints) {
    auto* support = std::get_if<SupportConstraint>(&constraint);
    if (support != nullptr && support->holder) support->holder = std::make_shared<HolderSurface>();
  }
  return file;
}

/// Digest of each file of a product. The verdict in a path's file comes and goes: it is left out.
nlohmann::ordered_json digests_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> digests;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (!entry.is_regular_file() || name == "manifest.json" || name == kStageFile) continue;
    digests[name] =
        name == "path.json" ? sha256_of_text(to_json(read_tool_path(entry.path()))) : sha256_of_file(entry.path());
  }
  return digests;
}

Vec3 vector_from(const nlohmann::ordered_json& json) {
  return Vec3(json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>());
}

}  // namespace

FolderStore::FolderStore(CaseFile file, std::filesystem::path root, RunContext context, double checkpoint_s)
    : file_(std::move(file)), root_(std::move(root)), context_(std::move(context)), checkpoint_period_(checkpoint_s) {
  std::error_code error;
  std::filesystem::create_directories(root_, error);
  if (error || !std::filesystem::is_directory(root_)) {
    throw DataError(root_, "", error ? error.message() : "something that is not a folder", "a folder that can be written");
  }
  remove_abandoned_temporaries(root_);  // a run that was killed while it wrote
}

std::filesystem::path FolderStore::folder(Product product) const { return root_ / info(product).folder; }

std::string FolderStore::settings_with(const std::vector<std::string>& prefixes, const std::vector<std::string>& but) const {
  const auto starts_with_one = [](const std::string& key, const std::vector<std::string>& list) {
    return std::any_of(list.begin(), list.end(), [&key](const std::string& prefix) { return key.starts_with(prefix); });
  };
  std::string text;
  for (const SettingLine& line : settings_of(without_paths(file_))) {
    if (starts_with_one(line.key, prefixes) && !starts_with_one(line.key, but)) text += fmt::format("{}={}\n", line.key, line.value);
  }
  return text;
}

std::string FolderStore::input_hash(const std::filesystem::path& path) {
  if (path.empty()) return "none";
  std::string& hash = hashes_[path];
  if (hash.empty()) hash = std::filesystem::is_directory(path) ? sha256_of_folder(path) : sha256_of_input(path);
  return hash;
}

std::string FolderStore::specimen_id() {
  if (!file_.settings.specimen_id.empty()) return file_.settings.specimen_id;
  const std::filesystem::path& mesh = file_.inputs.specimen_mesh;
  if (mesh.empty())
    return file_.inputs.ct_volume.empty() ? "" : specimen_id_of_scan(input_hash(file_.inputs.ct_volume));
  const std::string stated = specimen_id_of(mesh);
  return stated.empty() ? specimen_id_of_mesh(input_hash(mesh)) : stated;
}

ToolPath FolderStore::with_specimen(ToolPath path) {
  path.specimen_id = specimen_id();
  path.is_virtual = file_.settings.is_virtual;
  return path;
}

const std::string& FolderStore::key(Product product) {
  std::string& key = keys_[static_cast<std::size_t>(product)];
  if (!key.empty()) return key;
  // Each product depends on the one before it; the code's own version is part of the first key, and so of all. Where the case names a
  // mesh, nothing is segmented or meshed.
  const bool is_skipped = !file_.inputs.specimen_mesh.empty() && product <= Product::Mesh;
  std::string text = info(product).folder;
  if (!is_skipped) text += settings_with(info(product).settings, info(product).but);
  if (product == Product::Labels) {
    text += fmt::format("{} {} ct={} mesh={}", version(), source_commit(), input_hash(file_.inputs.ct_volume),
                        input_hash(file_.inputs.specimen_mesh));
  } else {
    text += this->key(static_cast<Product>(static_cast<int>(product) - 1));
  }
  if ((product == Product::Mesh && !is_skipped) || product == Product::Plan) {
    text += fmt::format(" tumor={} line={}", input_hash(file_.inputs.tumor_contour), input_hash(file_.inputs.line_contour));
  }
  if (product == Product::Plan)  // its path states them
    text += fmt::format(" specimen={} virtual={}", specimen_id(), file_.settings.is_virtual);
  if (product == Product::Mesh) {
    // Kernels of two instruction sets round differently: a study keeps to one, from the survey of the planned cut on.
    text += fmt::format(" isa={}", to_string(active_isa()));
    for (const std::filesystem::path& holder : file_.inputs.holders) text += fmt::format(" holder={}", input_hash(holder));
  }
  if (product == Product::AsPlanned) {
    text += fmt::format(" path={} tumor_surface={}", input_hash(file_.inputs.tool_path), input_hash(file_.inputs.tumor_surface));
  }
  key = sha256_of_text(text);
  return key;
}

bool FolderStore::is_current(Product product) {
  const std::filesystem::path stage = folder(product) / kStageFile;
  if (!std::filesystem::exists(stage)) return false;
  const nlohmann::ordered_json json = of_earlier_run(folder(product), [&] { return read_json(stage); });
  return json.is_object() && json.contains("key") && json.at("key").is_string() && json.at("key") == key(product) &&
         json.contains("files") && json.at("files").is_object();
}

Manifest FolderStore::manifest_now(double wall_s) {
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
  std::vector<std::filesystem::path> inputs{file_.file, in.ct_volume, in.specimen_mesh, in.tumor_contour, in.tumor_surface, in.line_contour, in.tool_path};
  inputs.insert(inputs.end(), in.holders.begin(), in.holders.end());
  for (const std::filesystem::path& path : inputs) {
    if (!path.empty()) manifest.inputs.push_back({std::filesystem::absolute(path).lexically_proximate(file_.folder).string(), input_hash(path)});
  }
  return manifest;
}

void FolderStore::write_manifest_to(const std::filesystem::path& folder, double wall_s, const Verdict* verdict) {
  Manifest manifest = manifest_now(wall_s);
  if (verdict != nullptr) manifest.verdict = *verdict;
  write_manifest(folder, manifest);
}

void FolderStore::save(Product product, double wall_s, const std::function<void(const std::filesystem::path&)>& write) {
  require_replaceable(folder(product));
  for (int later = static_cast<int>(product) + 1; later <= static_cast<int>(Product::Corrected); ++later) {
    if (is_stale(static_cast<Product>(later))) require_replaceable(folder(static_cast<Product>(later)));
  }
  for (const char* made_of_it : {"program", "robust", "assessment"}) require_replaceable(root_ / made_of_it);
  AtomicFolder target(folder(product));
  write(target.path());
  write_manifest_to(target.path(), wall_s);
  nlohmann::ordered_json stage{{"key", key(product)}, {"wall_s", wall_s}, {"files", digests_in(target.path())}};
  if (is_cut(product)) stage["judged_by"] = judgement_key();
  write_json(target.path() / kStageFile, stage);
  // What was made from the older product is of no use any more, and a report must not mix the two. A later product has a key that tells
  // its age; the others have none and go first: a run that is killed here leaves nothing that would look like the new product's.
  for (const char* made_of_it : {"program", "robust", "assessment"}) remove_replaceable(root_ / made_of_it);
  target.commit();
  for (int later = static_cast<int>(product) + 1; later <= static_cast<int>(Product::Corrected); ++later) {
    if (is_stale(static_cast<Product>(later))) remove_replaceable(folder(static_cast<Product>(later)));
  }
  remove_checkpoints_of_no_use(product);
}

std::string FolderStore::judgement_key() const { return sha256_of_text(settings_with({"thermal.", "plan.close_margin_mm"}, {})); }

void FolderStore::write_judged_anew(Product product, const nlohmann::ordered_json& incision) {
  const std::filesystem::path name = "incision.json";
  const std::filesystem::path stage_file = folder(product) / kStageFile;
  // First the digest that the file will have: a run that is killed in between leaves a file that fits one of the two.
  nlohmann::ordered_json stage = read_json(stage_file);
  stage[kRewritten] = sha256_of_text(json_text(incision));
  write_json(stage_file, stage);
  write_json(folder(product) / name, incision);
  // The manifest lists the folder's files as its older self did: only the settings are others now.
  const std::filesystem::path manifest = folder(product) / "manifest.json";
  nlohmann::ordered_json json = read_json(manifest);
  json["settings"] = nlohmann::ordered_json::parse(settings_json(file_));
  write_json(manifest, json);
  stage["files"][name.string()] = stage[kRewritten];
  stage.erase(kRewritten);
  stage["judged_by"] = judgement_key();
  write_json(stage_file, stage);
}

void FolderStore::require_unchanged(Product product) {
  const std::filesystem::path of = folder(product);
  const nlohmann::ordered_json stage = read_json(of / kStageFile);
  const nlohmann::ordered_json found = digests_in(of);
  const auto refuse = [&of](const std::string& name, const char* what) {
    throw DataError(of / name, "", what, "the product as it was computed");
  };
  for (const auto& [name, digest] : stage.at("files").items()) {
    if (!found.contains(name)) refuse(name, "no such file any more");
    const bool is_rewritten =
        name == "incision.json" && stage.contains(kRewritten) && found.at(name) == stage.at(kRewritten);
    if (found.at(name) != digest && !is_rewritten) refuse(name, "a file that was changed since it was computed");
  }
  // A note or a picture of the user's own does not hurt: what could be read in place of a product would.
  for (const auto& [name, digest] : found.items()) {
    const std::string ending = std::filesystem::path(name).extension().string();
    const bool could_be_read =
        ending == ".csv" || ending == ".json" || ending == ".vtu" || ending == ".vtp" || ending == ".nrrd";
    if (could_be_read && !stage.at("files").contains(name)) refuse(name, "a file that was added since");
  }
}

bool FolderStore::is_made_as_now(const std::filesystem::path& result) {
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

void FolderStore::remove_what_is_out_of_date(Monitor& monitor) {
  const std::filesystem::path program = root_ / "program";
  if (is_own_manifest(program / "manifest.json") && !is_made_as_now(program)) {
    remove_replaceable(program);
    monitor.message(Severity::Warning,
                    fmt::format("{}: removed, it was made with other settings, inputs or version than the case's now",
                                program.string()));
  }
  of_earlier_run(folder(Product::Corrected), [&] {
    const std::filesystem::path path = folder(Product::Correction) / "path.json";
    if (!std::filesystem::exists(folder(Product::Corrected) / kStageFile) || !std::filesystem::exists(path)) return;
    if (is_judged_anew(Product::Corrected)) write_tool_path(path, read_tool_path(path));
  });
}

bool FolderStore::is_judged_anew(Product product) {
  const nlohmann::ordered_json json = read_json(folder(product) / kStageFile);
  return !json.contains("judged_by") || json.at("judged_by") != judgement_key();
}

bool FolderStore::is_stale(Product product) {
  return std::filesystem::exists(folder(product) / kStageFile) && !is_current(product);
}

CtVolume FolderStore::read_ct(Monitor& monitor) {
  return incise::read_ct(file_.inputs.ct_volume, file_.ct_reading, monitor).volume;
}

std::optional<TetMesh> FolderStore::read_specimen_mesh(Monitor& monitor) {
  if (file_.inputs.specimen_mesh.empty()) return std::nullopt;
  return incise::read_specimen_mesh(file_, monitor);
}

std::optional<Contour> FolderStore::read_tumor_edge() {
  if (file_.inputs.tumor_contour.empty()) return std::nullopt;
  Contour edge = read_contour(file_.inputs.tumor_contour, true);
  if (const auto problem = size_problem(edge, "a tumour", kLargestTumorMm))
    throw DataError(file_.inputs.tumor_contour, "", problem->found, problem->expected);
  return edge;
}

std::optional<TriMesh> FolderStore::read_tumor_surface() {
  if (file_.inputs.tumor_surface.empty()) return std::nullopt;
  TriMesh surface = read_surface(file_.inputs.tumor_surface);
  require_closed_manifold(surface, file_.inputs.tumor_surface);
  return surface;
}

std::optional<Contour> FolderStore::read_line() {
  if (file_.inputs.line_contour.empty()) return std::nullopt;
  return read_contour(file_.inputs.line_contour, false);
}

std::optional<ToolPath> FolderStore::read_given_path() {
  if (file_.inputs.tool_path.empty()) return std::nullopt;
  ToolPath path = read_tool_path(file_.inputs.tool_path);
  require_same_specimen(file_.inputs.tool_path, specimen_id(), "the case's");
  if (path.frame != PathFrame::SimStretched) {
    throw DataError(file_.inputs.tool_path, "frame", std::string(to_string(path.frame)), "sim_stretched");
  }
  return path;
}

std::optional<Segmentation> FolderStore::load_segmentation() {
  if (!is_current(Product::Labels)) return std::nullopt;
  return of_earlier_run(folder(Product::Labels), [&]() -> std::optional<Segmentation> {
    require_unchanged(Product::Labels);
    const nlohmann::ordered_json json = read_json(folder(Product::Labels) / "segment.json");
    Segmentation segmentation;
    segmentation.labels = read_labels(folder(Product::Labels) / "labels.nrrd");
    segmentation.occupancy = read_gray(folder(Product::Labels) / "occupancy.nrrd");
    segmentation.voxels = json.at("voxels");
    segmentation.volume_mm3 = json.at("volume_mm3");
    segmentation.occupancy_volume_mm3 = json.at("occupancy_volume_mm3");
    segmentation.tissue_hu = json.at("tissue_hu");
    segmentation.components = json.at("components");
    segmentation.holes_filled = json.at("holes_filled");
    segmentation.verdict = verdict_from_json(json.at("verdict"), folder(Product::Labels) / "segment.json");
    return segmentation;
  });
}

void FolderStore::save_segmentation(const Segmentation& segmentation, double wall_s) {
  save(Product::Labels, wall_s, [&](const std::filesystem::path& to) {
    write_labels(to / "labels.nrrd", segmentation.labels);
    write_gray(to / "occupancy.nrrd", segmentation.occupancy);
    write_json(to / "segment.json", to_json(segmentation));
  });
}

std::optional<TetMesh> FolderStore::load_mesh() {
  if (!is_current(Product::Mesh)) return std::nullopt;
  return of_earlier_run(folder(Product::Mesh), [&]() -> std::optional<TetMesh> {
    require_unchanged(Product::Mesh);
    return read_tet_mesh(folder(Product::Mesh) / "mesh.vtu");
  });
}

void FolderStore::save_mesh(const MeshProduct& product, double wall_s) {
  save(Product::Mesh, wall_s, [&](const std::filesystem::path& to) {
    write_vtu(to / "mesh.vtu", product.meshing.mesh);
    write_contour_csv(to / "planned_cut_rest.csv", product.planned_cut_rest);
    write_json(to / "quality.json", to_json(product.meshing));
  });
}

std::optional<StaticResult> FolderStore::load_stretched(const TissueModel& model) {
  if (!is_current(Product::Stretched)) return std::nullopt;
  return of_earlier_run(folder(Product::Stretched), [&]() -> std::optional<StaticResult> {
    require_unchanged(Product::Stretched);
    const std::filesystem::path file = folder(Product::Stretched) / "deformed.vtu";
    const TetMesh mesh = read_tet_mesh(file);
    const auto array = mesh.point_data.find("position_mm");
    if (array == mesh.point_data.end() || array->second.values.size() != 3 * model.mesh.vertices.size()) {
      throw DataError(file, "point array position_mm", "none that fits the mesh", "3 numbers for each vertex");
    }
    const nlohmann::ordered_json json = read_json(folder(Product::Stretched) / "deform.json");
    StaticResult result;
    result.outcome = read_outcome(json, "outcome", folder(Product::Stretched) / "deform.json");
    result.state = rest_state(model);
    for (std::size_t v = 0; v < result.state.positions.size(); ++v) {
      result.state.positions[v] = Eigen::Map<const Vec3>(array->second.values.data() + 3 * v);
    }
    result.iterations = json.at("iterations");
    result.load_steps = json.at("load_steps");
    if (const auto& residual = json.at("relative_residual"); !residual.is_null()) result.relative_residual = residual;
    result.max_displacement_mm = json.at("max_displacement_mm");
    result.penetration_mm = support_penetration_mm(model, result.state);
    result.inverted_tets = json.at("inverted_tets");
    result.solver = json.at("solver");
    result.wall_s = json.at("wall_s");
    for (const auto& reaction : json.at("reaction_mn")) result.reactions_mn.push_back(vector_from(reaction));
    return result;
  });
}

void FolderStore::save_stretched(const TissueModel& model, const StaticResult& result, double wall_s) {
  save(Product::Stretched, wall_s, [&](const std::filesystem::path& to) {
    write_vtu(to / "deformed.vtu", deformed_mesh(model, result.state));
    write_json(to / "deform.json", to_json(result));
  });
}

TetMesh deformed_mesh(const TissueModel& model, const TissueState& state) {
  TetMesh mesh = model.mesh;
  DataArray displacement{3, {}};
  DataArray position{3, {}};
  for (std::size_t v = 0; v < state.positions.size(); ++v) {
    const Vec3 moved = state.positions[v] - model.mesh.vertices[v];
    displacement.values.insert(displacement.values.end(), {moved.x(), moved.y(), moved.z()});
    const Vec3& p = state.positions[v];
    position.values.insert(position.values.end(), {p.x(), p.y(), p.z()});
  }
  mesh.point_data["displacement_mm"] = std::move(displacement);
  mesh.point_data["position_mm"] = std::move(position);
  mesh.cell_data["von_mises_kpa"] = {1, von_mises_kpa(model, state)};
  return mesh;
}

std::optional<ToolPath> FolderStore::load_plan() {
  if (!is_current(Product::Plan)) return std::nullopt;
  return of_earlier_run(folder(Product::Plan), [&]() -> std::optional<ToolPath> {
    require_path_unchanged(folder(Product::Plan) / "path.json");
    require_unchanged(Product::Plan);
    return read_tool_path(folder(Product::Plan) / "path.json");
  });
}

void FolderStore::save_plan(const ToolPath& path, double wall_s) {
  save(Product::Plan, wall_s, [&](const std::filesystem::path& to) {
    write_tool_path(to / "path.json", with_specimen(path));
    write_contour_vtp(to / "path.vtp", entry_contour(path));
    write_json(to / "plan.json", plan_summary_json(path));
  });
}

}  // namespace incise
