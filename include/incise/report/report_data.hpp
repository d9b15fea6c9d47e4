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

/// Content of a report. Every part is optional: where one is empty, the page says in one sentence what is missing. So
/// any result folder makes a page. Every number must be finite. Coordinates are in mm, LPS, all in the same frame.
namespace incise {

/// The scan that the tissue model was made from.
struct CtPicture {
  CtVolume ct;                    ///< cropped to the part of interest; no voxels: not shown
  GrayVolume occupancy;           ///< share of tissue in [0, 1], on any grid; outlined at 0.5. No voxels: no outline
  double window_low_hu = -160.0;  ///< shown black
  double window_high_hu = 240.0;  ///< shown white
  std::string caption;            ///< origin of the scan
  TriMesh tumor;                  ///< at rest, mm: the tumour's surface, or a band along its edge; no triangles: none
  bool tumor_is_surface = false;  ///< false: `tumor` is the band
  TriMesh planned_cut;            ///< at rest, mm: the sheet from the planned path's entry points to its tips
};

/// Returns 1 where a label is not 0, else 0: for CtPicture::occupancy.
[[nodiscard]] GrayVolume occupancy_of(const LabelVolume& labels);

/// Counts of values in bins of equal width.
struct ReportHistogram {
  std::string quantity;        ///< "dihedral angle"
  std::string unit;            ///< "°"
  double low = 0.0;            ///< lower border of the first bin
  double high = 180.0;         ///< upper border of the last bin
  std::vector<double> counts;  ///< one per bin, >= 0; empty: not shown
};

/// The tetrahedral mesh and its quality.
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
  std::vector<Triangle> skin;         ///< of the live tets, counter-clockwise seen from outside
  std::vector<std::uint8_t> is_kerf;  ///< per triangle of the skin: 1 where the cut exposed it
  std::optional<Vec3> tool_tip_mm;    ///< none: the needle is not shown
  Vec3 tool_axis = -Vec3::UnitZ();    ///< unit; points from the holder to the tip
};

/// Returns a frame without time and tool: the skin of the live tets. A face belongs to the kerf if it is not on the
/// skin of the uncut body.
/// @param on_skin  per tet: bit f is set where face f is on the skin of the uncut body (skin_faces).
/// @param positions  N x 3, mm. @param is_live  per tet; empty: all are live.
/// @throws InvalidArgument if a length does not fit the mesh.
[[nodiscard]] ReportFrame frame_of(const TetMesh& mesh, std::span<const std::uint8_t> on_skin, Points positions,
                                   std::span<const std::uint8_t> is_live);

/// One simulated cut from beginning to end. Frames may have different numbers of vertices, but vertex i stays vertex i.
struct ReportAnimation {
  std::string name;                 ///< "Before compensation"
  std::vector<ReportFrame> frames;  ///< in order of time
  std::vector<ReportLine> lines;    ///< in the stretched tissue before the cut
  double tool_diameter_mm = 1.0;
  double tool_length_mm = 25.0;
};

/// One measured incision: before or after compensation.
struct ReportIncision {
  std::string name;  ///< "Before", "After"
  Outcome outcome = Outcome::Success;
  Verdict verdict;                      ///< of this cut: a success with a reason against it is not shown as good
  std::optional<bool> closed_loop;      ///< none for an open cut
  std::optional<bool> negative_margin;  ///< true: the cut keeps clear of the tumour edge; none: not known
  /// The three numbers on the first screen of the page; absent: not measured.
  std::optional<double> nearest_to_tumor_mm;  ///< least distance of the kerf from the tumour; negative: it enters it
  std::optional<double> least_depth_mm;       ///< least depth of the kerf along the path
  std::optional<double> greatest_error_mm;    ///< greatest absolute error
  double mean_abs_error_mm = 0.0;
  double target_mm = 5.0;        ///< intended distance from the tumour edge
  double close_margin_mm = kCloseMarginMm;  ///< less tissue than this counts as too close
  double kerf_allowance_mm = 0.0;  ///< from this contour to the kerf's edge: the tool's radius for a mid-line, else 0
  std::string measured_contour;  ///< contour to which the errors belong: "kerf mid-line"
  Contour tumor_edge;
  Contour intended_path;
  Contour corrected_path;  ///< empty: there is none

  /// Signed errors, mm, at or below which too little tissue is left beside the tumour, and none.
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
/// One safety check of the robot program: `value` passes on the side of `limit` that `relation` states ("<=", ">=").
/// Without a relation the check is a plain yes or no.
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
/// A file beside the page. Its path is relative to the page.
struct ReportFile {
  std::string path, meaning;
};
/// A figure with the numbers that belong to it.
struct ReportPicture {
  std::string title, lead;
  std::vector<std::string> svgs;  ///< complete SVG documents, shown side by side
  std::vector<ReportValue> values;
};
/// Any other table. Column names contain the units.
struct ReportTable {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

struct ReportData {
  std::string title = "Simulated incision";
  std::string subtitle;
  std::optional<Verdict> verdict;  ///< in the first line of the page; absent: not judged
  std::string virtual_notice;      ///< not empty: shown as a banner above everything ("Virtual specimen: …")
  Vec3 approach = -Vec3::UnitZ();  ///< direction in which camera and tool look at the tissue
  /// Names of the ends of the axes: -x, +x, -y, +y, -z, +z.
  std::array<std::string, 6> axis_names{"R", "L", "A", "P", "I", "S"};
  CtPicture ct;
  MeshPicture mesh;
  std::vector<ReportAnimation> animations;
  std::vector<ReportIncision> incisions;  ///< in the order in which they were cut: before, after
  std::vector<std::string> remarks;  ///< sentences on the incisions: why there is none after, why the path was moved
  std::vector<ReportMeasure> evaluation;
  std::vector<LinePlot> kerf_plots;       ///< depth, lag and drift along the path
  std::vector<std::string> kerf_figures;  ///< complete SVG documents
  ReportTable kerf_layers;                ///< mid-line errors by depth
  ReportTable correction;                 ///< pass by pass; no rows: not shown
  std::vector<LinePlot> correction_plots;
  std::vector<ReportStage> stages;
  std::vector<ReportValue> program;  ///< summary of the robot program
  std::vector<ReportCheck> checks;
  std::vector<ReportPicture> on_tissue;  ///< registration with the measured tissue, and the program on it
  std::string pictures_heading = "On the measured tissue";  ///< heading of the section with these pictures
  bool is_of_a_study = true;             ///< false: no run is reported, and its sections are left out
  std::string program_figure;           ///< a complete SVG document: the program as the player ran it
  std::vector<ReportValue> replay;      ///< numbers of the replay
  std::string program_text;             ///< the program, or its beginning
  std::vector<ReportTable> tables;      ///< calibration and others
  std::vector<ReportValue> settings;    ///< all settings, flattened: "cut.speed_mm_s"
  std::vector<ReportValue> provenance;  ///< version, commit, command, seed, threads, machine, hashes
  std::vector<ReportFile> files;
  std::vector<ReportNotice> notices;  ///< findings of this run; listed with the verdict's reasons, worst first
  std::vector<std::string> caveats;   ///< sentences that hold for every run like this one; listed separately
};

/// Returns the incisions that have a contour of at least two points.
[[nodiscard]] std::vector<ReportIncision> drawn_incisions(const ReportData& data);

/// Returns every problem that keeps `data` from being reported, in words: numbers that are not finite, indices out of
/// range, lists of unequal length, a zero direction, plots that cannot be drawn.
[[nodiscard]] std::vector<std::string> find_problems(const ReportData& data);

}  // namespace incise
