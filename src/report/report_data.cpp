#include <incise/core/error.hpp>
#include <incise/report/report_data.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace incise {
namespace {

/// Gathers problems; each check names its place.
class Findings {
 public:
  void number(double value, const std::string& place) {
    if (!std::isfinite(value)) add(place, "is not a finite number");
  }
  void points(const Points& values, const std::string& place) {
    const auto bad = std::find_if(values.begin(), values.end(), [](const Vec3& p) { return !p.allFinite(); });
    if (bad != values.end()) add(place, fmt::format("point {} is not finite", bad - values.begin()));
  }
  void direction(const Vec3& value, const std::string& place) {
    if (!value.allFinite() || value.norm() < 1e-9) add(place, "is not a direction: expected finite and not zero");
  }
  void check(bool is_good, const std::string& place, const std::string& problem) {
    if (!is_good) add(place, problem);
  }
  void plot(const LinePlot& shown) {
    for (const std::string& problem : find_problems(shown)) add("plot \"" + shown.title + "\"", problem);
  }
  void table(const ReportTable& shown) {
    const bool is_even = std::all_of(shown.rows.begin(), shown.rows.end(), [&](const std::vector<std::string>& row) {
      return row.size() == shown.columns.size();
    });
    check(is_even, "table \"" + shown.title + "\"", "has a row whose length is not the number of columns");
  }
  [[nodiscard]] std::vector<std::string> take() { return std::move(problems_); }

 private:
  void add(const std::string& place, const std::string& problem) { problems_.push_back(place + ": " + problem); }
  std::vector<std::string> problems_;
};

template <class Value>
void check_grid(Findings& findings, const Volume<Value>& volume, const std::string& place) {
  const VolumeGrid& grid = volume.grid;
  const bool has_size = grid.size[0] > 0 && grid.size[1] > 0 && grid.size[2] > 0;
  findings.check(has_size && volume.voxels.size() == grid.voxel_count(), place,
                 fmt::format("expected {} x {} x {} voxels, found {}", grid.size[0], grid.size[1], grid.size[2],
                             volume.voxels.size()));
  findings.check(grid.spacing_mm.allFinite() && grid.spacing_mm.minCoeff() > 0.0, place, "spacing is not positive");
  findings.check(grid.origin_mm.allFinite() && grid.direction.allFinite(), place, "origin or direction is not finite");
}

void check_ct(Findings& findings, const CtPicture& picture) {
  if (picture.ct.voxels.empty()) return;
  check_grid(findings, picture.ct, "ct");
  findings.check(std::isfinite(picture.window_low_hu) && std::isfinite(picture.window_high_hu) &&
                     picture.window_low_hu < picture.window_high_hu,
                 "ct: window", "expected low below high, in HU");
  if (picture.occupancy.voxels.empty()) return;
  check_grid(findings, picture.occupancy, "ct: occupancy");
  const auto& voxels = picture.occupancy.voxels;
  findings.check(std::all_of(voxels.begin(), voxels.end(), [](float v) { return std::isfinite(v); }), "ct: occupancy",
                 "has a value that is not finite");
}

void check_mesh(Findings& findings, const MeshPicture& picture) {
  findings.points(picture.mesh.vertices, "mesh: vertices");
  const std::size_t n = picture.mesh.vertices.size();
  const auto& tets = picture.mesh.tets;
  const auto is_in_range = [n](const Tet& tet) {
    return std::all_of(tet.begin(), tet.end(), [n](VertexId id) { return id.is_valid() && id.index() < n; });
  };
  findings.check(std::all_of(tets.begin(), tets.end(), is_in_range), "mesh: tets", "has an index out of range");
  findings.number(picture.min_dihedral_deg, "mesh: min_dihedral_deg");
  findings.number(picture.max_dihedral_deg, "mesh: max_dihedral_deg");
  findings.number(picture.volume_mm3, "mesh: volume_mm3");
  const ReportHistogram& histogram = picture.dihedral_angles;
  findings.check(std::isfinite(histogram.low) && std::isfinite(histogram.high) && histogram.low < histogram.high,
                 "mesh: histogram", "expected low below high");
  findings.check(std::all_of(histogram.counts.begin(), histogram.counts.end(),
                             [](double c) { return std::isfinite(c) && c >= 0.0; }),
                 "mesh: histogram", "has a count that is negative or not finite");
}

void check_frame(Findings& findings, const ReportFrame& frame, const std::string& place) {
  findings.number(frame.time_s, place + ": time_s");
  findings.points(frame.positions_mm, place + ": positions");
  findings.check(
      frame.is_kerf.size() == frame.skin.size(), place,
      fmt::format("expected one kerf flag per triangle, found {} for {}", frame.is_kerf.size(), frame.skin.size()));
  const std::size_t n = frame.positions_mm.size();
  const auto is_in_range = [n](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [n](VertexId id) { return id.is_valid() && id.index() < n; });
  };
  findings.check(std::all_of(frame.skin.begin(), frame.skin.end(), is_in_range), place + ": skin",
                 "has an index out of range");
  if (frame.tool_tip_mm) findings.check(frame.tool_tip_mm->allFinite(), place + ": tool tip", "is not finite");
  findings.direction(frame.tool_axis, place + ": tool axis");
}

void check_animation(Findings& findings, const ReportAnimation& animation) {
  const std::string place = fmt::format("animation \"{}\"", animation.name);
  bool has_triangle = animation.frames.empty();
  for (std::size_t k = 0; k < animation.frames.size(); ++k) {
    check_frame(findings, animation.frames[k], fmt::format("{}: frame {}", place, k));
    has_triangle = has_triangle || !animation.frames[k].skin.empty();
    findings.check(k == 0 || animation.frames[k].time_s >= animation.frames[k - 1].time_s, place,
                   fmt::format("frame {} is earlier than the one before", k));
  }
  findings.check(has_triangle, place, "no frame has a triangle");
  for (const ReportLine& line : animation.lines) findings.points(line.contour.points, place + ": line");
  findings.check(std::isfinite(animation.tool_diameter_mm) && animation.tool_diameter_mm > 0.0, place,
                 "tool diameter is not positive");
  findings.check(std::isfinite(animation.tool_length_mm) && animation.tool_length_mm > 0.0, place,
                 "tool length is not positive");
}

void check_incision(Findings& findings, const ReportIncision& incision) {
  const std::string place = fmt::format("incision \"{}\"", incision.name);
  findings.number(incision.mean_abs_error_mm, place + ": mean_abs_error_mm");
  findings.number(incision.nearest_to_tumor_mm.value_or(0.0), place + ": nearest_to_tumor_mm");
  findings.number(incision.least_depth_mm.value_or(0.0), place + ": least_depth_mm");
  findings.number(incision.greatest_error_mm.value_or(0.0), place + ": greatest_error_mm");
  findings.number(incision.target_mm, place + ": target_mm");
  findings.number(incision.close_margin_mm, place + ": close_margin_mm");
  findings.number(incision.kerf_allowance_mm, place + ": kerf_allowance_mm");
  for (const double error : incision.signed_error_mm) {
    if (std::isfinite(error)) continue;
    findings.number(error, place + ": signed_error_mm");
    break;
  }
  findings.check(incision.signed_error_mm.size() == incision.incision.points.size(), place,
                 fmt::format("expected one error per point, found {} for {} points", incision.signed_error_mm.size(),
                             incision.incision.points.size()));
  findings.points(incision.tumor_edge.points, place + ": tumour edge");
  findings.points(incision.intended_path.points, place + ": intended path");
  findings.points(incision.corrected_path.points, place + ": corrected path");
  findings.points(incision.incision.points, place + ": incision contour");
}

void check_tables(Findings& findings, const ReportData& data) {
  for (const ReportMeasure& measure : data.evaluation) {
    if (measure.before) findings.number(*measure.before, "evaluation: " + measure.name + ", before");
    if (measure.after) findings.number(*measure.after, "evaluation: " + measure.name + ", after");
  }
  for (const ReportStage& stage : data.stages) findings.number(stage.wall_s, "stage " + stage.name + ": wall_s");
  for (const ReportCheck& check : data.checks) {
    findings.number(check.value, "check " + check.name + ": value");
    findings.number(check.limit, "check " + check.name + ": limit");
  }
  for (const ReportTable& table : data.tables) findings.table(table);
}

void check_kerf_and_correction(Findings& findings, const ReportData& data) {
  for (const LinePlot& plot : data.kerf_plots) findings.plot(plot);
  findings.table(data.kerf_layers);
  findings.table(data.correction);
  for (const LinePlot& plot : data.correction_plots) findings.plot(plot);
}

}  // namespace

GrayVolume occupancy_of(const LabelVolume& labels) {
  GrayVolume occupancy{.grid = labels.grid, .voxels = {}};
  occupancy.voxels.reserve(labels.voxels.size());
  for (const std::uint8_t label : labels.voxels) occupancy.voxels.push_back(label != 0 ? 1.0F : 0.0F);
  return occupancy;
}

ReportFrame frame_of(const TetMesh& mesh, std::span<const std::uint8_t> on_skin, Points positions,
                     std::span<const std::uint8_t> is_live) {
  INCISE_REQUIRE(positions.size() == mesh.vertices.size(),
                 fmt::format("expected {} positions, found {}", mesh.vertices.size(), positions.size()));
  INCISE_REQUIRE(is_live.empty() || is_live.size() == mesh.tets.size(),
                 fmt::format("expected {} live flags, found {}", mesh.tets.size(), is_live.size()));
  INCISE_REQUIRE(on_skin.size() == mesh.tets.size(),
                 fmt::format("expected the skin's faces of {} tets, found {}", mesh.tets.size(), on_skin.size()));
  ReportFrame frame;
  for (const BoundaryFace& face : boundary_faces(mesh, is_live)) {
    int opposite = 0;
    while (face_of(mesh.tets[face.tet.index()], opposite) != face.corners) ++opposite;
    frame.skin.push_back(face.corners);
    frame.is_kerf.push_back((on_skin[face.tet.index()] >> opposite & 1U) != 0 ? 0 : 1);
  }
  frame.positions_mm = std::move(positions);
  return frame;
}

std::vector<ReportIncision> drawn_incisions(const ReportData& data) {
  std::vector<ReportIncision> drawn;
  std::copy_if(data.incisions.begin(), data.incisions.end(), std::back_inserter(drawn),
               [](const ReportIncision& incision) { return incision.incision.points.size() >= 2; });
  return drawn;
}

std::vector<std::string> find_problems(const ReportData& data) {
  Findings findings;
  findings.direction(data.approach, "approach");
  check_ct(findings, data.ct);
  check_mesh(findings, data.mesh);
  for (const ReportAnimation& animation : data.animations) check_animation(findings, animation);
  for (const ReportIncision& incision : data.incisions) check_incision(findings, incision);
  check_tables(findings, data);
  check_kerf_and_correction(findings, data);
  return findings.take();
}

}  // namespace incise
