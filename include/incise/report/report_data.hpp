#pragma once

#include <incise/core/defaults.hpp>
#include <incise/core/monitor.hpp>
#include <incise/core/outcome.hpp>
#include <incise/core/verdict.hpp>
#include <incise/geometry/contour.hpp>
#include <incise/geometry/tet_mesh.hpp>
#include <incise/geometry/volume.hpp>
#include <incise/report/line_plot.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// What a report shows. Everything is optional: an empty part becomes one sentence that says what is missing, so that a
/// page can be made from any result folder. Every number has to be finite; coordinates are mm, LPS, in one and the same
/// frame.
namespace incise {

/// The scan that the tissue model was made from.
struct CtPicture {
  CtVolume ct;                    ///< cropped to what matters; no voxels: not shown
  GrayVolume occupancy;           ///< share of tissue in [0, 1], on any grid; outlined at 0.5. No voxels: no outline
  double window_low_hu = -160.0;  ///< shown black
  double window_high_hu = 240.0;  ///< shown white
  std::string caption;            ///< where the scan is from
  TriMesh tumor;                  ///< at rest, mm: its surface, or a band along its edge; no triangles: not drawn
  bool tumor_is_surface = false;  ///< which of the two
  TriMesh planned_cut;            ///< at rest, mm: the sheet from the planned path's entry points to its tips
};

/// 1 where a label is not 0, else 0: for CtPicture::occupancy.
[[nodiscard]] GrayVolume occupancy_of(const LabelVolume& labels);

/// Counts of values in bins of equal width.
struct ReportHistogram {
  std::string quantity;        ///< "dihedral angle"
  std::string unit;            ///< "°"
  double low = 0.0;            ///< lower border of the first bin
  double high = 180.0;         ///< upper border of the last bin
  std::vector<double> counts;  ///< one per bin, >= 0; empty: not shown
};

/// The tetrahedral mesh and how good it is.
struct MeshPicture {
  TetMesh mesh;  ///< at rest; no tets: not shown in 3D
  ReportHistogram dihedral_angles;
  double min_dihedral_deg = 0.0;
  double max_dihedral_deg = 0.0;
  double volume_mm3 = 0.0;
};

enum class LineKind { TumorEdge, IntendedPath, CorrectedPath, KerfMidLine };

/// A curve drawn in the 3D view; its kind gives colour, legend entry and switch.
struct ReportLine {
  LineKind kind = LineKind::TumorEdge;
  Contour contour;
};

/// The tissue's skin and the tool at one moment.
struct ReportFrame {
  double time_s = 0.0;
  std::string phase;                  ///< "rest", "stretched", "cutting", "done"
  Points positions_mm;                ///< of all mesh vertices
  std::vector<Triangle> skin;         ///< of the tets that are left, counter-clockwise seen from outside
  std::vector<std::uint8_t> is_kerf;  ///< per triangle of the skin: 1 where the cut laid it open
  std::optional<Vec3> tool_tip_mm;    ///< none: the needle is not shown
  Vec3 tool_axis = -Vec3::UnitZ();    ///< unit; points from the holder to the tip
};

/// A frame without time and tool: the skin of the tets that are left. A face is of the kerf where it is not on the
/// uncut body's skin.
/// @param on_skin    per tet: bit f is set where face f is on that skin (skin_faces).
/// @param positions  N x 3, mm.  @param is_live  per tet; empty: all.  @throws InvalidArgument if a length does not fit
/// the mesh.
[[nodiscard]] ReportFrame frame_of(const TetMesh& mesh, std::span<const std::uint8_t> on_skin, Points positions,
                                   std::span<const std::uint8_t> is_live);

/// One simulated cut from beginning to end. Frames may have different numbers of vertices, but vertex i stays vertex i.
struct ReportAnimation {
  std::string name;                 ///< "Before compensation"
  std::vector<ReportFrame> frames;  ///< in order of time
  std::vector<ReportLine> lines;    ///< in the stretched tissue before the cut
  double tool_diameter_mm = 1.0;
  double tool_length_mm = 25.0;
  std::optional<Vec3> platform_point_mm;  ///< a point of the plane that the tissue lies on; none: not shown
  Vec3 platform_normal = Vec3::UnitZ();   ///< unit; towards the tissue
};

/// One incision as it was measured: before or after compensation.
struct ReportIncision {
  std::string name;  ///< "Before", "After"
  Outcome outcome = Outcome::Success;
  Verdict verdict;                      ///< of this cut: a success that something argues against is not shown as good
  std::optional<bool> closed_loop;      ///< none for an open cut
  std::optional<bool> negative_margin;  ///< the cut keeps clear of the tumour edge; none: not known
  /// The three numbers on the page's first screen; absent: not measured.
  std::optional<double> nearest_to_tumor_mm;  ///< least tissue between kerf and tumour; negative: the kerf enters it
  std::optional<double> least_depth_mm;       ///< of the kerf, along the path
  std::optional<double> greatest_error_mm;    ///< of the absolute errors
  double mean_abs_error_mm = 0.0;
  double target_mm = 5.0;        ///< the distance to the tumour edge that was aimed at
  double close_margin_mm = kCloseMarginMm;  ///< less tissue than this counts as too close
  double kerf_allowance_mm = 0.0;  ///< how much nearer to the tumour the kerf's edge is than this contour: the electrode's radius for a mid-line
  std::string measured_contour;  ///< "kerf mid-line": what the errors belong to
  Contour tumor_edge;
  Contour intended_path;
  Contour corrected_path;  ///< empty: none was made

  /// The signed errors below which too little tissue, and none, is left beside the tumour.
  [[nodiscard]] double close_error_mm() const { return close_margin_mm + kerf_allowance_mm - target_mm; }
  [[nodiscard]] double reached_error_mm() const { return kerf_allowance_mm - target_mm; }
  Contour incision;
  std::vector<double> signed_error_mm;  ///< one per incision point; positive = farther from the tumour than intended
};

/// One measure of the evaluation, before and after.
struct ReportMeasure {
  std::string name, unit;
  std::optional<double> before, after;
};
struct ReportStage {
  std::string name, state;
  double wall_s = 0.0;
};
/// One safety check of the robot program: `value` has to be on the side of `limit` that `relation` says ("<=", ">="); without
/// a relation the check is a plain yes or no.
struct ReportCheck {
  std::string name, unit;
  double value = 0.0;
  std::string relation = "<=";
  double limit = 0.0;
  bool passed = false;
};
struct ReportValue {
  std::string name, value, unit;
};
struct ReportNotice {
  Severity severity = Severity::Notice;
  std::string text;
};
/// A file beside the page, by its path relative to the page.
struct ReportFile {
  std::string path, meaning;
};
/// A figure with the numbers that belong to it.
struct ReportPicture {
  std::string title, lead;
  std::vector<std::string> svgs;  ///< complete SVG documents, shown side by side
  std::vector<ReportValue> values;
};
/// Any other table; units belong into the column names.
struct ReportTable {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

struct ReportData {
  std::string title = "Simulated incision";
  std::string subtitle;
  std::optional<Verdict> verdict;  ///< in the page's first line; absent: not judged
  std::string virtual_notice;      ///< not empty: shown as a banner above everything ("Virtual specimen: …")
  Vec3 approach = -Vec3::UnitZ();  ///< the direction in which the camera and the tool look at the tissue
  /// What the ends of the axes are called: -x, +x, -y, +y, -z, +z.
  std::array<std::string, 6> axis_names{"R", "L", "A", "P", "I", "S"};
  CtPicture ct;
  MeshPicture mesh;
  std::vector<ReportAnimation> animations;
  std::vector<ReportIncision> incisions;  ///< in the order in which they were made: before, after
  std::vector<std::string> remarks;  ///< sentences on them: why there is none after, why the path was moved as it was
  std::vector<ReportMeasure> evaluation;
  std::vector<LinePlot> kerf_plots;       ///< depth, lag and drift along the path
  std::vector<std::string> kerf_figures;  ///< complete SVG documents
  ReportTable kerf_layers;                ///< mid-line errors by depth
  ReportTable correction;                 ///< pass by pass; no rows: not shown
  std::vector<LinePlot> correction_plots;
  std::vector<ReportStage> stages;
  std::vector<ReportValue> program;  ///< summary of the robot program
  std::vector<ReportCheck> checks;
  std::vector<ReportPicture> on_tissue;  ///< registration with the measured tissue, and the program that was laid onto it
  std::string pictures_heading = "On the measured tissue";  ///< of the section with them
  bool is_of_a_study = true;             ///< false: sections of a study that this is no report of are left out
  std::string program_figure;           ///< a complete SVG document: the program as the player ran it
  std::vector<ReportValue> replay;      ///< numbers of that
  std::string program_text;             ///< the program, or its beginning
  std::vector<ReportTable> tables;      ///< calibration and others
  std::vector<ReportValue> settings;    ///< all settings, flattened: "cut.speed_mm_s"
  std::vector<ReportValue> provenance;  ///< version, commit, command, seed, threads, machine, hashes
  std::vector<ReportFile> files;
  std::vector<ReportNotice> notices;  ///< findings of this run; listed with the verdict's reasons, worst first
  std::vector<std::string> caveats;   ///< what holds for every run like this one, in sentences; listed by themselves
};

/// The incisions that have a contour to draw.
[[nodiscard]] std::vector<ReportIncision> drawn_incisions(const ReportData& data);

/// Everything that keeps `data` from being reported, in words: numbers that are not finite, indices out of range, lists
/// of unequal length, a zero direction. Empty: html_report accepts it.
[[nodiscard]] std::vector<std::string> find_problems(const ReportData& data);

}  // namespace incise
