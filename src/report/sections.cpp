#include "report/sections.hpp"

#include "report/page_files.hpp"
#include "report/svg.hpp"
#include "report/tables.hpp"

#include <incise/io/text_encoding.hpp>
#include <incise/report/figures.hpp>
#include <incise/report/html_report.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

std::string figure(const std::string& content, std::string_view caption = "", std::string_view attributes = "") {
  const std::string text = caption.empty() ? "" : "<figcaption>" + escaped(caption) + "</figcaption>";
  return fmt::format("<figure {}>{}{}</figure>\n", attributes, content, text);
}

std::string card(std::string_view label, std::string_view value, std::string_view unit, std::string_view note,
                 std::string_view tone = "") {
  return fmt::format(
      "<div class=\"card\"><dt>{}</dt><dd class=\"value {}\">{} <span class=\"unit\">{}</span></dd>"
      "<dd class=\"note\">{}</dd></div>\n",
      escaped(label), tone, escaped(value), escaped(unit), escaped(note));
}

std::string outcome_words(Outcome outcome) {
  std::string words(to_string(outcome));
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string outcome_note(const ReportIncision& incision) {
  std::string note;
  if (incision.closed_loop) note = *incision.closed_loop ? "ring closed" : "ring open";
  if (incision.negative_margin) {
    note += std::string(note.empty() ? "" : ", ") + (*incision.negative_margin ? "negative margin" : "positive margin");
  }
  return note;
}

std::string headline_cards(const ReportData& data) {
  std::string cards;
  for (const ReportIncision& incision : data.incisions) {
    cards +=
        card("mean |error|, " + incision.name, fmt::format("{:.2f}", incision.mean_abs_error_mm), "mm",
             fmt::format("{}, target {} mm", incision.measured_contour.empty() ? "incision" : incision.measured_contour,
                         number_text(incision.target_mm)));
  }
  if (data.incisions.size() >= 2 && data.incisions.front().mean_abs_error_mm > 0.0) {
    const double before = data.incisions.front().mean_abs_error_mm;
    const double change = 100.0 * (data.incisions.back().mean_abs_error_mm / before - 1.0);
    cards += card("change of the mean |error|", fmt::format("{}{:.0f}", change < 0.0 ? "−" : "+", std::abs(change)),
                  "%", fmt::format("{} to {}", data.incisions.front().name, data.incisions.back().name),
                  change < 0.0 ? "good" : "bad");
  }
  for (const ReportIncision& incision : data.incisions) {
    const bool is_success = incision.outcome == Outcome::Success;
    const VerdictStatus verdict = incision.verdict.status();
    const bool is_good = is_success && verdict == VerdictStatus::Ok;
    const std::string note = verdict == VerdictStatus::Ok ? outcome_note(incision) : fmt::format("verdict: {} ({})", to_string(verdict), incision.verdict.reasons().front().id);
    cards += card("outcome, " + incision.name, (is_good ? "✓ " : is_success ? "" : "✗ ") + outcome_words(incision.outcome), "", note,
                  is_good ? "good" : "bad");
  }
  for (const ReportHeadline& headline : data.headlines) {
    cards += card(headline.label, headline.value, headline.unit, headline.note);
  }
  return cards.empty() ? "" : "<dl class=\"cards\">\n" + cards + "</dl>\n";
}

/// What the verdict says, before any other number; nothing where there is none.
std::string verdict_box(const std::optional<Verdict>& verdict) {
  if (!verdict) return "";
  static constexpr std::array<const char*, 3> kWords{"Nothing that the simulation knows argues against this cut.",
                                                     "Something argues against this cut: a robot program needs each reason accepted by name.",
                                                     "This cut must not be carried out. There is no robot program for it."};
  const auto status = verdict->status();
  std::string html = fmt::format("<div class=\"verdict {0}\" role=\"status\"><p><strong>Verdict: {0}.</strong> {1}</p>\n", to_string(status),
                                 kWords[static_cast<std::size_t>(status)]);
  if (!verdict->reasons().empty()) html += "<ul>\n";
  for (const VerdictReason& reason : verdict->reasons()) {
    const std::string place = reason.at && !reason.at->text.empty() ? fmt::format(" ({})", reason.at->text) : std::string();
    html += fmt::format("<li class=\"{0}\"><strong>{0}: {1}</strong>{2}: {3}</li>\n", to_string(reason.severity), escaped(reason.id), escaped(place),
                        escaped(reason.message));
  }
  if (!verdict->reasons().empty()) html += "</ul>\n";
  return html + "</div>\n";
}

std::string notice_list(const ReportData& data) {
  std::string items;
  for (const ReportNotice& notice : data.notices) {
    const char* kind = notice.severity == Severity::Warning  ? "warning"
                       : notice.severity == Severity::Notice ? "notice"
                                                             : "detail";
    const char* word = notice.severity == Severity::Warning ? "<strong>Warning.</strong> " : "";
    items += fmt::format("<li class=\"{}\">{}{}</li>\n", kind, word, escaped(notice.text));
  }
  return items.empty() ? "" : "<ul class=\"notices\">\n" + items + "</ul>\n";
}

/// A 3D view's frame: a still picture that the script replaces.
std::string viewer(std::string_view id, std::string_view label, const std::string& still) {
  return fmt::format(
      "<div class=\"viewer\" id=\"{}\">\n<div class=\"stage\" aria-label=\"{}\">"
      "<img class=\"still\" alt=\"{}\" src=\"{}\"></div>\n<div class=\"controls\"></div>\n</div>\n",
      id, escaped(label), escaped(label), still);
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
    html += "<a href=\"#result\">Result</a><a href=\"#scan\">Scan</a><a href=\"#mesh\">Mesh</a><a href=\"#cut\">Cut</a>"
            "<a href=\"#error\">Error</a><a href=\"#kerf\">Kerf</a><a href=\"#program\">Program</a>";
  }
  if (!data.on_tissue.empty()) html += "<a href=\"#tissue\">" + escaped(data.pictures_heading) + "</a>";
  html += "<a href=\"#record\">Settings and provenance</a></nav>\n</header>\n";
  return html;
}

std::string result_section(const ReportData& data) {
  const std::string cards = headline_cards(data);
  return "<section>\n" + heading("result", "Result") + verdict_box(data.verdict) +
         (cards.empty() ? missing("No incision has been evaluated yet.") : cards) + notice_list(data) + "</section>\n";
}

std::string scan_section(const ReportData& data, const std::array<SlicePlane, 3>& planes) {
  std::string html = "<section>\n" + heading("scan", "Scan and segmentation", data.ct.caption);
  if (data.ct.ct.voxels.empty()) return html + missing("There is no CT here.") + "</section>\n";
  html += "<div class=\"figures\">\n";
  for (const SlicePlane& plane : planes) {
    const Slice& slice = plane.slices[plane.slices.size() / 2];
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
  if (data.ct.occupancy.voxels.empty()) return html + " No segmentation is shown.</p>\n</section>\n";
  return html +
         " The line is the border of the segmented tissue. <label class=\"hidden\"><input type=\"checkbox\" "
         "id=\"outline-switch\" checked> show it</label></p>\n</section>\n";
}

std::string mesh_section(const ReportData& data, bool mesh_is_shown) {
  std::string html = "<section>\n" + heading("mesh", "Mesh");
  const MeshPicture& picture = data.mesh;
  if (picture.mesh.tets.empty() && picture.dihedral_angles.counts.empty()) {
    return html + missing("There is no mesh here.") + "</section>\n";
  }
  if (!picture.mesh.tets.empty()) {
    html += "<dl class=\"cards\">\n" + card("tetrahedra", fmt::format("{}", picture.mesh.tets.size()), "", "") +
            card("vertices", fmt::format("{}", picture.mesh.vertices.size()), "", "") +
            card("smallest dihedral angle", fmt::format("{:.1f}°", picture.min_dihedral_deg), "", "") +
            card("largest dihedral angle", fmt::format("{:.1f}°", picture.max_dihedral_deg), "", "") +
            card("volume", fmt::format("{:.1f}", picture.volume_mm3 / 1000.0), "cm³", "") + "</dl>\n";
  }
  if (mesh_is_shown) {
    ReportAnimation still{.name = "mesh",
                          .frames = {frame_of(picture.mesh, boundary_faces(picture.mesh), picture.mesh.vertices, {})}};
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
  std::vector<ReportIncision> drawn;
  for (const ReportIncision& incision : data.incisions) {
    if (incision.incision.points.size() >= 2) drawn.push_back(incision);
  }
  if (drawn.empty()) {
    html += missing("There is no incision contour here.");
  } else {
    FigureStyle style{
        .error_limit_mm = common_error_limit_mm(drawn), .approach = data.approach, .axis_names = data.axis_names};
    FigureStyle jet = style;
    jet.colors = ErrorColors::Jet;
    html +=
        "<p class=\"hidden\">Colours of the error: <button type=\"button\" data-set-colors=\"safe\">safe for all "
        "colour vision</button> "
        "<button type=\"button\" data-set-colors=\"jet\">jet, as in the paper</button></p>\n<div class=\"figures\">\n";
    for (const ReportIncision& incision : drawn) {
      html += figure("<div class=\"safe\">" + contour_figure_svg(incision, style) + "</div><div class=\"jet\">" +
                     contour_figure_svg(incision, jet) + "</div>");
    }
    html += "</div>\n<h3>Along the incision</h3>\n<div class=\"figures wide\">\n" +
            figure(error_by_angle_svg(drawn, style)) +
            "</div>\n<h3>Distribution</h3>\n<div class=\"figures narrow\">\n" + figure(box_plot_svg(drawn, style)) +
            "</div>\n";
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
    html += "<h3>As the player ran it</h3>\n<p>The program as written, run through incise's own kinematics and a model of the "
            "controller; not on an arm.</p>\n<div class=\"figures\">\n<figure>" +
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
    html += "<div class=\"figures\">\n<figure>" + picture.svg + "</figure>\n</div>\n" + value_table(picture.values);
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
  return "<footer>\n<p>Made by incise. This page is complete in itself and loads nothing from a network.</p>\n"
         "<details><summary>Licence of the 3D library in this page</summary><pre>" +
         escaped(page::file("three_licence.txt")) + "</pre></details>\n</footer>\n";
}

}  // namespace incise
