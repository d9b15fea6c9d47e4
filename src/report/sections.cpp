#include "report/sections.hpp"

#include "report/page_files.hpp"
#include "report/svg.hpp"
#include "report/tables.hpp"

#include <incise/io/text_encoding.hpp>
#include <incise/report/figures.hpp>
#include <incise/report/html_report.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise {
namespace {

constexpr int kStillWidth = 1120;
constexpr int kStillHeight = 560;

std::string heading(std::string_view id, std::string_view title, std::string_view lead = "") {
  return fmt::format("<h2 id=\"{}\">{}</h2>\n", id, escaped(title)) +
         (lead.empty() ? "" : "<p class=\"lead\">" + escaped(lead) + "</p>\n");
}

std::string missing(std::string_view what) {
  return fmt::format("<p class=\"missing\">{}</p>\n", escaped(what));
}

std::string figure(const std::string& content) {
  return "<figure>" + content + "</figure>\n";
}

std::string card(std::string_view label, std::string_view value, std::string_view unit) {
  return fmt::format(
      "<div class=\"card\"><dt>{}</dt><dd class=\"value\">{} <span class=\"unit\">{}</span></dd></div>\n",
      escaped(label), escaped(value), escaped(unit));
}

/// A 3D view's frame: a still picture that the script replaces.
std::string viewer(std::string_view id, std::string_view label, const std::string& still) {
  return fmt::format(
      "<div class=\"viewer\" id=\"{}\">\n<div class=\"stage\" aria-label=\"{}\">"
      "<img class=\"still\" alt=\"{}\" src=\"{}\"></div>\n<div class=\"controls\"></div>\n</div>\n",
      id, escaped(label), escaped(label), still);
}

/// The legend of the curves on the slices; each curve can be hidden.
std::string slice_legend(const CtPicture& ct) {
  std::string entries;
  const auto add = [&entries](bool is_there, std::string_view curve, std::string_view color, std::string_view name) {
    if (!is_there) return;
    entries += fmt::format(
        "<label><input type=\"checkbox\" checked data-curve=\"{}\"><span class=\"swatch\" "
        "style=\"background:{}\"></span>{}</label>",
        curve, color, name);
  };
  add(!ct.occupancy.voxels.empty(), "outline", slice_ink::kTissue, "border of the tissue that was found");
  add(!ct.tumor.triangles.empty(), "tumor", slice_ink::kTumor, ct.tumor_is_surface ? "tumour" : "tumour edge");
  add(!ct.planned_cut.triangles.empty(), "planned-cut", slice_ink::kPlannedCut,
      "planned cut, from the skin to the tip's depth");
  return entries.empty() ? "" : "<p class=\"legend\">" + entries + "</p>\n";
}

}  // namespace

std::string page_header(const ReportData& data) {
  std::string html;
  if (!data.virtual_notice.empty()) {
    html += fmt::format("<div class=\"virtual\" role=\"note\">{}</div>\n", escaped(data.virtual_notice));
  }
  html += fmt::format("<header>\n<h1>{}</h1>\n", escaped(data.title));
  if (!data.subtitle.empty()) html += fmt::format("<p class=\"subtitle\">{}</p>\n", escaped(data.subtitle));
  html += "<nav aria-label=\"Parts of this report\">";
  if (data.is_of_a_study) {
    html +=
        "<a href=\"#findings\">Findings</a><a href=\"#scan\">Scan</a><a href=\"#mesh\">Mesh</a><a href=\"#cut\">Cut</a>"
        "<a href=\"#error\">Error</a><a href=\"#kerf\">Kerf</a><a href=\"#program\">Program</a>";
  }
  if (!data.on_tissue.empty()) html += "<a href=\"#tissue\">" + escaped(data.pictures_heading) + "</a>";
  html += "<a href=\"#record\">Settings and provenance</a></nav>\n</header>\n";
  return html;
}

std::string scan_section(const ReportData& data, const std::array<SlicePlane, 3>& planes) {
  std::string html = "<section>\n" + heading("scan", "Scan and segmentation", data.ct.caption);
  if (data.ct.ct.voxels.empty()) return html + missing("There is no CT here.") + "</section>\n";
  html += "<div class=\"figures scans\">\n";
  for (const SlicePlane& plane : planes) {
    const Slice& slice = plane.slices[plane.shown_first];
    const std::string place = fmt::format("{} = {:.1f} mm", plane.axis_name, slice.position_mm);
    std::string content = slice_svg(plane, slice);
    if (plane.name == "axial") content += "<div class=\"slice-control\"></div>";
    html += fmt::format(
        "<figure class=\"scan\" id=\"{0}\">{1}<figcaption>{0}, <span "
        "class=\"place\">{2}</span></figcaption></figure>\n",
        plane.name, content, place);
  }
  html += "</div>\n";
  const VolumeGrid& grid = data.ct.ct.grid;
  html += fmt::format("<p class=\"note\">{} × {} × {} voxels of {} × {} × {} mm. Window {} to {} HU.", grid.size[0],
                      grid.size[1], grid.size[2], number_text(grid.spacing_mm.x()), number_text(grid.spacing_mm.y()),
                      number_text(grid.spacing_mm.z()), number_text(data.ct.window_low_hu),
                      number_text(data.ct.window_high_hu));
  if (data.ct.occupancy.voxels.empty()) html += " No segmentation is shown.";
  return html + "</p>\n" + slice_legend(data.ct) + "</section>\n";
}

std::string mesh_section(const ReportData& data, bool mesh_is_shown) {
  std::string html = "<section>\n" + heading("mesh", "Mesh");
  const MeshPicture& picture = data.mesh;
  if (picture.mesh.tets.empty() && picture.dihedral_angles.counts.empty()) {
    return html + missing("There is no mesh here.") + "</section>\n";
  }
  if (!picture.mesh.tets.empty()) {
    html += "<dl class=\"cards\">\n" + card("tetrahedra", fmt::format("{}", picture.mesh.tets.size()), "") +
            card("vertices", fmt::format("{}", picture.mesh.vertices.size()), "") +
            card("smallest dihedral angle", fmt::format("{:.1f}°", picture.min_dihedral_deg), "") +
            card("largest dihedral angle", fmt::format("{:.1f}°", picture.max_dihedral_deg), "") +
            card("volume", fmt::format("{:.1f}", picture.volume_mm3 / 1000.0), "cm³") + "</dl>\n";
  }
  if (mesh_is_shown) {
    ReportAnimation still{.name = "mesh",
                          .frames = {frame_of(picture.mesh, skin_faces(picture.mesh), picture.mesh.vertices, {})}};
    html += viewer("mesh-view", "The tetrahedral mesh, opened along a plane",
                   png_data_uri(frame_png(still, 0, data.approach, kStillWidth, kStillHeight)));
  } else if (!picture.mesh.tets.empty()) {
    html += missing("The mesh is too large to be shown on this page.");
  }
  if (!picture.dihedral_angles.counts.empty()) {
    html += "<div class=\"figures narrow\">\n" + figure(histogram_svg(picture.dihedral_angles)) + "</div>\n";
  }
  return html + "</section>\n";
}

std::string cut_section(const ReportData& data) {
  std::string html = "<section>\n" + heading("cut", "The cut",
                                             "The tissue's surface while the needle cuts. Paths are drawn where they "
                                             "were planned, on the stretched tissue before the cut.");
  const auto animation = std::find_if(data.animations.begin(), data.animations.end(),
                                      [](const ReportAnimation& a) { return !a.frames.empty(); });
  if (animation == data.animations.end())
    return html + missing("There are no pictures of the cut here.") + "</section>\n";
  html += viewer(
      "cut-view", "The tissue, the needle and the paths; the slider below moves through time",
      png_data_uri(frame_png(*animation, animation->frames.size() - 1, data.approach, kStillWidth, kStillHeight)));
  return html + "</section>\n";
}

std::string error_section(const ReportData& data) {
  std::string html = "<section>\n" + heading("error", "Where it missed",
                                             "The error is the distance to the tumour edge minus the target: positive "
                                             "is farther from the tumour than intended, negative closer.");
  const std::vector<ReportIncision> drawn = drawn_incisions(data);
  if (drawn.empty()) {
    html += missing("There is no incision contour here.");
  } else {
    const FigureStyle style = common_style(drawn, data.approach, data.axis_names);
    html += "<div class=\"figures wide\">\n" + figure(error_by_angle_svg(drawn, style)) +
            figure(box_plot_svg(drawn, style)) + "</div>\n";
  }
  const std::string table = evaluation_table(data.evaluation);
  html += "<h3>Measures</h3>\n" + (table.empty() ? missing("There is no evaluation here.") : table);
  if (!data.correction.rows.empty()) html += free_table(data.correction);
  if (data.correction_plots.empty()) return html + "</section>\n";
  html += "<div class=\"figures\">\n";
  for (const LinePlot& plot : data.correction_plots) html += "<figure>" + line_plot_svg(plot) + "</figure>\n";
  html += "</div>\n";
  return html + "</section>\n";
}

std::string program_section(const ReportData& data) {
  std::string html = "<section>\n" + heading("program", "Program for the robot");
  if (data.program.empty() && data.checks.empty() && data.program_text.empty()) {
    return html + missing("No program has been exported.") + "</section>\n";
  }
  html += value_table(data.program);
  if (!data.checks.empty()) html += "<h3>Safety checks</h3>\n" + check_table(data.checks);
  if (!data.program_figure.empty()) {
    html +=
        "<h3>As the player ran it</h3>\n<p>The program as written, run with incise's own kinematics and a model of "
        "the controller, not on an arm.</p>\n<div class=\"figures\">\n<figure>" +
        data.program_figure + "</figure>\n</div>\n" + value_table(data.replay);
  }
  if (!data.program_text.empty()) {
    html += "<details><summary>Program text</summary><pre>" + escaped(data.program_text) + "</pre></details>\n";
  }
  return html + "</section>\n";
}

std::string tissue_section(const ReportData& data) {
  if (data.on_tissue.empty()) return "";
  std::string html = "<section>\n" + heading("tissue", data.pictures_heading);
  for (const ReportPicture& picture : data.on_tissue) {
    html += "<h3>" + escaped(picture.title) + "</h3>\n";
    if (!picture.lead.empty()) html += "<p>" + escaped(picture.lead) + "</p>\n";
    html += fmt::format("<div class=\"figures{}\">\n", picture.svgs.size() > 1 ? " pair" : "");
    for (const std::string& svg : picture.svgs) html += figure(svg);
    html += "</div>\n" + value_table(picture.values);
  }
  return html + "</section>\n";
}

std::string record_section(const ReportData& data) {
  std::string html = "<section>\n" + heading("record", "Settings and provenance");
  for (const ReportTable& table : data.tables) html += free_table(table);
  if (!data.stages.empty()) html += "<h3>Stages</h3>\n" + stage_table(data.stages);
  html += "<h3>Provenance</h3>\n" + (data.provenance.empty() ? missing("Version, inputs and command are not known.")
                                                             : value_table(data.provenance));
  html += data.settings.empty() ? missing("The settings are not known.")
                                : fmt::format("<details><summary>All {} settings</summary>", data.settings.size()) +
                                      value_table(data.settings) + "</details>\n";
  if (!data.files.empty()) html += "<h3>Files beside this page</h3>\n" + file_table(data.files);
  return html + "</section>\n";
}

std::string page_footer() {
  return "<footer>\n<p>Made by incise. This page is self-contained and loads nothing from a network.</p>\n"
         "<details><summary>Licence of the 3D library in this page</summary><pre>" +
         escaped(page::file("three_licence.txt")) + "</pre></details>\n</footer>\n";
}

}  // namespace incise
