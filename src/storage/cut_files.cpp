#include "kerf_files.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/io/pvd_io.hpp>
#include <incise/storage/result_json.hpp>
#include <incise/storage/run_folder.hpp>

#include <fmt/format.h>

#include <array>

namespace incise {
namespace {

/// The live tets at one moment, deformed; the cell array `tet` keeps their place in the uncut mesh. What viscosity adds
/// to stress is not kept in a frame.
TetMesh live_mesh(const TissueModel& model, TissueState state, const CutFrame& frame) {
  state.positions = frame.positions;
  state.is_live = frame.is_live;
  TetMesh live = deformed_mesh(model, state);
  const std::vector<double> stress = std::move(live.cell_data["von_mises_kpa"].values);
  live.tets.clear();
  live.cell_data.clear();
  DataArray place{1, {}}, live_stress{1, {}};
  for (std::size_t tet = 0; tet < model.mesh.tets.size(); ++tet) {
    if (frame.is_live[tet] == 0) continue;
    live.tets.push_back(model.mesh.tets[tet]);
    place.values.push_back(static_cast<double>(tet));
    live_stress.values.push_back(stress[tet]);
  }
  live.cell_data["tet"] = std::move(place);
  live.cell_data["von_mises_kpa"] = std::move(live_stress);
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

/// All numbers of a cut, and what it removed.
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

/// What each step of the cut did, one line each.
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

/// Frames as a ParaView time series, the tool beside them as columns of a table.
void write_frames(const std::filesystem::path& folder, const TissueModel& model, const TissueState& stretched,
                  const std::vector<CutFrame>& frames) {
  if (frames.empty()) return;
  std::filesystem::create_directories(folder / "frames");
  std::vector<PvdFrame> series;
  nlohmann::ordered_json tools = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const CutFrame& frame = frames[i];
    const std::string name = fmt::format("frames/frame_{:04}.vtu", i);
    write_vtu(folder / name, live_mesh(model, stretched, frame));
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

void RunFolder::cut(const ProductNote& note, const TissueModel& model, const StaticResult& stretched,
                    const SimulatedCut& cut) {
  const nlohmann::ordered_json json = incision_json(cut);
  // Its files say what it is worth, too: what it is judged by is not part of what it is cut by.
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
    if (!incision.record.removals.empty()) {
      write_vtu(to / "removed.vtu", removed_mesh(model.mesh, stretched.state.positions, incision.record));
    }
    write_kerf_files(to, incision.kerf);
    write_frames(to, model, stretched.state, incision.frames);
  });
}

}  // namespace incise
