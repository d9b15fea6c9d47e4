#include "kept_cut.hpp"

#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/evaluation/contour_errors.hpp>
#include <incise/geometry/surface_query.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/pvd_io.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/table_io.hpp>
#include <incise/io/volume_io.hpp>
#include <incise/io/written_json.hpp>
#include <incise/meshing/quality.hpp>
#include <incise/report/figures.hpp>
#include <incise/report/html_report.hpp>
#include <incise/report/number_text.hpp>
#include <incise/steps/compensation_figures.hpp>
#include <incise/steps/run_report.hpp>
#include <incise/storage/case_file.hpp>
#include <incise/storage/run_folder.hpp>
#include <incise/workflow/cut_verdict.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <functional>
#include <numeric>

namespace incise::steps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kVirtualNotice = "Virtual specimen, simulated cut: no number here is a measurement";
constexpr const char* kSimulatedNotice = "Simulated cut on a real scan: no number here is a measurement";

/// What every run leaves open; README.md, "Limits", says more.
constexpr std::array<const char*, 4> kCaveats{
    "This is research software. Nothing in it has been validated on tissue.",
    "The law of the cut is not calibrated against this tissue, unless the case says so. Do not trust the forces on the "
    "tool.",
    "Tissue is homogeneous, isotropic and linear elastic in a frame that rotates with it; the tumour is no stiffer "
    "than the rest. "
    "The platform is rigid and frictionless, and clamp and pull hold their vertices exactly in place.",
    "Heat does not act on the simulated tissue. How far it reaches is a closed form that nobody has fitted to "
    "electrosurgery."};

Vec3 vector_from(const Json& json) {
  return Vec3(json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>());
}

/// The part of the CT that the labels cover, with a little of its surroundings.
CtVolume crop(const CtVolume& ct, const VolumeGrid& around) {
  constexpr double kMarginMm = 12.0;
  Vec3 low = Vec3::Constant(1e30);
  Vec3 high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 index((corner & 1) != 0 ? around.size[0] - 1 : 0, (corner & 2) != 0 ? around.size[1] - 1 : 0,
                     (corner & 4) != 0 ? around.size[2] - 1 : 0);
    const Vec3 in_ct = ct.grid.index_from_world(around.world_from_index(index));
    low = low.cwiseMin(in_ct);
    high = high.cwiseMax(in_ct);
  }
  std::array<int, 3> first{};
  CtVolume part;
  part.grid = ct.grid;
  for (int axis = 0; axis < 3; ++axis) {
    const double margin = kMarginMm / ct.grid.spacing_mm[axis];
    const auto a = static_cast<std::size_t>(axis);
    first[a] = std::clamp(static_cast<int>(low[axis] - margin), 0, ct.grid.size[a] - 1);
    const int last = std::clamp(static_cast<int>(high[axis] + margin) + 1, first[a], ct.grid.size[a] - 1);
    part.grid.size[a] = last - first[a] + 1;
  }
  part.grid.origin_mm = ct.grid.world_from_index(Vec3(first[0], first[1], first[2]));
  for (int k = 0; k < part.grid.size[2]; ++k) {
    for (int j = 0; j < part.grid.size[1]; ++j) {
      for (int i = 0; i < part.grid.size[0]; ++i)
        part.voxels.push_back(ct.at(first[0] + i, first[1] + j, first[2] + k));
    }
  }
  return part;
}

/// Adds the verdict of the run, or, for a folder that a single stage filled, of its last cut.
void add_verdict(const fs::path& root, const Json& study, ReportData& data) {
  if (study.contains("verdict")) {
    data.verdict = from_json<Verdict>(study.at("verdict"), root / "study.json", "/verdict");
    return;
  }
  for (const char* cut : {"as_planned", "corrected"}) {
    const fs::path file = root / cut / "incision.json";
    if (fs::exists(file))
      data.verdict =
          from_written_json(file, [&] { return from_json<Verdict>(read_json(file).at("verdict"), file, "/verdict"); });
  }
}

/// Adds the reason why a run went no further than the stretch.
void add_stretch(const fs::path& root, ReportData& data) {
  const fs::path file = root / "stretched" / "deform.json";
  if (!fs::exists(file)) return;
  const Json json = read_json(file);
  from_written_json(file, [&] {
    if (json.at("outcome") == to_string(Outcome::Success)) return;
    data.notices.push_back({Severity::Warning, fmt::format("{}: {}", json.at("outcome").get<std::string>(),
                                                           json.at("note").get<std::string>())});
  });
}

void add_ct(const fs::path& root, const CaseFile& file, Monitor& monitor, ReportData& data) {
  const fs::path labels = root / "labels" / "labels.nrrd";
  if (!fs::exists(labels) || file.inputs.ct_volume.empty()) return;
  Monitor quiet;  // the run has already reported the reader's messages
  const ReadVolume read = read_ct(file.inputs.ct_volume, file.ct_reading, quiet);
  const LabelVolume label = read_labels(labels);
  data.ct.ct = crop(read.volume, label.grid);
  data.ct.occupancy = occupancy_of(label);
  data.ct.caption = fmt::format("{} of {} slices; the tissue that was found is outlined",
                                to_string(read.diagnostics.format), read.diagnostics.slices);
  for (const std::string& notice : read.diagnostics.notices) data.notices.push_back({Severity::Notice, notice});
  throw_if_cancelled(monitor, "the report");
}

/// A sheet between two rows of points, of as many each.
TriMesh sheet(const Points& upper, const Points& lower, bool is_closed) {
  TriMesh mesh;
  const std::size_t n = upper.size();
  mesh.vertices = upper;
  mesh.vertices.insert(mesh.vertices.end(), lower.begin(), lower.end());
  for (std::size_t i = 0; i + (is_closed ? 0 : 1) < n; ++i) {
    const VertexId a(i), b((i + 1) % n), c(n + i), d(n + (i + 1) % n);
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({b, c, d});
  }
  return mesh;
}

/// Returns the positions at rest of points on the stretched tissue. A point outside moves with the nearest tissue.
Points at_rest(Points points, const TetMesh& mesh, std::span<const Vec3> stretched) {
  constexpr double kReachMm = 1e3;
  const TetLocator locator(mesh, stretched);
  for (Vec3& p : points) {
    if (const auto place = locator.locate(p, kReachMm)) p = position_of(*place, mesh, mesh.vertices);
  }
  return points;
}

/// The tumour and the planned cut on the CT, which shows the tissue at rest.
void add_plan_to_ct(const fs::path& root, const CaseFile& file, const TetMesh& mesh, ReportData& data) {
  const fs::path deformed = root / "stretched" / "deformed.vtu";
  if (data.ct.ct.voxels.empty() || !fs::exists(root / "plan" / "path.json") || !fs::exists(deformed)) return;
  const ToolPath plan = read_tool_path(root / "plan" / "path.json");
  const Points stretched = read_tet_mesh(deformed).vertices;
  const auto rest_sheet = [&](const Points& upper, const Points& lower, bool is_closed) {
    return sheet(at_rest(upper, mesh, stretched), at_rest(lower, mesh, stretched), is_closed);
  };
  Points entries, tips;
  for (const Waypoint& waypoint : plan.waypoints) {
    entries.push_back(waypoint.position_mm);
    tips.push_back(waypoint.position_mm + waypoint.depth_mm * waypoint.axis);
  }
  data.ct.planned_cut = rest_sheet(entries, tips, plan.is_closed);
  if (!file.inputs.tumor_surface.empty()) {
    data.ct.tumor = read_surface(file.inputs.tumor_surface);
    if (file.settings.tumor_configuration == TumorConfiguration::Stretched)
      data.ct.tumor.vertices = at_rest(std::move(data.ct.tumor.vertices), mesh, stretched);
    data.ct.tumor_is_surface = true;
  } else if (!plan.tumor_edge.points.empty()) {
    constexpr double kBandMm = 1.0;  // an edge has no depth: a band is visible where it meets a slice
    Points lower = plan.tumor_edge.points;
    for (Vec3& p : lower) p += kBandMm * file.settings.plan.approach.normalized();
    data.ct.tumor = rest_sheet(plan.tumor_edge.points, lower, true);
  }
}

void add_mesh(const TetMesh& mesh, ReportData& data) {
  const MeshQuality quality = quality_of(mesh);
  data.mesh.mesh = mesh;
  data.mesh.dihedral_angles = {"dihedral angle", "°", 0.0, 180.0, {}};
  for (const std::size_t count : quality.dihedral_histogram)
    data.mesh.dihedral_angles.counts.push_back(static_cast<double>(count));
  data.mesh.min_dihedral_deg = quality.min_dihedral_deg;
  data.mesh.max_dihedral_deg = quality.max_dihedral_deg;
  data.mesh.volume_mm3 = quality.volume_mm3;
}

/// One number for each tet, whole and from 0 to `last`. @throws DataError where the file has others.
const std::vector<double>& cell_values(const TetMesh& mesh, const char* name, double last, const fs::path& file) {
  const auto found = mesh.cell_data.find(name);
  if (found == mesh.cell_data.end() || found->second.values.size() != mesh.tets.size())
    throw DataError(file, name, "no number for each tetrahedron", "cell data as `incise` writes it");
  for (const double value : found->second.values) {
    if (!(value >= 0.0 && value <= last && value == std::floor(value)))
      throw DataError(file, name, fmt::format("{}", value), fmt::format("whole numbers from 0 to {}", last));
  }
  return found->second.values;
}

/// The frames of one cut, as kept beside frames.pvd.
std::vector<ReportFrame> read_frames(const fs::path& folder, const TetMesh& whole, Monitor& monitor) {
  std::vector<ReportFrame> frames;
  if (!fs::exists(folder / "frames.pvd")) return frames;
  const bool is_divided = fs::exists(folder / kUncutFile);
  const TetMesh mesh = is_divided ? read_deformed_tet_mesh(folder / kUncutFile) : whole;
  std::vector<std::uint8_t> on_skin;
  if (is_divided) {
    for (const double faces : cell_values(mesh, "skin_faces", 15.0, folder / kUncutFile))
      on_skin.push_back(static_cast<std::uint8_t>(faces));
  } else {
    on_skin = skin_faces(mesh);
  }
  const fs::path tool_file = folder / "frames" / "tool.json";
  const Json tools = from_written_json(tool_file, [&] { return read_json(tool_file).at("frames"); });
  const std::vector<PvdFrame> series = read_pvd(folder / "frames.pvd");
  for (std::size_t i = 0; i < series.size() && i < tools.size(); ++i) {
    TetMesh live = read_deformed_tet_mesh(folder / series[i].file);
    std::vector<std::uint8_t> is_live(mesh.tets.size(), 0);
    const double last = static_cast<double>(mesh.tets.size()) - 1.0;
    for (const double place : cell_values(live, is_divided ? "cell" : "tet", last, folder / series[i].file))
      is_live[static_cast<std::size_t>(place)] = 1;
    ReportFrame frame = frame_of(mesh, on_skin, std::move(live.vertices), is_live);
    frame.time_s = series[i].time_s;
    from_written_json(tool_file, [&] {
      const bool is_tool_in = tools.at(i).at("is_tool_in");
      frame.phase = i == 0 ? "stretched" : is_tool_in ? "cutting" : "tool out";
      if (!is_tool_in) return;
      frame.tool_tip_mm = vector_from(tools[i].at("tip_mm"));
      frame.tool_axis = vector_from(tools[i].at("axis")).normalized();
    });
    frames.push_back(std::move(frame));
    monitor.progress("reading frames", static_cast<double>(i + 1) / static_cast<double>(series.size()));
  }
  return frames;
}

/// Everything that belongs to one of the two cuts.
struct CutFolder {
  const char* folder;
  const char* name;
  bool is_corrected;
};
constexpr std::array<CutFolder, 2> kCuts{{{"as_planned", "As planned", false}, {"corrected", "Corrected", true}}};

/// A cut's contour, its errors and the numbers that judge it.
ReportIncision judged_incision(const fs::path& folder, const CaseFile& file, const ToolPath& plan) {
  SimulatedCut cut = read_kept_cut(folder, file.settings, plan);
  ReportIncision incision;
  incision.outcome = cut.outcome;
  incision.nearest_to_tumor_mm = nearest_to_tumor_mm(file.settings, cut);
  if (cut.incision.kerf_width_mm > 0.0) incision.least_depth_mm = cut.incision.kerf.depth.depth_mm.min;
  if (cut.centerline.abs_error_mm) {
    incision.greatest_error_mm = cut.centerline.abs_error_mm->max;
    incision.mean_abs_error_mm = cut.centerline.abs_error_mm->mean;
  }
  incision.verdict = std::move(cut.verdict);
  incision.closed_loop = cut.centerline.closed_loop;
  incision.negative_margin = cut.centerline.negative_margin;
  incision.target_mm = file.settings.plan.lateral_margin_mm;
  incision.close_margin_mm = file.settings.close_margin_mm;
  incision.kerf_allowance_mm = radius_mm(file.settings.tool);
  incision.measured_contour = "kerf mid-line, stretched tissue before the cut";
  incision.tumor_edge = plan.tumor_edge;
  incision.intended_path = entry_contour(plan);
  incision.incision = std::move(cut.centerline.errors.points);
  incision.signed_error_mm = std::move(cut.centerline.errors.signed_error_mm);
  return incision;
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Why the path was moved the way it was; empty where it was not moved against the error.
std::string why_moved(const ReportIncision& before, const ReportIncision& after, const Vec3& approach) {
  constexpr double kLeastMm = 0.05;  // less is not seen in the figure
  if (before.signed_error_mm.empty() || after.corrected_path.points.empty()) return "";
  const double error_mm = mean_of(before.signed_error_mm);
  const double move_mm =
      mean_of(contour_errors(after.corrected_path, after.tumor_edge, after.target_mm, approach).signed_error_mm) -
      mean_of(contour_errors(after.intended_path, after.tumor_edge, after.target_mm, approach).signed_error_mm);
  if (std::min(std::abs(error_mm), std::abs(move_mm)) < kLeastMm || error_mm * move_mm > 0.0) return "";
  return fmt::format(
      "As planned, the cut lies {} mm {} the tumour than intended on average; the corrected path therefore lies {} mm "
      "{} the "
      "intended one, so that the cut lands where it was intended.",
      measure_text(std::abs(error_mm), "mm"), error_mm < 0.0 ? "closer to" : "farther from",
      measure_text(std::abs(move_mm), "mm"), move_mm > 0.0 ? "outside" : "inside");
}

/// Why there is no corrected cut.
std::string why_not_corrected(const CaseFile& file, const Json& study) {
  if (file.settings.plan.kind == PlanKind::Line) return "There is no corrected cut: only a ring is corrected.";
  const Json stages = study.value("stages", Json::array());
  const bool was_asked = std::any_of(stages.begin(), stages.end(), [](const Json& stage) {
    return stage.at("name") == "compensate" && stage.at("state") == "skipped";
  });
  return was_asked ? "There is no corrected cut: the cut as planned left no ring whose mid-line could be measured."
                   : "There is no corrected cut: no correction was requested.";
}

void add_remarks(const CaseFile& file, const Json& study, ReportData& data) {
  if (data.incisions.empty()) return;
  if (data.incisions.size() == 1) {
    data.remarks.push_back(why_not_corrected(file, study));
    return;
  }
  if (study.contains("accepted") && !study.at("accepted").get<bool>()) {
    const bool has_note = study.contains("correction_note") && study.at("correction_note").is_string();
    data.remarks.push_back(
        fmt::format("The correction is not accepted{}. The verdict is that of the cut as planned.",
                    has_note ? ": " + study.at("correction_note").get<std::string>() : std::string()));
  }
  const std::string why = why_moved(data.incisions.front(), data.incisions.back(), data.approach);
  if (!why.empty()) data.remarks.push_back(why);
}

/// A warning of the run, unless it repeats a finding.
void add_warning(std::string text, ReportData& data) {
  const auto repeats = [&text](const std::string& finding) { return text.find(finding) != std::string::npos; };
  for (const ReportNotice& notice : data.notices) {
    if (repeats(notice.text)) return;
  }
  std::vector<const Verdict*> verdicts;
  if (data.verdict) verdicts.push_back(&*data.verdict);
  for (const ReportIncision& incision : data.incisions) verdicts.push_back(&incision.verdict);
  for (const Verdict* verdict : verdicts) {
    for (const VerdictReason& reason : verdict->reasons()) {
      if (repeats(reason.message)) return;
    }
  }
  data.notices.push_back({Severity::Warning, std::move(text)});
}

/// Adds the findings beside the run's verdict, and the caveats of every run.
void add_findings(const CaseFile& file, const Json& study, ReportData& data) {
  const Json program = study.value("program", Json::object());
  if (program.contains("reason"))
    data.notices.push_back({Severity::Warning, "no program: " + program.at("reason").get<std::string>()});
  const bool is_accepted = study.value("accepted", false);
  for (std::size_t k = 0; k < data.incisions.size(); ++k) {
    if ((k == 1) == is_accepted) continue;  // the cut that the verdict judges
    for (const VerdictReason& reason : data.incisions[k].verdict.reasons()) {
      data.notices.push_back(
          {Severity::Notice, fmt::format("{}, which the verdict does not judge: {}: {}", data.incisions[k].name,
                                         to_string(reason.severity), reason.message)});
    }
  }
  for (const Json& warning : study.value("warnings", Json::array())) add_warning(warning.get<std::string>(), data);
  data.caveats.emplace_back(
      file.settings.is_virtual
          ? "The CT is synthetic and the cut is simulated. No tissue was cut."
          : "The scan is of a real body; clamp, stretch and cut are simulated. No tissue was cut.");
  data.caveats.insert(data.caveats.end(), kCaveats.begin(), kCaveats.end());
  if (data.incisions.size() > 1)
    data.caveats.emplace_back(
        "The correction is checked with the model that made it: the check cannot reveal an error of the model itself.");
  const auto left_out = program.value("checks_not_made", std::vector<std::string>{});
  if (!left_out.empty())
    data.caveats.push_back(fmt::format("Not checked in the robot program: {}.", fmt::join(left_out, "; ")));
}

void add_cut(const fs::path& root, const CutFolder& cut, const CaseFile& file, const TetMesh& mesh, Monitor& monitor,
             ReportData& data) {
  const fs::path folder = root / cut.folder;
  if (!fs::exists(folder / "incision.json")) return;
  const ToolPath plan = read_tool_path(root / "plan" / "path.json");
  ReportIncision incision = judged_incision(folder, file, plan);
  incision.name = cut.name;
  const fs::path corrected = root / "correction" / "path.json";
  if (cut.is_corrected && fs::exists(corrected)) incision.corrected_path = entry_contour(read_tool_path(corrected));

  ReportAnimation animation;
  animation.name = cut.name;
  animation.tool_diameter_mm = 2.0 * radius_mm(file.settings.tool);
  animation.tool_length_mm = length_mm(file.settings.tool).value_or(animation.tool_diameter_mm);
  if (!plan.tumor_edge.points.empty()) animation.lines.push_back({LineKind::TumorEdge, plan.tumor_edge});
  animation.lines.push_back({LineKind::IntendedPath, incision.intended_path});
  if (!incision.corrected_path.points.empty())
    animation.lines.push_back({LineKind::CorrectedPath, incision.corrected_path});
  if (fs::exists(folder / "centerline.csv"))
    animation.lines.push_back({LineKind::KerfMidLine, read_contour(folder / "centerline.csv", plan.is_closed)});
  data.incisions.push_back(std::move(incision));
  animation.frames = read_frames(folder, mesh, monitor);
  data.animations.push_back(std::move(animation));
}

std::string cell(const std::optional<double>& value) {
  return value ? measure_text(*value, "mm") : "–";
}

std::optional<double> number_at(const Json& json, const std::string& pointer) {
  const Json::json_pointer place(pointer);
  if (!json.contains(place) || !json.at(place).is_number()) return std::nullopt;
  return json.at(place).get<double>();
}

void add_evaluation(const fs::path& root, ReportData& data) {
  static constexpr std::array<std::array<const char*, 3>, 35> kMeasures{{
      {"Absolute error of the mid-line against its target, mean", "mm", "/abs_error_mm/mean"},
      {"… standard deviation along the contour", "mm", "/abs_error_mm/sd"},
      {"… greatest", "mm", "/abs_error_mm/max"},
      {"Signed error of the mid-line, mean (negative: too close)", "mm", "/signed_error_mm/mean"},
      {"… closest", "mm", "/signed_error_mm/min"},
      {"… farthest", "mm", "/signed_error_mm/max"},
      {"The paper's figure: mid-line against 4.5 mm, mean", "mm", "/paper_abs_error_mm"},
      {"Absolute error of the inner edge against 4.5 mm, mean (none: no closed edge is seen from above)", "mm",
       "/inner_edge/abs_error_mm/mean"},
      {"Signed error of the inner edge, mean", "mm", "/inner_edge/signed_error_mm/mean"},
      {"Hu shape score (0: same shape as the tumour edge)", "", "/hu_score"},
      {"… of a perfect offset", "", "/hu_score_ideal"},
      {"Centroid shift", "mm", "/centroid_shift_mm"},
      {"Points closer than the clinical cut-off", "share", "/close_margin/fraction"},
      {"Coverage of the ring", "share", "/coverage"},
      {"Depth reached along the path, mean", "mm", "/depth_reached_mm/mean"},
      {"… least", "mm", "/depth_reached_mm/min"},
      {"… planned", "mm", "/depth_reached_mm/planned"},
      {"Lag of the tissue when it was cut, mean", "mm", "/lag_mm/mean"},
      {"… greatest", "mm", "/lag_mm/max"},
      {"Drift of the tissue when it was cut, mean (positive: outwards)", "mm", "/drift_mm/mean"},
      {"… greatest", "mm", "/drift_mm/max"},
      {"Kerf to the tumour's surface, least distance", "mm", "/deep_margin_mm/nearest"},
      {"… beside it", "mm", "/deep_margin_mm/beside"},
      {"… beneath it (none: the kerf does not run there)", "mm", "/deep_margin_mm/beneath"},
      {"Bottom of the kerf below the tumour's deepest point, least", "mm", "/deep_margin_mm/floor_below/min"},
      {"Volume of the kerf, stretched", "mm³", "/kerf/volume_mm3"},
      {"Edges at which sheets of the kerf's surface touch", "", "/kerf/nonmanifold_edges"},
      {"Edges at which sheets of the live skin touch", "", "/live_skin/nonmanifold_edges"},
      {"Vertices at which sheets of the live skin touch", "", "/live_skin/pinched_vertices"},
      {"Tetrahedra removed", "", "/removed_tets"},
      {"Greatest force on the tool", "mN", "/peak_tool_force_mn"},
      {"Greatest torque on the tool about its tip", "mN mm", "/peak_tool_torque_mn_mm"},
      {"Heat damages tissue this far beside the electrode (closed form, not calibrated)", "mm",
       "/thermal_half_width_mm"},
      {"Tissue left unheated beside the tumour edge, least (below 0: heat reaches it)", "mm", "/thermal_margin_mm"},
      {"Simulation time", "s", "/wall_s"},
  }};
  const auto read = [&root](const CutFolder& cut) {
    const fs::path file = root / cut.folder / "incision.json";
    return fs::exists(file) ? read_json(file) : Json(nullptr);
  };
  const Json before = read(kCuts[0]);
  const Json after = read(kCuts[1]);
  if (before.is_null()) return;
  for (const auto& [name, unit, pointer] : kMeasures) {
    data.evaluation.push_back(
        {name, unit, number_at(before, pointer), after.is_null() ? std::nullopt : number_at(after, pointer)});
  }
}

/// A curve along the path from two columns of a file of one cut.
void add_series(const fs::path& file, const char* x, const char* y, const std::string& name, LinePlot& plot) {
  if (!fs::exists(file)) return;
  std::vector<std::vector<double>> columns = read_csv_columns(file, {x, y});
  if (!columns[0].empty()) plot.series.push_back({name, std::move(columns[0]), std::move(columns[1]), true});
}

/// Depth, lag and drift along the path, for both cuts.
void add_kerf_plots(const fs::path& root, ReportData& data) {
  constexpr const char* kAlong = "distance of the tool along its path, mm";
  LinePlot depth{
      .title = "Depth of the kerf (simulated)", .x_label = kAlong, .y_label = "depth below the skin, mm", .series = {}};
  LinePlot lag{
      .title = "Lag: tissue dragged ahead when cut (simulated)", .x_label = kAlong, .y_label = "lag, mm", .series = {}};
  LinePlot drift{.title = "Drift: tissue pushed outwards when cut (simulated)",
                 .x_label = kAlong,
                 .y_label = "drift, mm",
                 .series = {}};
  for (const CutFolder& cut : kCuts) {
    const fs::path folder = root / cut.folder;
    add_series(folder / "depth.csv", "arclength_mm", "depth_mm", cut.name, depth);
    add_series(folder / "lag.csv", "arclength_mm", "lag_mm", cut.name, lag);
    add_series(folder / "lag.csv", "arclength_mm", "drift_mm", cut.name, drift);
  }
  if (!depth.series.empty()) {
    double way = 0.0;
    for (const LineSeries& series : depth.series) way = std::max(way, series.x.back());
    const fs::path file = root / kCuts[0].folder / "incision.json";
    const double planned =
        from_written_json(file, [&] { return read_json(file).at("depth_reached_mm").at("planned").get<double>(); });
    depth.series.push_back({"planned depth of the tip", {0.0, way}, {planned, planned}, true});
  }
  for (LinePlot& plot : {std::ref(depth), std::ref(lag), std::ref(drift)}) {
    if (!plot.series.empty()) data.kerf_plots.push_back(plot);
  }
}

/// The mid-line's errors, layer by layer.
void add_layers(const CutFolder& cut, const Json& json, ReportData& data) {
  data.kerf_layers.title = "Mid-line by depth (simulated), mm";
  data.kerf_layers.columns = {"cut",      "depth below the skin", "ring",      "signed error, mean", "sd", "closest",
                              "farthest", "|error|, mean",        "kerf width"};
  for (const Json& layer : json.at("layers")) {
    const bool is_within = layer.at("within_plan");
    const Json& closed = layer.at("closed_loop");
    data.kerf_layers.rows.push_back(
        {cut.name, cell(number_at(layer, "/depth_mm")),
         !is_within           ? "below the plan"
         : closed.is_null()   ? "open cut"
         : closed.get<bool>() ? "closed"
                              : "open",
         cell(number_at(layer, "/signed_error_mm/mean")), cell(number_at(layer, "/signed_error_mm/sd")),
         cell(number_at(layer, "/signed_error_mm/min")), cell(number_at(layer, "/signed_error_mm/max")),
         cell(number_at(layer, "/abs_error_mm/mean")), cell(number_at(layer, "/kerf_width_mm"))});
  }
}

/// Adds the kerf as a separate body, with the paths.
void add_kerf_picture(const fs::path& folder, const CutFolder& cut, const std::vector<ReportLine>& lines,
                      ReportData& data) {
  if (!fs::exists(folder / "kerf.vtp")) return;
  TriMesh kerf = read_surface(folder / "kerf.vtp");
  ReportFrame frame;
  frame.phase = "all removed tissue, in the stretched tissue before the cut";
  frame.is_kerf.assign(kerf.triangles.size(), 1);
  frame.positions_mm = std::move(kerf.vertices);
  frame.skin = std::move(kerf.triangles);
  ReportAnimation body;
  body.name = fmt::format("{}: the kerf", cut.name);
  body.lines = lines;
  body.frames.push_back(std::move(frame));
  constexpr int kWidthPx = 560;
  constexpr int kHeightPx = 340;
  data.kerf_figures.push_back(frame_figure_svg(body, 0, data.approach, kWidthPx, kHeightPx));
}

void add_kerf(const fs::path& root, ReportData& data) {
  add_kerf_plots(root, data);
  for (std::size_t i = 0; i < kCuts.size(); ++i) {
    const fs::path folder = root / kCuts[i].folder;
    if (!fs::exists(folder / "incision.json")) continue;
    from_written_json(folder / "incision.json",
                      [&] { add_layers(kCuts[i], read_json(folder / "incision.json"), data); });
    if (i < data.animations.size()) add_kerf_picture(folder, kCuts[i], data.animations[i].lines, data);
  }
}

void add_program(const fs::path& root, const Json& study, ReportData& data) {
  if (!study.contains("program")) return;
  const Json& program = study.at("program");
  static constexpr std::array<std::array<const char*, 3>, 8> kShown{
      {{"written", "written", ""},
       {"reason", "why not", ""},
       {"follows", "it follows the", ""},
       {"duration_s", "duration", "s"},
       {"cut_length_mm", "length of the cut", "mm"},
       {"overlap_mm", "overlap", "mm"},
       {"spacing_mm", "distance between poses", "mm"},
       {"chord_error_mm", "greatest distance of a straight move from the path", "mm"}}};
  for (const auto& [key, name, unit] : kShown) {
    if (!program.contains(key)) continue;
    const Json& value = program.at(key);
    data.program.push_back({name,
                            value.is_number()    ? measure_text(value.get<double>(), unit)
                            : value.is_boolean() ? (value.get<bool>() ? "yes" : "no")
                            : value.is_string()  ? value.get<std::string>()
                                                 : value.dump(),
                            unit});
  }
  if (program.contains("checks")) {
    for (const Json& check : program.at("checks")) {
      data.checks.push_back({check.at("text"), check.at("unit"), check.at("value"), check.at("relation"),
                             check.at("limit"), check.at("passed")});
    }
  }
  if (program.contains("replay")) {
    const Json& replay = program.at("replay");
    const auto number = [](const Json& value) {
      return value.is_null() ? std::string("not known") : measure_text(value.get<double>(), "mm");
    };
    const Json& speed = replay.at("tip_speed_mm_s");
    data.replay = {{"greatest deviation from the intended course", number(replay.at("max_deviation_mm")), "mm"},
                   {"tip speed, mean (away from the ends)", number(speed.at("mean")), "mm/s"},
                   {"tip speed, least", number(speed.at("min")), "mm/s"},
                   {"tip speed, greatest", number(speed.at("max")), "mm/s"},
                   {"duration", number(replay.at("duration_s")), "s"}};
  }
  if (const fs::path figure = root / "program" / "replay.svg"; fs::exists(figure))
    data.program_figure = read_text(figure);
  const fs::path script = root / "program" / "program.script";
  if (fs::exists(script)) {
    constexpr std::size_t kShownCharacters = 12000;
    data.program_text = read_text(script).substr(0, kShownCharacters);
  }
}

void add_provenance(const fs::path& root, const CaseFile& file, ReportData& data) {
  for (const SettingLine& line : settings_of(file)) {
    if (!line.value.empty()) data.settings.push_back({line.key, line.value, line.unit});
  }
  if (fs::exists(root / "manifest.json")) {
    const Manifest manifest = read_manifest(root);
    if (nlohmann::ordered_json::parse(manifest.settings_json) != nlohmann::ordered_json::parse(settings_json(file))) {
      data.notices.push_back({Severity::Warning,
                              "The case file has changed since these results were made: the settings shown are the "
                              "present ones, not those of the results."});
    }
    data.provenance = {{"incise", manifest.version, ""},
                       {"commit", manifest.commit, ""},
                       {"command", manifest.command, ""},
                       {"seed", std::to_string(manifest.seed), ""},
                       {"threads", std::to_string(manifest.threads), ""},
                       {"instruction set", manifest.instruction_set, ""},
                       {"machine", manifest.machine, ""}};
    for (const ManifestInput& input : manifest.inputs)
      data.provenance.push_back({"SHA-256 of " + input.path, input.sha256, ""});
  }
  static constexpr std::array<std::array<const char*, 2>, 12> kFiles{{
      {"mesh/mesh.vtu", "tetrahedral mesh, unstretched (ParaView)"},
      {"stretched/rest.vtu", "at rest, with the displacement and stress of the stretch (ParaView)"},
      {"stretched/deformed.vtu", "clamped and stretched, with displacement and stress (ParaView)"},
      {"plan/path.json", "intended path"},
      {"as_planned/frames.pvd", "the first cut over time (ParaView)"},
      {"as_planned/incision.json", "all numbers of the first cut"},
      {"as_planned/kerf.vtp", "the first cut's kerf as a closed surface (ParaView)"},
      {"correction/path.json", "corrected path"},
      {"correction/errors.csv", "errors along the path, pass by pass"},
      {"corrected/frames.pvd", "the corrected cut over time (ParaView)"},
      {"program/program.script", "robot program (URScript)"},
      {"program/true_path.csv", "the tip's path in the replay of the program"},
  }};
  for (const auto& [path, meaning] : kFiles) {
    if (fs::exists(root / path)) data.files.push_back({path, meaning});
  }
}

}  // namespace

void write_report_and_figures(const ReportData& data, const fs::path& page) {
  write_report(data, page);
  const fs::path folder = page.parent_path() / "figures";
  const std::vector<ReportIncision> drawn = drawn_incisions(data);
  if (drawn.empty()) return;
  make_folder(folder);
  const auto write = [&folder](const char* name, const std::string& text) { write_atomically(folder / name, text); };
  const FigureStyle style = common_style(drawn, data.approach, data.axis_names);
  write("contours.svg", contour_figure_svg(drawn.front(), style));
  if (drawn.size() > 1) write("contours_corrected.svg", contour_figure_svg(drawn.back(), style));
  write("error_by_angle.svg", error_by_angle_svg(drawn, style));
  write("box_plot.svg", box_plot_svg(drawn, style));
  constexpr std::array<const char*, 3> kPlots{"kerf_depth.svg", "kerf_lag.svg", "kerf_drift.svg"};
  for (std::size_t i = 0; i < data.kerf_plots.size() && i < kPlots.size(); ++i)
    write(kPlots[i], line_plot_svg(data.kerf_plots[i]));
  constexpr std::array<const char*, 2> kBodies{"kerf.svg", "kerf_corrected.svg"};
  for (std::size_t i = 0; i < data.kerf_figures.size() && i < kBodies.size(); ++i)
    write(kBodies[i], data.kerf_figures[i]);
  if (!data.animations.empty() && !data.animations.back().frames.empty()) {
    constexpr int kWidthPx = 900;
    constexpr int kHeightPx = 560;
    const ReportAnimation& last = data.animations.back();
    write("cut.png", frame_png(last, last.frames.size() - 1, data.approach, kWidthPx, kHeightPx));
    write("cut.svg", frame_figure_svg(last, last.frames.size() - 1, data.approach, kWidthPx, kHeightPx));
  }
}

ReportData run_report(const fs::path& root, Monitor& monitor) {
  if (!fs::exists(root / "study.json")) {
    throw DataError(root, "", "no study.json", "a folder made by `incise run`, `demo`, `simulate` or another stage");
  }
  const fs::path study_file = root / "study.json";
  const Json study = read_json(study_file);
  const CaseFile file =
      read_case(root / from_written_json(study_file, [&] { return study.at("case_file").get<std::string>(); }));
  ReportData data;
  data.title = file.settings.title;
  data.subtitle = "From CT scan to corrected robot path";
  data.virtual_notice = file.settings.is_virtual ? kVirtualNotice : kSimulatedNotice;
  data.approach = file.settings.plan.approach;
  add_ct(root, file, monitor, data);
  add_stretch(root, data);
  add_verdict(root, study, data);
  fs::path mesh_file = root / "mesh" / "mesh.vtu";
  if (!file.inputs.specimen_mesh.empty()) mesh_file = file.inputs.specimen_mesh;
  if (fs::exists(mesh_file)) {
    const TetMesh mesh = read_tet_mesh(mesh_file);
    add_mesh(mesh, data);
    add_plan_to_ct(root, file, mesh, data);
    for (const CutFolder& cut : kCuts)
      from_written_json(root / cut.folder / "incision.json", [&] { add_cut(root, cut, file, mesh, monitor, data); });
  }
  add_evaluation(root, data);
  add_kerf(root, data);
  data.correction = compensation_table(root);
  for (CompensationFigure& figure : compensation_figures(root)) data.correction_plots.push_back(std::move(figure.plot));
  from_written_json(study_file, [&] {
    if (study.contains("stages")) {
      for (const Json& stage : study.at("stages"))
        data.stages.push_back({stage.at("name"), stage.at("state"), stage.at("wall_s")});
    }
    add_program(root, study, data);
    add_remarks(file, study, data);
    add_findings(file, study, data);
  });
  add_provenance(root, file, data);
  return data;
}

}  // namespace incise::steps
