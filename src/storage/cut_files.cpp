#include <incise/core/error.hpp>
#include <incise/core/workers.hpp>
#include <incise/cutting/divided_mesh.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/io/pvd_io.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/table_io.hpp>
#include <incise/mechanics/statics.hpp>
#include <incise/storage/result_json.hpp>
#include <incise/storage/run_folder.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace incise {
namespace {

constexpr int kMostWriters = 4;  // threads that write frames; each has one mesh in memory

/// A cut's tissue for pictures.
struct CutTissue {
  std::unique_ptr<const TissueModel> split;  // null: the cut has not split the mesh
  const TissueModel& model;                  // on the split mesh, or on the whole mesh if there is none
  TissueState stretched;                     // before the cut
  DividedMesh divided;
  std::vector<TetId> whole_tet;  // of each tet of `divided`, its tet in the whole mesh
  [[nodiscard]] bool is_divided() const { return split || !divided.between.empty(); }
};

CutTissue tissue_of(const TissueModel& whole, const TissueState& stretched, const CutState& state) {
  const MeshSplits& splits = state.splits;
  std::unique_ptr<const TissueModel> split;
  if (splits != MeshSplits{}) split = std::make_unique<const TissueModel>(split_model(whole, splits));
  const TissueModel& model = split ? *split : whole;
  CutTissue tissue{std::move(split), model, stretched, divide_at_kerf(whole, state), {}};
  tissue.stretched.positions = split_positions(stretched.positions, splits);
  for (const SplitTet& copy : splits.copies)
    tissue.stretched.rotations.push_back(Mat3(stretched.rotations[copy.whole.index()]));
  tissue.stretched.is_live.resize(model.mesh.tets.size(), 1);
  for (const TetId tet : tissue.divided.split_tet) {
    const std::size_t count = whole.mesh.tets.size();
    tissue.whole_tet.push_back(tet.index() < count ? tet : splits.copies[tet.index() - count].whole);
  }
  return tissue;
}

/// Returns some of the tets, with their indices as cell data: `tet` in the whole mesh and, if the cut has split or
/// divided tets, `cell` among all tets of `tissue.divided`.
TetMesh some_of(const CutTissue& tissue, Points vertices, const std::vector<std::uint8_t>& is_wanted) {
  TetMesh mesh;
  mesh.vertices = std::move(vertices);
  DataArray place{1, {}}, cell{1, {}};
  for (std::size_t t = 0; t < is_wanted.size(); ++t) {
    if (is_wanted[t] == 0) continue;
    mesh.tets.push_back(tissue.divided.tets[t]);
    place.values.push_back(static_cast<double>(tissue.whole_tet[t].index()));
    cell.values.push_back(static_cast<double>(t));
  }
  mesh.cell_data["tet"] = std::move(place);
  if (tissue.is_divided()) mesh.cell_data["cell"] = std::move(cell);
  return mesh;
}

/// Returns the remaining tissue at one moment, deformed. Its stress lacks the viscous part, which frames do not keep.
TetMesh live_mesh(const CutTissue& tissue, const CutFrame& frame) {
  const std::vector<std::uint8_t> is_left = tissue.divided.is_left(frame.step);
  TissueState state = tissue.stretched;
  state.positions = frame.positions;
  std::ranges::fill(state.is_live, 0);
  for (std::size_t t = 0; t < is_left.size(); ++t) {
    if (is_left[t] != 0) state.is_live[tissue.divided.split_tet[t].index()] = 1;
  }
  const std::vector<double> stress = von_mises_kpa(tissue.model, state);
  TetMesh live = some_of(tissue, tissue.divided.positions(frame.positions), is_left);
  DataArray displacement{3, {}}, live_stress{1, {}};
  const Points rest = tissue.divided.positions(tissue.model.mesh.vertices);
  for (std::size_t v = 0; v < rest.size(); ++v) {
    const Vec3 moved = live.vertices[v] - rest[v];
    displacement.values.insert(displacement.values.end(), {moved.x(), moved.y(), moved.z()});
  }
  for (std::size_t t = 0; t < is_left.size(); ++t) {
    if (is_left[t] != 0) live_stress.values.push_back(stress[tissue.divided.split_tet[t].index()]);
  }
  live.point_data["displacement_mm"] = std::move(displacement);
  live.cell_data["von_mises_kpa"] = std::move(live_stress);
  return live;
}

/// Returns all tets in the stretched tissue before the cut, as the cut later divides them.
TetMesh uncut_mesh(const CutTissue& tissue) {
  const DividedMesh& divided = tissue.divided;
  TetMesh mesh =
      some_of(tissue, divided.positions(tissue.stretched.positions), std::vector<std::uint8_t>(divided.tets.size(), 1));
  mesh.cell_data["skin_faces"] = {1, {divided.skin_faces.begin(), divided.skin_faces.end()}};
  mesh.cell_data["gone_step"] = {1, {divided.gone_step.begin(), divided.gone_step.end()}};
  return mesh;
}

/// Returns the removed tets, in order, at their places before the cut, with time and cause of their removal.
TetMesh removed_mesh(const CutTissue& tissue, const std::vector<CutStepLog>& steps) {
  const DividedMesh& divided = tissue.divided;
  std::vector<std::size_t> gone;
  for (std::size_t t = 0; t < divided.tets.size(); ++t) {
    if (divided.gone_step[t] >= 0) gone.push_back(t);
  }
  const auto is_loose = [&](std::size_t t) { return divided.gone_cause[t] == RemovalCause::LooseFragment; };
  std::ranges::stable_sort(gone, {}, [&](std::size_t t) { return std::pair(divided.gone_step[t], is_loose(t)); });
  const Points before = divided.positions(tissue.stretched.positions);
  TetMesh removed;
  std::vector<std::int32_t> place(before.size(), -1);
  DataArray time{1, {}}, step{1, {}}, loose{1, {}}, cause{1, {}};
  for (const std::size_t t : gone) {
    Tet tet = divided.tets[t];
    for (VertexId& corner : tet) {
      std::int32_t& position = place[corner.index()];
      if (position < 0) {
        position = static_cast<std::int32_t>(removed.vertices.size());
        removed.vertices.push_back(before[corner.index()]);
      }
      corner = VertexId(static_cast<std::size_t>(position));
    }
    removed.tets.push_back(tet);
    const auto after = static_cast<std::size_t>(divided.gone_step[t]);
    time.values.push_back(after == 0 ? 0.0 : steps.at(after - 1).time_s);
    step.values.push_back(divided.gone_step[t]);
    loose.values.push_back(is_loose(t) ? 1.0 : 0.0);
    cause.values.push_back(static_cast<double>(divided.gone_cause[t]));
  }
  removed.cell_data["removed_at_s"] = std::move(time);
  removed.cell_data["step"] = std::move(step);
  removed.cell_data["is_loose_fragment"] = std::move(loose);
  removed.cell_data["cause"] = std::move(cause);
  return removed;
}

/// Returns all numbers of a cut, and its removals.
nlohmann::ordered_json incision_json(const SimulatedCut& cut) {
  nlohmann::ordered_json json = to_json(cut);
  json["removal_columns"] = {"tet", "step", "time_s", "cause", "rest_volume_mm3"};
  json["removal_causes"] = nlohmann::ordered_json::array();  // by the number in the column
  for (const std::string_view cause : names_of(RemovalCause{})) json["removal_causes"].push_back(cause);
  json["removals"] = nlohmann::ordered_json::array();
  for (const Removal& r : cut.incision.record.removals) {
    json["removals"].push_back({r.tet.value, r.step, r.time_s, static_cast<int>(r.cause), r.rest_volume_mm3});
  }
  return json;
}

/// Writes one row for each step of the cut.
void write_steps(const std::filesystem::path& file, const std::vector<CutStepLog>& steps) {
  write_atomically(file, [&steps](std::ostream& out) {
    out << "time_s,iterations,tets_in_contact,removed,slipped,tool_force_x_mn,tool_force_y_mn,tool_force_z_mn,"
           "tool_torque_x_mn_mm,tool_torque_y_mn_mm,tool_torque_z_mn_mm\n";
    for (const CutStepLog& step : steps) {
      const Vec3& force = step.tool_force_mn;
      const Vec3& torque = step.tool_torque_mn_mm;
      out << fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", step.time_s, step.iterations, step.tets_in_contact,
                         step.removed, step.slipped, force.x(), force.y(), force.z(), torque.x(), torque.y(),
                         torque.z());
    }
  });
}

/// Writes the frames as a ParaView time series, and the tool's poses at their times as JSON. At most kMostWriters
/// meshes are made at once, of some 500 bytes a tet each.
void write_frames(const std::filesystem::path& folder, const CutTissue& tissue, const std::vector<CutFrame>& frames,
                  int threads) {
  if (frames.empty()) return;
  make_folder(folder / "frames");
  if (tissue.is_divided()) write_vtu(folder / kUncutFile, uncut_mesh(tissue));
  const auto name_of = [](std::size_t i) { return fmt::format("frames/frame_{:04}.vtu", i); };
  Workers workers(std::clamp(threads, 1, std::min(kMostWriters, static_cast<int>(frames.size()))));
  workers.for_each(frames.size(), 1,
                   [&](std::size_t i) { write_vtu(folder / name_of(i), live_mesh(tissue, frames[i])); });
  std::vector<PvdFrame> series;
  nlohmann::ordered_json tools = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const CutFrame& frame = frames[i];
    series.push_back({frame.time_s, name_of(i)});
    tools.push_back({{"time_s", frame.time_s},
                     {"is_tool_in", frame.is_tool_in},
                     {"tip_mm", to_json(frame.tool.tip_mm)},
                     {"axis", to_json(frame.tool.axis)},
                     {"heading", to_json(frame.tool.heading)}});
  }
  write_pvd(folder / "frames.pvd", series);
  write_json(folder / "frames" / "tool.json", {{"frames", tools}});
}

void write_if_there(const std::filesystem::path& file, const std::optional<Contour>& contour) {
  if (contour) write_contour_csv(file, *contour);
}

/// Writes the kerf's files beside `incision.json`: depth.csv and, as far as they were measured, kerf.vtp,
/// centerline_DEPTHmm.csv, lag.csv, centerline_final.csv, inner_edge_reference.csv.
void write_kerf_files(const std::filesystem::path& folder, const KerfMeasures& kerf) {
  if (!kerf.body.surface.triangles.empty()) write_vtp(folder / "kerf.vtp", kerf.body.surface);
  for (const KerfLayer& layer : kerf.layers)
    write_if_there(folder / fmt::format("centerline_{}mm.csv", layer.depth_mm), layer.centerline);
  write_contour_csv(folder / "depth.csv", kerf.depth.profile.course,
                    {{"arclength_mm", kerf.depth.profile.arclength_mm},
                     {"depth_mm", kerf.depth.profile.depth_mm},
                     {"planned_mm", kerf.depth.planned_at_mm}});
  if (kerf.drag) {
    write_csv_columns(folder / "lag.csv", {{"time_s", kerf.drag->time_s},
                                           {"arclength_mm", kerf.drag->arclength_mm},
                                           {"lag_mm", kerf.drag->lag_mm},
                                           {"drift_mm", kerf.drag->drift_mm}});
  }
  write_if_there(folder / "centerline_final.csv", kerf.final_centerline);
  write_if_there(folder / "inner_edge_reference.csv", kerf.inner_edge_reference);
}

}  // namespace

void RunFolder::cut(const ProductNote& note, const TissueModel& model, const StaticResult& stretched,
                    const SimulatedCut& cut) {
  const nlohmann::ordered_json json = incision_json(cut);
  // The files also hold the cut's measures, which depend on settings that are not part of the cut's key.
  nlohmann::ordered_json without_times = json;
  for (const char* time : {"wall_s", "ms_per_step"}) without_times.erase(time);
  ProductNote judged = note;
  judged.key = sha256_of_text(note.key + json_text(without_times));
  write(judged, [&](const std::filesystem::path& to) {
    const IncisionResult& incision = cut.incision;
    write_json(to / "incision.json", json);
    write_steps(to / "steps.csv", incision.steps);
    if (incision.centerline) write_contour_csv(to / "centerline.csv", *incision.centerline);
    if (incision.inner_edge) write_contour_csv(to / "inner_edge.csv", *incision.inner_edge);
    if (!incision.final_tumor_edge.points.empty())
      write_contour_csv(to / "tumor_edge_final.csv", incision.final_tumor_edge);
    const CutTissue tissue = tissue_of(model, stretched.state, incision.final_state);
    const TetMesh removed = removed_mesh(tissue, incision.steps);
    if (!removed.tets.empty()) write_vtu(to / "removed.vtu", removed);
    write_kerf_files(to, incision.kerf);
    write_frames(to, tissue, incision.frames, context_.threads);
  });
}

}  // namespace incise
