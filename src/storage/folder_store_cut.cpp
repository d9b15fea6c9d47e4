#include "kerf_files.hpp"
#include "product_reading.hpp"

#include <incise/core/error.hpp>
#include <incise/core/isa.hpp>
#include <incise/core/version.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/pvd_io.hpp>
#include <incise/io/verdict_json.hpp>
#include <incise/storage/checkpoint_file.hpp>
#include <incise/storage/folder_store.hpp>
#include <incise/storage/result_json.hpp>

#include <fmt/format.h>

#include <array>
#include <limits>

namespace incise {
namespace {

/// What a checkpoint says it was made by.
std::string maker() { return fmt::format("incise {} ({}), {}", version(), source_commit().substr(0, 12), to_string(active_isa())); }

std::string short_key(const std::string& key) { return key.substr(0, 12); }



/// The live tets at one moment; the cell array `tet` keeps their place in the uncut mesh.
TetMesh live_mesh(const TetMesh& mesh, const Points& positions, std::span<const std::uint8_t> is_live) {
  TetMesh live;
  live.vertices = positions;
  DataArray place{1, {}};
  for (std::size_t tet = 0; tet < mesh.tets.size(); ++tet) {
    if (is_live[tet] == 0) continue;
    live.tets.push_back(mesh.tets[tet]);
    place.values.push_back(static_cast<double>(tet));
  }
  live.cell_data["tet"] = std::move(place);
  return live;
}

/// The removed tets where they lay before the cut, with when and why they went.
TetMesh removed_mesh(const TetMesh& mesh, const Points& stretched, const CutRecord& record) {
  TetMesh removed;
  std::vector<std::int32_t> place(mesh.vertices.size(), -1);
  DataArray time{1, {}};
  DataArray step{1, {}};
  DataArray loose{1, {}};
  DataArray cause{1, {}};
  for (const Removal& removal : record.removals) {
    Tet tet = mesh.tets[removal.tet.index()];
    for (VertexId& corner : tet) {
      std::int32_t& position = place[corner.index()];
      if (position < 0) {
        position = static_cast<std::int32_t>(removed.vertices.size());
        removed.vertices.push_back(stretched[corner.index()]);
      }
      corner = VertexId(static_cast<std::size_t>(position));
    }
    removed.tets.push_back(tet);
    time.values.push_back(removal.time_s);
    step.values.push_back(removal.step);
    loose.values.push_back(removal.cause == RemovalCause::LooseFragment ? 1.0 : 0.0);
    cause.values.push_back(static_cast<double>(removal.cause));
  }
  removed.cell_data["removed_at_s"] = std::move(time);
  removed.cell_data["step"] = std::move(step);
  removed.cell_data["is_loose_fragment"] = std::move(loose);
  removed.cell_data["cause"] = std::move(cause);
  return removed;
}

RemovalCause cause_from(const nlohmann::ordered_json& json, const std::filesystem::path& file) {
  const int number = json.get<int>();
  for (const RemovalCause cause : kRemovalCauses) {
    if (static_cast<int>(cause) == number) return cause;
  }
  throw DataError(file, "removals", fmt::format("a cause {}", number), "the number of one of removal_causes");
}

/// What was found of mesh and path before the cut is not found again in what the cut left.
void keep_what_was_known_before(const Verdict& kept, Verdict& verdict) {
  for (const VerdictReason& reason : kept.reasons()) {
    if (reason.id == "mesh_resolution" || reason.id == "locking" || reason.id == "platform") verdict.add(reason);
  }
}

/// All numbers of a cut, and how its program ended and what it removed.
nlohmann::ordered_json incision_json(const SimulatedCut& cut) {
  nlohmann::ordered_json json = to_json(cut);
  json["program_outcome"] = to_string(cut.incision.outcome);
  json["removal_columns"] = {"tet", "step", "time_s", "cause", "rest_volume_mm3"};
  json["removal_causes"] = nlohmann::ordered_json::array();  // by the number in the column
  for (const RemovalCause cause : kRemovalCauses) json["removal_causes"].push_back(to_string(cause));
  json["removals"] = nlohmann::ordered_json::array();
  for (const Removal& r : cut.incision.record.removals) {
    json["removals"].push_back({r.tet.value, r.step, r.time_s, static_cast<int>(r.cause), r.rest_volume_mm3});
  }
  return json;
}

/// What each step of the cut did, one line each.
void write_steps(const std::filesystem::path& file, const std::vector<CutStepLog>& steps) {
  write_atomically(file, [&steps](std::ostream& out) {
    out << "time_s,iterations,tets_in_contact,removed,slipped,tool_force_x_mn,tool_force_y_mn,tool_force_z_mn,"
           "tool_torque_x_mn_mm,tool_torque_y_mn_mm,tool_torque_z_mn_mm\n";
    for (const CutStepLog& step : steps) {
      const Vec3& force = step.tool_force_mn;
      const Vec3& torque = step.tool_torque_mn_mm;
      out << fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", step.time_s, step.iterations, step.tets_in_contact, step.removed,
                         step.slipped, force.x(), force.y(), force.z(), torque.x(), torque.y(), torque.z());
    }
  });
}

/// Frames as a ParaView time series, the tool beside them as columns of a table.
void write_frames(const std::filesystem::path& folder, const TetMesh& mesh, const std::vector<CutFrame>& frames) {
  if (frames.empty()) return;
  std::filesystem::create_directories(folder / "frames");
  std::vector<PvdFrame> series;
  nlohmann::ordered_json tools = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const CutFrame& frame = frames[i];
    const std::string name = fmt::format("frames/frame_{:04}.vtu", i);
    write_vtu(folder / name, live_mesh(mesh, frame.positions, frame.is_live));
    series.push_back({frame.time_s, name});
    const Vec3& tip = frame.tool.tip_mm;
    const Vec3& axis = frame.tool.axis;
    const Vec3& heading = frame.tool.heading;
    tools.push_back({{"time_s", frame.time_s},
                     {"is_tool_in", frame.is_tool_in},
                     {"tip_mm", {tip.x(), tip.y(), tip.z()}},
                     {"axis", {axis.x(), axis.y(), axis.z()}},
                     {"heading", {heading.x(), heading.y(), heading.z()}}});
  }
  write_pvd(folder / "frames.pvd", series);
  write_json(folder / "frames" / "tool.json", {{"frames", tools}});
}

}  // namespace

std::filesystem::path FolderStore::checkpoint(CutRole role) const { return folder(product_of(role)).concat(".checkpoint"); }

void FolderStore::require_fitting_checkpoint(CutRole role) {
  const CheckpointFile file(checkpoint(role));
  const std::string& own = key(product_of(role));
  if (file.key() == own) return;
  throw DataError(checkpoint(role), "key", fmt::format("'{}' of a cut made by {}", short_key(file.key()), file.maker()),
                  fmt::format("'{}' of this case, its settings and inputs with {}", short_key(own), maker()),
                  "Go on with the case as it was, or cut from the beginning (without --resume)");
}

std::optional<IncisionProgress> FolderStore::load_progress(CutRole role, const TissueModel& model, Monitor& monitor) {
  last_kept_ = std::chrono::steady_clock::now();
  if (!std::filesystem::exists(checkpoint(role))) return std::nullopt;
  const CheckpointFile file(checkpoint(role));
  if (file.key() == key(product_of(role))) return file.progress(model);
  monitor.message(Severity::Notice,
                  fmt::format("{}: is of other settings or inputs, or of another build ({}); the cut starts from the beginning",
                              checkpoint(role).string(), file.maker()));
  return std::nullopt;
}

void FolderStore::keep_progress(CutRole role, const IncisionProgress& progress, bool is_interrupted) {
  const auto now = std::chrono::steady_clock::now();
  if (!is_interrupted && now - last_kept_ < checkpoint_period_) return;
  write_checkpoint(checkpoint(role), key(product_of(role)), maker(), progress);
  last_kept_ = std::chrono::steady_clock::now();
  last_checkpoint_ = checkpoint(role);
}

void FolderStore::remove_checkpoints_of_no_use(Product saved) {
  for (const CutRole role : kCutRoles) {
    const Product product = product_of(role);
    if (product < saved || !std::filesystem::exists(checkpoint(role))) continue;
    // One whose key fits was made from what was saved just now, too: the same settings and inputs give the same bits.
    if (product != saved && CheckpointFile(checkpoint(role)).key() == key(product)) continue;
    std::filesystem::remove(checkpoint(role));
  }
  last_checkpoint_.clear();
}

std::optional<SimulatedCut> FolderStore::load_cut(CutRole role) {
  const Product product = product_of(role);
  if (!is_current(product)) return std::nullopt;
  remove_what_it_was_made_from(role);  // a run that was killed once it had saved the cut has left it
  return of_earlier_run(folder(product), [&]() -> std::optional<SimulatedCut> {
    require_unchanged(product);
    const std::filesystem::path from = folder(product);
    const nlohmann::ordered_json json = read_json(from / "incision.json");
    IncisionResult incision;
    incision.outcome = read_outcome(json, "program_outcome", from / "incision.json");
    if (!json.at("closed_loop").is_null()) incision.is_closed_loop = json.at("closed_loop").get<bool>();
    if (!json.at("gap_mm").is_null()) incision.gap_mm = json.at("gap_mm").get<double>();
    incision.gap_deg = json.at("gap_deg");
    incision.kerf_width_mm = json.at("kerf_width_mm");
    incision.solver_iterations = json.at("solver_iterations");
    incision.is_at_rest = json.at("at_rest");
    incision.unconverged_steps = json.at("unconverged_steps");
    incision.held_back_vertices = json.at("held_back_vertices");
    incision.inverted_tets = json.at("inverted_tets");
    incision.slipped_bonds = json.at("slipped_bonds");
    incision.peak_tool_force_mn = json.at("peak_tool_force_mn");
    incision.peak_tool_torque_mn_mm = json.at("peak_tool_torque_mn_mm");
    incision.wall_s = json.at("wall_s");
    incision.steps.resize(json.at("steps").get<std::size_t>());
    const bool is_ring = !json.at("closed_loop").is_null();
    const auto contour = [&from](const char* name, bool is_closed) -> std::optional<Contour> {
      if (!std::filesystem::exists(from / name)) return std::nullopt;
      return read_contour(from / name, is_closed);
    };
    incision.centerline = contour("centerline.csv", is_ring);
    incision.inner_edge = contour("inner_edge.csv", true);
    if (auto edge = contour("tumor_edge_final.csv", true)) incision.final_tumor_edge = std::move(*edge);
    incision.kerf = read_kerf_files(from, json, is_ring);
    for (const auto& removal : json.at("removals")) {
      Removal r;
      r.tet = TetId(removal.at(0).get<std::size_t>());
      r.step = removal.at(1);
      r.time_s = removal.at(2);
      r.cause = cause_from(removal.at(3), from / "incision.json");
      r.rest_volume_mm3 = removal.at(4);
      incision.record.removals.push_back(r);
    }
    const ToolPath intended = read_tool_path(folder(Product::Plan) / "path.json");
    // A correction moves waypoints and keeps their speeds and depths, so that all cuts of a study are heated alike.
    const ToolPath heated = read_given_path().value_or(intended);
    SimulatedCut cut = judge(file_.settings, std::move(incision), heated, intended, json.at("tets").get<std::size_t>());
    keep_what_was_known_before(verdict_from_json(json.at("verdict"), from / "incision.json"), cut.verdict);
    if (is_judged_anew(product)) write_judged_anew(product, incision_json(cut));
    return cut;
  });
}

void FolderStore::save_cut(CutRole role, const TissueModel& model, const StaticResult& stretched, const SimulatedCut& cut,
                           double wall_s) {
  save(product_of(role), wall_s, [&](const std::filesystem::path& to) {
    const IncisionResult& incision = cut.incision;
    write_json(to / "incision.json", incision_json(cut));
    write_steps(to / "steps.csv", incision.steps);
    if (incision.centerline) write_contour_csv(to / "centerline.csv", *incision.centerline);
    if (incision.inner_edge) write_contour_csv(to / "inner_edge.csv", *incision.inner_edge);
    if (!incision.final_tumor_edge.points.empty()) write_contour_csv(to / "tumor_edge_final.csv", incision.final_tumor_edge);
    if (!incision.record.removals.empty()) {
      write_vtu(to / "removed.vtu", removed_mesh(model.mesh, stretched.state.positions, incision.record));
    }
    write_kerf_files(to, incision.kerf);
    write_frames(to, model.mesh, incision.frames);
  });
  remove_what_it_was_made_from(role);
}

void FolderStore::remove_what_it_was_made_from(CutRole role) {
  std::filesystem::remove(checkpoint(role));
  if (role == CutRole::Corrected) remove_passes();
}

}  // namespace incise
