#include "report/sections.hpp"
#include "report/tables.hpp"

#include <incise/io/text_encoding.hpp>
#include <incise/report/figures.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise {
namespace {

/// A finding of the run: a reason of its verdict, or a notice.
struct Finding {
  std::string_view kind;  ///< "refused", "caution", "warning", "notice"
  std::string name, place, text;
};

/// The verdict's reasons come worst first; notices follow, warnings before the others.
std::vector<Finding> findings_of(const ReportData& data) {
  std::vector<Finding> findings;
  if (data.verdict) {
    for (const VerdictReason& reason : data.verdict->reasons()) {
      findings.push_back({to_string(reason.severity), reason.id, reason.at ? reason.at->text : "", reason.message});
    }
  }
  for (const Severity severity : {Severity::Warning, Severity::Notice, Severity::Detail}) {
    for (const ReportNotice& notice : data.notices) {
      if (notice.severity != severity) continue;
      findings.push_back({severity == Severity::Warning ? "warning" : "notice", "", "", notice.text});
    }
  }
  return findings;
}

/// "2 refused, 1 caution, 3 warnings"
std::string counts_of(const std::vector<Finding>& findings) {
  std::string text;
  for (const std::string_view kind : {"refused", "caution", "warning", "notice"}) {
    const auto count =
        std::count_if(findings.begin(), findings.end(), [kind](const Finding& f) { return f.kind == kind; });
    if (count == 0) continue;
    text += fmt::format("{}{} {}{}", text.empty() ? "" : ", ", count, kind, count > 1 && kind != "refused" ? "s" : "");
  }
  return text;
}

std::string verdict_line(const ReportData& data) {
  if (!data.verdict) {
    return "<p class=\"verdict none\" role=\"status\"><strong>Not judged</strong> These results have no "
           "verdict.</p>\n";
  }
  static constexpr std::array<const char*, 3> kWords{"OK", "Caution", "Refused"};
  const VerdictStatus status = data.verdict->status();
  const std::vector<VerdictReason>& reasons = data.verdict->reasons();
  const std::string more =
      reasons.size() < 2 ? "" : fmt::format(" <a href=\"#findings\">{} more</a>", reasons.size() - 1);
  return fmt::format(
      "<p class=\"verdict {}\" role=\"status\"><strong>{}</strong> <span>{}.{}</span></p>\n", to_string(status),
      kWords[static_cast<std::size_t>(status)],
      reasons.empty() ? "No reason against the cut is known" : escaped(with_capital(reasons.front().message)), more);
}

std::string contour_figures(const ReportData& data) {
  const std::vector<ReportIncision> drawn = drawn_incisions(data);
  FigureStyle style = common_style(drawn, data.approach, data.axis_names);
  std::string html;
  for (const ReportIncision& incision : drawn) {
    html += "<figure>";
    for (const ErrorColors colors : {ErrorColors::Safe, ErrorColors::Jet}) {
      style.colors = colors;
      html += fmt::format("<div class=\"{}\">{}</div>", to_string(colors), contour_figure_svg(incision, style));
    }
    html += "</figure>\n";
  }
  return html;
}

/// Shown by the script that makes it work.
constexpr const char* kColorSwitch =
    "<p class=\"hidden switch\">Colours: <button type=\"button\" data-set-colors=\"safe\">safe</button> "
    "<button type=\"button\" data-set-colors=\"jet\">jet</button></p>\n";

/// What a status means for a robot program.
const char* consequence_of(VerdictStatus status) {
  static constexpr std::array<const char*, 3> kWords{
      "Nothing that the simulation knows argues against this cut.",
      "A robot program is written only if a person accepts each caution by name.",
      "This cut must not be carried out: there is no robot program for it."};
  return kWords[static_cast<std::size_t>(status)];
}

}  // namespace

std::string answer_section(const ReportData& data) {
  std::string html = "<section class=\"answer\" id=\"result\" aria-label=\"Result\">\n" + verdict_line(data);
  if (data.incisions.empty()) {
    return html + "<p class=\"missing\">No incision has been evaluated yet.</p>\n</section>\n";
  }
  html += "<div class=\"before-after\">\n<div class=\"numbers\">\n" + answer_table(data.incisions);
  for (const std::string& remark : data.remarks) html += "<p>" + escaped(remark) + "</p>\n";
  if (drawn_incisions(data).empty()) html += "<p class=\"missing\">There is no incision contour here.</p>\n";
  return html + kColorSwitch + "</div>\n" + contour_figures(data) + "</div>\n</section>\n";
}

std::string findings_section(const ReportData& data) {
  const std::vector<Finding> findings = findings_of(data);
  std::string html = "<section>\n<h2 id=\"findings\">Findings</h2>\n";
  if (findings.empty()) return html + "<p class=\"missing\">There are no findings.</p>\n</section>\n";
  html += fmt::format("<p class=\"lead\">{}, worst first. {}</p>\n<ul class=\"findings\">\n",
                      with_capital(counts_of(findings)), data.verdict ? consequence_of(data.verdict->status()) : "");
  for (const Finding& finding : findings) {
    const std::string place = finding.place.empty() ? "" : " (" + escaped(finding.place) + ")";
    html += fmt::format("<li class=\"{0}\"><strong>{0}{1}</strong>{2}: {3}</li>\n", finding.kind,
                        finding.name.empty() ? "" : " <code>" + escaped(finding.name) + "</code>", place,
                        escaped(finding.text));
  }
  return html + "</ul>\n</section>\n";
}

std::string caveats_section(const ReportData& data) {
  if (data.caveats.empty()) return "";
  std::string html =
      "<section>\n<h2 id=\"caveats\">What this report does not know</h2>\n"
      "<p class=\"lead\">These limits apply to every run like this one, whatever it found.</p>\n<ul>\n";
  for (const std::string& caveat : data.caveats) html += "<li>" + escaped(caveat) + "</li>\n";
  return html + "</ul>\n</section>\n";
}

}  // namespace incise
