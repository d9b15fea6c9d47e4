#include "calls.hpp"

#include "arguments.hpp"
#include "command_line.hpp"

#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/core/verdict.hpp>
#include <incise/cutting/divided_mesh.hpp>
#include <incise/geometry/iso_surface.hpp>
#include <incise/imaging/scan_checks.hpp>
#include <incise/imaging/segmentation.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/laboratory/bench_steps.hpp>
#include <incise/steps/case_steps.hpp>
#include <incise/steps/tissue_steps.hpp>
#include <incise/storage/case_edit.hpp>
#include <incise/storage/case_run.hpp>
#include <incise/workflow/cut_doubts.hpp>
#include <incise/workflow/margin_room.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace incise::studio {
namespace fs = std::filesystem;
namespace {

using Json = Calls::Json;

constexpr double kEdgeStepMm = 1.0;            // spacing of points of a drawn edge
constexpr double kMomentS = 1.0;               // least time between two pictures of a running cut
constexpr double kMomentShare = 0.04;          // greatest share of the time that they take
constexpr std::size_t kMostEdgePoints = 2000;  // greatest number that a person draws
constexpr std::string_view kDrawnEdge = "tumor_edge";

/// Returns a plain name for a new folder.
std::string folder_name(const Json& arguments) {
  std::string name = text_argument(arguments, "name");
  const bool is_plain = !name.empty() && name.size() <= 100 && !name.starts_with('.') &&
                        name.find_first_of(std::string("/\\\0", 3)) == std::string::npos &&
                        std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < 32; });
  if (!is_plain)
    throw CaseError("request", "name", "'" + name.substr(0, 100) + "'",
                    "a folder name without '/', and without '.' at its start");
  return name;
}

/// Returns a folder that does not exist yet.
fs::path new_folder(const fs::path& parent, const std::string& name) {
  fs::path folder = parent / name;
  if (fs::exists(fs::symlink_status(folder)))
    throw CaseError("request", "name", "'" + name + "', which already exists", "a new name");
  return folder;
}

CaseChanges changes_of(const Json& arguments, const char* name) {
  CaseChanges changes;
  const Json values = arguments.value(name, Json::object());
  if (!values.is_object())
    throw CaseError("request", name, values.dump().substr(0, 80), "an object of keys and values");
  for (const auto& [key, value] : values.items()) changes[key] = value;
  return changes;
}

Json inputs_json(const CaseFile& file) {
  const CaseInputs& in = file.inputs;
  Json json = Json::object();
  for (const auto& [key, path] :
       {std::pair{"ct.volume", &in.ct_volume}, std::pair{"ct.labels", &in.ct_labels},
        std::pair{"specimen.mesh", &in.specimen_mesh}, std::pair{"tumor.contour", &in.tumor_contour},
        std::pair{"tumor.surface", &in.tumor_surface},
        std::pair{"specimen.material.elasticity_map", &in.elasticity_map}, std::pair{"plan.line", &in.line_contour},
        std::pair{"path", &in.tool_path}}) {
    json[key] = path->empty() ? Json(nullptr) : Json(path->lexically_proximate(file.folder).string());
  }
  return json;
}

std::string joined(const std::string& group, const std::string& name) {
  return group.empty() ? name : group + "." + name;
}

/// Returns settings with their types, without those that a person cannot set. @param known  the keys of the case file.
Json settings_json(const Json& all, const std::set<std::string>& known, const std::string& group) {
  Json kept = Json::object();
  for (const auto& [name, value] : all.items()) {
    const std::string key = joined(group, name);
    if (known.contains(key)) {
      kept[name] = value;
    } else if (value.is_object()) {
      Json inner = settings_json(value, known, key);
      if (!inner.empty()) kept[name] = std::move(inner);
    }
  }
  return kept;
}

/// Adds the choices of each field that has a list of them, by its key.
void add_choices(const Json& properties, const std::string& group, Json& choices) {
  for (const auto& [name, field] : properties.items()) {
    const std::string key = joined(group, name);
    if (field.contains("enum")) choices[key] = field.at("enum");
    if (field.contains("properties")) add_choices(field.at("properties"), key, choices);
  }
}

Json choices_json() {
  Json choices = Json::object();
  add_choices(Json::parse(case_schema_json()).at("properties"), "", choices);
  return choices;
}

/// Returns the edge that the case names; null if there is none or its file cannot be read (the call `plan` reports
/// why).
Json edge_json(const CaseFile& file) {
  if (file.inputs.tumor_contour.empty()) return nullptr;
  try {
    return {{"points_mm", points_json(read_contour(file.inputs.tumor_contour).points)},
            {"configuration", to_string(file.settings.tumor_configuration)}};
  } catch (const DataError&) {
    return nullptr;
  }
}

Json case_json(const CaseFile& file) {
  std::set<std::string> known;
  Json units = Json::object();
  for (const SettingLine& line : settings_of(file)) {
    known.insert(line.key);
    if (!line.unit.empty()) units[line.key] = line.unit;
  }
  Json json;
  json["title"] = file.settings.title;
  json["file"] = file.file.string();
  json["is_virtual"] = file.settings.is_virtual;
  json["revision"] = case_revision(file.file);
  json["settings"] = settings_json(to_json(file), known, "");
  json["inputs"] = inputs_json(file);
  json["units"] = std::move(units);
  json["choices"] = choices_json();
  json["edge"] = edge_json(file);
  json["default_hold"] = default_hold_in_words();
  return json;
}

/// Returns the values of a label volume other than 0, and the number of voxels of each.
Json label_counts(const LabelVolume& labels) {
  std::array<std::size_t, 256> counts{};
  for (const std::uint8_t label : labels.voxels) ++counts[label];
  Json json = Json::array();
  for (std::size_t value = 1; value < counts.size(); ++value) {
    if (counts[value] > 0) json.push_back({{"value", value}, {"voxels", counts[value]}});
  }
  return json;
}

/// A closed edge that a person draws.
Contour edge_argument(const Json& arguments) {
  Contour drawn{points_argument(arguments, "points_mm"), true};
  if (drawn.points.size() < 3 || drawn.points.size() > kMostEdgePoints)
    throw CaseError("request", "points_mm", fmt::format("{} points", drawn.points.size()),
                    fmt::format("3 to {} points", kMostEdgePoints));
  const double length = length_mm(drawn);
  if (!(length > 1.0 && length < 1000.0))
    throw CaseError("request", "points_mm", fmt::format("an edge of {:.1f} mm", length),
                    "a closed edge of 1 to 1000 mm");
  return drawn;
}

/// Returns a free name for a drawn edge, so no edge is ever lost.
fs::path file_for_edge(const CaseFile& file) {
  for (int k = 1;; ++k) {
    fs::path name =
        file.folder / (k == 1 ? fmt::format("{}.csv", kDrawnEdge) : fmt::format("{}_{}.csv", kDrawnEdge, k));
    if (!fs::exists(fs::symlink_status(name))) return name;
  }
}

std::set<fs::path> files_of(const CaseFile& file) {
  const CaseInputs& in = file.inputs;
  std::set<fs::path> files{in.ct_volume,     in.ct_labels,      in.specimen_mesh, in.tumor_contour,
                           in.tumor_surface, in.elasticity_map, in.line_contour,  in.tool_path};
  files.insert(in.holders.begin(), in.holders.end());
  return files;
}

/// Requires that a change names only files that the case already names, in the case's folder, or chosen by their ids.
void require_known_files(const CaseFile& before, const CaseFile& after, const std::set<fs::path>& chosen) {
  const std::set<fs::path> known = files_of(before);
  const fs::path folder = fs::weakly_canonical(after.folder);
  for (const fs::path& file : files_of(after)) {
    const fs::path real = fs::weakly_canonical(file);
    const bool is_in_folder =
        std::mismatch(folder.begin(), folder.end(), real.begin(), real.end()).first == folder.end();
    if (file.empty() || known.contains(file) || is_in_folder || chosen.contains(real)) continue;
    throw CaseError("request", "set", "'" + file.string() + "', a file outside the case's folder",
                    "a file that was chosen from the list");
  }
}

MadeSkin made_skin_of(const Study& study) {
  return study.segmentation ? MadeSkin(*study.segmentation) : MadeSkin();
}

/// Names a cut of a run for a person. @param cut  as_planned, pass_1 …, corrected.
std::string part_of_run(const std::string& cut) {
  for (int pass = 1; pass <= kMostPasses; ++pass) {
    if (cut == name_of_pass(pass))
      return fmt::format("pass {} of at most {}", pass, pass <= kUsualPasses ? kUsualPasses : kMostPasses);
  }
  return cut == name_of_pass(0) ? "as planned" : cut;
}

}  // namespace

Calls::Calls(const fs::path& blobs, Monitor& monitor, Watchers watchers)
    : blobs_(blobs), monitor_(monitor), watchers_(std::move(watchers)) {}

RunContext Calls::context(std::uint64_t seed) const {
  return {"incise studio", seed, workers_.thread_count()};
}

fs::path laid_folder(const CaseFile& file, PathKind kind) {
  return file.folder / (kind == PathKind::Mark ? "mark_on_tissue" : "on_tissue");
}

void remove_laid(const CaseFile& file) {
  for (const PathKind kind : {PathKind::Incise, PathKind::Mark}) remove_replaceable(laid_folder(file, kind));
}

namespace {

/// Whether the laid path is of the case and of the files as they are now. @param note  laid.json
bool is_of_now(const CaseFile& file, const Json& note) {
  if (!note.is_object() || note.value("case_sha256", "") != case_revision(file.file)) return false;
  const Json inputs = note.value("inputs", Json::object());
  for (const auto& [input, sha256] : inputs.items()) {
    if (!fs::is_regular_file(input) || sha256 != sha256_of_file(input)) return false;
  }
  return true;
}

}  // namespace

void remove_stale_laid(const CaseFile& file) {
  for (const PathKind kind : {PathKind::Incise, PathKind::Mark}) {
    const fs::path note = laid_folder(file, kind) / "laid.json";
    if (!fs::exists(note)) continue;
    if (!is_of_now(file, read_json(note))) remove_replaceable(laid_folder(file, kind));
  }
}

std::vector<std::string> Calls::accepted_in(const Json& arguments) const {
  auto accepted = argument_or<std::vector<std::string>>(arguments, "accept", "a list of ids", {});
  for (const std::string& id : accepted) static_cast<void>(verdict_rule(id));
  if (!accepted.empty() && text_argument(arguments, "revision") != case_revision(file_)) throw StaleRevision(file_);
  return accepted;
}

Json Calls::make(const std::string& name, const fs::path& file, const Json& arguments) {
  using Call = Json (Calls::*)(const Json&);
  static const std::map<std::string, Call> without_case{
      {"open", &Calls::open}, {"create", &Calls::create}, {"demo", &Calls::demo}};
  static const std::map<std::string, Call> of_case{{"case", &Calls::show_case},
                                                   {"change", &Calls::change},
                                                   {"scan", &Calls::scan},
                                                   {"tissue", &Calls::tissue},
                                                   {"edge", &Calls::edge},
                                                   {"room", &Calls::room},
                                                   {"body", &Calls::body},
                                                   {"stretch", &Calls::stretch},
                                                   {"plan", &Calls::plan},
                                                   {"run", &Calls::run},
                                                   {"picture", &Calls::picture},
                                                   {"photograph", &Calls::photograph},
                                                   {"frame", &Calls::frame},
                                                   {"virtual_cloud", &Calls::virtual_cloud},
                                                   {"register", &Calls::register_cloud},
                                                   {"lay", &Calls::lay},
                                                   {"unregister", &Calls::unregister},
                                                   {"arm", &Calls::arm},
                                                   {"report", &Calls::report}};
  file_ = file;
  if (!arguments.is_object()) throw CaseError("request", "", "no object", "the arguments as an object");
  if (const auto call = without_case.find(name); call != without_case.end()) return (this->*call->second)(arguments);
  const auto call = of_case.find(name);
  if (call == of_case.end()) throw CaseError("request", "call", "'" + name.substr(0, 40) + "'", "a call of the studio");
  if (file.empty()) throw CaseError("request", "case", "nothing", "a case that is open");
  return (this->*call->second)(arguments);
}

Json Calls::open(const Json& arguments) {
  return case_json(read_case(text_argument(arguments, "file")));
}

Json Calls::create(const Json& arguments) {
  const auto is_given = [&](const char* name) { return arguments.contains(name); };
  static constexpr std::array kSources{std::pair{"scan", "ct.volume"}, std::pair{"labels", "ct.labels"},
                                       std::pair{"mesh", "specimen.mesh"}, std::pair{"surface", "specimen.mesh"}};
  const auto source = std::ranges::find_if(kSources, [&](const auto& one) { return is_given(one.first); });
  if (source == kSources.end())
    throw CaseError("request", "scan", "nothing", "a scan, labels, a mesh or a surface to make a case of");
  const fs::path given = text_argument(arguments, source->first);
  const std::string name = folder_name(arguments);
  const fs::path folder = new_folder(text_argument(arguments, "folder"), name);
  const bool is_surface = source->first == std::string_view("surface");
  const fs::path body = folder / "body.vtu";
  CaseChanges changes = changes_of(arguments, "settings");
  changes["title"] = name;
  changes[source->second] = (is_surface ? body : given).lexically_proximate(folder).string();
  const std::string text = changed_case(fmt::format("schema: {}\n", kCaseSchemaName), changes);
  const CaseFile made = parse_case(text, folder / "case.yaml");
  require_readable(made, is_surface);
  fs::create_directory(folder);
  try {
    if (is_surface) {
      static_cast<void>(steps::mesh_body({.input = given, .output = body}, {context(), workers_, monitor_}));
    }
    write_atomically(made.file, text);
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(folder, ignored);  // it was made here, and holds nothing else
    throw;
  }
  return case_json(made);
}

Json Calls::demo(const Json& arguments) {
  const std::uint64_t seed = seed_argument(arguments, "seed");
  const fs::path folder = new_folder(text_argument(arguments, "folder"), fmt::format("virtual_tongue_{}", seed));
  static_cast<void>(laboratory::make_phantom_case({.output = folder}, {context(seed), workers_, monitor_}));
  return case_json(read_case(folder));
}

Json Calls::show_case(const Json&) {
  return case_json(read_case(file_));
}

void Calls::require_open(const Json& arguments) const {
  if (arguments.contains("case_file") && text_argument(arguments, "case_file") != file_.string())
    throw StaleRevision(file_);
}

Json Calls::change(const Json& arguments) {
  require_open(arguments);
  const std::string revision = text_argument(arguments, "revision");
  CaseChanges changes = changes_of(arguments, "set");
  const CaseFile before = read_case(file_);
  std::set<fs::path> chosen;
  for (const auto& [key, file] : changes_of(arguments, "files")) {
    chosen.insert(file.get<std::string>());
    changes[key] = fs::path(file.get<std::string>()).lexically_proximate(before.folder).string();
  }
  require_known_files(before, parse_case(changed_case(read_text(file_), changes), file_), chosen);
  const CaseFile changed = change_case(file_, revision, changes);
  remove_stale_laid(changed);
  return case_json(changed);
}

const CtVolume& Calls::ct_of(const CaseFile& file) {
  const fs::path& path = file.inputs.ct_volume;
  if (path.empty()) throw CaseError(file.file.string(), "ct.volume", "nothing", "a CT to look at");
  std::error_code ignored;
  const std::string key = fmt::format("{} {} {}", path.string(), to_json(file.ct_reading).dump(),
                                      fs::last_write_time(path, ignored).time_since_epoch().count());
  if (key != ct_key_) {
    ct_key_.clear();
    ct_ = read_ct(path, file.ct_reading, monitor_).volume;
    of_scan_ = check_scan(ct_);
    ct_key_ = key;
  }
  return ct_;
}

void Calls::require_readable(const CaseFile& made, bool is_made_later) {
  if (!made.inputs.ct_volume.empty()) static_cast<void>(ct_of(made));
  if (!made.inputs.ct_labels.empty()) static_cast<void>(read_labels(made.inputs.ct_labels));
  if (!made.inputs.specimen_mesh.empty() && !is_made_later)
    static_cast<void>(read_tet_mesh(made.inputs.specimen_mesh, monitor_));
}

Json Calls::scan(const Json&) {
  const CaseFile file = read_case(file_);
  const CtVolume& ct = ct_of(file);
  const auto [least, greatest] = std::minmax_element(ct.voxels.begin(), ct.voxels.end());
  return {{"grid", grid_json(ct.grid)},
          {"least_hu", *least},
          {"greatest_hu", *greatest},
          {"voxels", blobs_.put("scan.voxels", std::span<const std::int16_t>(ct.voxels))}};
}

const Calls::Found& Calls::found_in(const CaseFile& file) {
  const SegmentationSettings& settings = file.settings.segmentation;
  const bool is_drawn = !file.inputs.ct_labels.empty();  // read each time: it may consist of several files
  if (!is_drawn) static_cast<void>(ct_of(file));         // likewise the CT, if it has changed
  const std::string key = is_drawn ? std::string() : ct_key_ + to_json(settings).dump();
  if (!key.empty() && key == found_key_) return found_;
  found_key_.clear();
  found_ = {};
  if (is_drawn) {
    const LabelVolume labels = read_labels(file.inputs.ct_labels);
    found_.given_labels = label_counts(labels);
    found_.tissue = segment_labels(labels, settings, workers_, monitor_);
  } else {
    found_.tissue = segment(ct_, settings, workers_, monitor_, of_scan_);
  }
  found_.skin = iso_surface(found_.tissue.occupancy, 0.5);
  found_key_ = key;
  return found_;
}

Json Calls::tissue(const Json&) {
  const CaseFile file = read_case(file_);
  const auto& [found, skin, given_labels] = found_in(file);
  const std::vector<std::uint8_t> cut = cut_triangles(MadeSkin(found), skin.vertices, skin.triangles);
  Json summary = to_json(found);
  summary.erase("verdict");
  return {{"grid", grid_json(found.labels.grid)},
          {"labels", blobs_.put("tissue.labels", std::span<const std::uint8_t>(found.labels.voxels))},
          {"skin", surface_json(blobs_, "tissue.skin", skin.vertices, skin.triangles)},
          {"cut", blobs_.put("tissue.cut", std::span<const std::uint8_t>(cut))},
          {"given_labels", given_labels},
          {"summary", std::move(summary)},
          {"verdict", to_json(found.verdict)}};
}

PlacedSkin Calls::skin_at_rest(const CaseFile& file) {
  if (file.inputs.specimen_mesh.empty()) {
    const Found& found = found_in(file);
    return {found.skin, found.skin.vertices, MadeSkin(found.tissue)};
  }
  const TriMesh skin = boundary_surface(read_tet_mesh(file.inputs.specimen_mesh, monitor_));
  return {skin, skin.vertices, MadeSkin()};
}

Json Calls::room(const Json& arguments) {
  const CaseFile file = read_case(file_);
  PlanSettings plan = file.settings.plan;
  if (plan.kind == PlanKind::Line) plan.waypoints = PlanSettings{}.waypoints;
  plan.kind = PlanKind::Ring;
  const Contour drawn = edge_argument(arguments);
  const PlacedSkin skin = skin_at_rest(file);
  const auto is_cut = [&](const Vec3& place) { return skin.cut_at(place).has_value(); };
  Json json{{"ring", nullptr}, {"on_cut_face", Json::array()}, {"edge_on_cut_face", 0}, {"problem", nullptr}};
  add_room({}, json);
  json["fits"] = false;
  json["painted"] = 0;
  try {
    const Contour edge = project_tumor_edge(drawn, skin.surface(), plan.approach, file.settings.surface_tolerance_mm);
    json["edge_on_cut_face"] = std::ranges::count_if(edge.points, is_cut);
    add_room(margin_room(skin, edge, plan, radius_mm(file.settings.tool)), json);
    const Points ring = entry_contour(plan_ring(skin.surface(), edge, plan)).points;
    json["ring"] = points_json(ring);
    for (const Vec3& place : ring) json["on_cut_face"].push_back(is_cut(place) ? 1 : 0);
    json["painted"] = std::ranges::count_if(ring, [&](const Vec3& place) { return skin.is_painted(place); });
    json["fits"] = std::ranges::none_of(ring, is_cut) && std::ranges::none_of(edge.points, is_cut);
  } catch (const CaseError& error) {  // also an answer: this margin, or this edge, does not fit
    json["problem"] = sentence(error.problem());
  }
  return json;
}

Json Calls::edge(const Json& arguments) {
  require_open(arguments);
  const CaseFile file = read_case(file_);
  const Contour drawn = edge_argument(arguments);
  const std::string revision = text_argument(arguments, "revision");
  if (revision != case_revision(file_)) throw StaleRevision(file_);
  const auto count = static_cast<std::size_t>(std::ceil(length_mm(drawn) / kEdgeStepMm));
  const fs::path target = file_for_edge(file);
  const CaseChanges changes{{"tumor.contour", target.lexically_proximate(file.folder).string()},
                            {"tumor.configuration", text_argument(arguments, "configuration")}};
  static_cast<void>(parse_case(changed_case(read_text(file_), changes), file_));  // before anything is written
  remove_laid(file);                                                              // of another edge
  write_contour_csv(target, resample(drawn, std::max<std::size_t>(count, drawn.points.size())));
  try {
    return case_json(change_case(file_, revision, changes));
  } catch (...) {
    std::error_code ignored;
    fs::remove(target, ignored);
    throw;
  }
}

Study Calls::study_until(Stage until) {
  CaseFile file = read_case_with_inputs(file_);
  remove_stale_laid(file);
  RunOptions options;
  options.until = until;
  CaseRun run(std::move(file), output_beside(file_), options, context());
  return run.study(workers_, monitor_);
}

Json Calls::body(const Json&) {
  const Study study = study_until(Stage::Mesh);
  const TissueModel& model = *study.model;
  const Skin skin = skin_of(model.mesh);
  const std::vector<std::uint8_t> held = held_by(skin, model);
  const Points at_rest = positions_on(skin, model.mesh.vertices);
  const std::vector<std::uint8_t> cut = cut_triangles(made_skin_of(study), at_rest, skin.triangles);
  return {{"tets", model.mesh.tets.size()},
          {"skin", surface_json(blobs_, "body.skin", at_rest, skin.triangles)},
          {"cut", blobs_.put("body.cut", std::span<const std::uint8_t>(cut))},
          {"held", blobs_.put("body.held", std::span<const std::uint8_t>(held))},
          {"constraints", constraints_json(model)}};
}

Json Calls::stretch(const Json&) {
  const Study study = study_until(Stage::Stretch);
  const StaticResult& stretched = *study.stretched;
  const Skin skin = skin_of(study.model->mesh);
  return {
      {"outcome", to_string(stretched.outcome)},
      {"note", explain_stretch(stretched)},
      {"greatest_mm", stretched.max_displacement_mm},
      {"rest", blobs_.put("stretch.rest", positions_on(skin, study.model->mesh.vertices))},
      {"skin", surface_json(blobs_, "stretch.skin", positions_on(skin, stretched.state.positions), skin.triangles)}};
}

Json Calls::plan(const Json&) {
  const CaseFile file = read_case(file_);
  const Study study = study_until(Stage::Plan);
  if (!study.plan)
    throw CaseError(file_.string(), "specimen.constraints", explain_stretch(*study.stretched),
                    "a stretch that comes to rest");
  Verdict verdict = study.about_inputs;
  const MadeSkin made = made_skin_of(study);
  const Points& stretched = study.stretched->state.positions;
  verdict.add(verdict_before_cut(file.settings, *study.model, made, stretched, *study.plan));
  Json json{{"path", tool_path_json(*study.plan)},
            {"edge", points_json(study.plan->tumor_edge.points)},
            {"verdict", to_json(verdict)}};
  if (file.settings.plan.kind == PlanKind::Ring) {
    const PlacedSkin skin(boundary_surface(study.model->mesh), stretched, made);
    add_room(margin_room(skin, study.plan->tumor_edge, file.settings.plan, radius_mm(file.settings.tool)), json);
  }
  return json;
}

void Calls::show_moment(const std::string& cut, const TissueModel& model, const IncisionProgress& progress) {
  watchers_.on_part(part_of_run(cut));
  const auto now = std::chrono::steady_clock::now();
  const double pause_s = std::max(kMomentS, moment_cost_s_ / kMomentShare);
  if (!shows_moments_ || std::chrono::duration<double>(now - last_moment_).count() < pause_s) return;
  last_moment_ = now;
  try {
    send_moment(cut, model, progress.state);
  } catch (const std::exception& error) {  // no memory for its arrays: a cut does not end because a picture is missing
    shows_moments_ = false;
    monitor_.message(Severity::Warning, fmt::format("{}. The cut continues without pictures", error.what()));
  }
  moment_cost_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - now).count();
}

void Calls::send_moment(const std::string& cut, const TissueModel& model, const CutState& state) {
  const DividedMesh divided = divide_at_kerf(model, state);
  TetMesh mesh;
  mesh.vertices = divided.positions(state.tissue.positions);
  mesh.tets = divided.tets;
  const Skin skin = skin_of(mesh, divided.is_left(state.step));
  watchers_.on_moment(
      {{"cut", cut},
       {"time_s", state.time_s},
       {"tip", points_json(std::array{state.tool.tip_mm}).front()},
       {"removed_tets", state.record.removals.size()},
       {"skin", surface_json(blobs_, "moment.skin", positions_on(skin, mesh.vertices), skin.triangles)}});
}

Json Calls::run(const Json& arguments) {
  shows_moments_ = true;
  const std::vector<std::string> accepted = accepted_in(arguments);
  const fs::path output = output_beside(file_);
  steps::CaseRequest request{read_case_with_inputs(file_), output, {}};
  remove_laid(request.file);  // of an earlier run
  request.options.watch = [this](const auto& cut, const auto& model, const auto& progress) {
    show_moment(cut, model, progress);
  };
  Json json;
  const Case& settings = request.file.settings;
  const auto take = [&](const Run& run) {  // while the run still holds the lock on the folder
    const Study& study = run.study;
    json["verdict"] = to_json(run.verdict);
    json["outcome"] = to_string(study.outcome);
    json["ended"] = ended(study.outcome);
    json["accepted"] = study.is_accepted;
    json["correction_note"] = study.correction_note.empty() ? Json(nullptr) : Json(study.correction_note);
    json["gate"] = run.program ? to_json(run.gate) : Json(nullptr);
    json["checks"] = run.program ? to_json(run.program->checks.checks) : Json(nullptr);
    json["program"] = run.gate.is_open ? Json(read_text(output / "program" / "program.script")) : Json(nullptr);
    json["why_without_program"] = run.why_without_program;
    json["as_planned"] = study.as_planned ? cut_json(settings, *study.as_planned, *study.followed) : Json(nullptr);
    json["corrected"] =
        study.corrected ? cut_json(settings, *study.corrected, study.correction->moves.path) : Json(nullptr);
  };
  const Json done = steps::run_loop(request, accepted, {context(), workers_, monitor_}, take).json;
  json["report"] = done.at("report");
  std::vector<std::string> words{"run", file_.string()};
  for (const std::string& id : accepted) words.insert(words.end(), {"--accept", id});
  json["command"] = command_line(words);
  return json;
}

}  // namespace incise::studio
