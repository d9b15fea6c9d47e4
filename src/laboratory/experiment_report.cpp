#include "laboratory/experiment_report.hpp"

#include <incise/io/atomic_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/report/figures.hpp>
#include <incise/report/number_text.hpp>
#include <incise/storage/evaluation_file.hpp>

#include <fmt/format.h>

namespace incise::laboratory {
namespace {

using ReportJson = nlohmann::ordered_json;

constexpr const char* kVirtualNotice =
    "Virtual specimens, cut by a computed bench: no real tissue, no robot. Nothing here is a clinical result.";

ReportTable table_of(const std::string& title, const ReportJson& rows) {
  ReportTable table;
  table.title = title;
  if (rows.empty()) return table;
  for (const auto& [column, value] : rows.front().items()) table.columns.push_back(column);
  for (const ReportJson& row : rows) {
    std::vector<std::string>& cells = table.rows.emplace_back();
    for (const std::string& column : table.columns)
      cells.push_back(row.contains(column) ? cell(row.at(column), column) : "");
  }
  return table;
}

void add_picture(ReportData& data, const std::filesystem::path& svg, const std::string& title,
                 const std::string& lead) {
  if (!std::filesystem::exists(svg)) return;
  data.on_tissue.push_back({title, lead, {read_text(svg)}, {}});
}

/// The paper's measurements, marked as the paper's.
ReportTable papers_table() {
  ReportTable table;
  table.title = "For comparison: the paper's results on four ex vivo tongues (its Table II; not ours)";
  table.columns = {"specimen", "cut", "mean_abs_error_mm", "sd_abs_error_mm", "hu_score", "centroid_shift_mm"};
  table.rows = {{"S1 (paper)", "as planned", "1.57", "0.66", "0.08", "1.96"},
                {"S2 (paper)", "as planned", "1.91", "0.90", "0.12", "2.22"},
                {"S1, S2 (paper)", "as planned", "1.73", "0.80", "0.10", ""},
                {"S3, S4 (paper)", "corrected", "1.46", "", "0.06", ""}};
  return table;
}

/// A cut as its photograph shows it.
ReportIncision photographed_incision(const Trial& trial, const MeasuredCut& cut, const char* name) {
  const ReportJson json = read_json(cut.evaluation);
  ReportIncision incision;
  incision.name = fmt::format("{} {} (virtual)", trial.name, name);
  incision.closed_loop = true;
  incision.mean_abs_error_mm = json.at("abs_error_mm").at("mean").get<double>();
  incision.target_mm = json.at("target_mm").get<double>();
  incision.measured_contour = "kerf's inner edge";
  incision.tumor_edge = read_photographed_cut(cut.evaluation).tumor_edge;
  const ReportJson& points = json.at("points");
  const auto x = points.at("x_mm").get<std::vector<double>>(), y = points.at("y_mm").get<std::vector<double>>();
  for (std::size_t i = 0; i < x.size(); ++i) incision.incision.points.emplace_back(x[i], y.at(i), 0.0);
  incision.signed_error_mm = points.at("signed_error_mm").get<std::vector<double>>();
  return incision;
}

/// Both cuts of a specimen side by side: after the paper's Fig. 5 c to f, in the colours of its Fig. 6 c, d.
void add_pair(ReportData& data, const Trial& trial) {
  const std::array<ReportIncision, 2> cuts{photographed_incision(trial, *trial.planned.measured, "as planned"),
                                           photographed_incision(trial, *trial.corrected.measured, "corrected")};
  const FigureStyle style =
      common_style(cuts, read_photographed_cut(trial.planned.measured->evaluation).approach, data.axis_names);
  ReportPicture picture{
      fmt::format("{}, as planned and corrected (virtual)", trial.name),
      "Tumour edge and inner edge of the kerf, found in the virtual photographs; colour: signed error.",
      {},
      {}};
  for (const ReportIncision& cut : cuts) picture.svgs.push_back(contour_figure_svg(cut, style));
  data.on_tissue.push_back(std::move(picture));
}

/// The first two specimens that were cut twice, as the paper shows two.
void add_pairs(ReportData& data, const std::vector<Trial>& trials) {
  int shown = 0;
  for (const Trial& trial : trials) {
    if (trial.role != TrialRole::Test || !trial.planned.measured || !trial.corrected.measured || shown == 2) continue;
    add_pair(data, trial);
    ++shown;
  }
}

/// "S5 (register)": each specimen that a step refused, and which step.
std::string refused_specimens(const std::vector<Trial>& trials) {
  std::string list;
  for (const Trial& trial : trials) {
    for (const std::string& reason : refusals_of(trial)) {
      list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", trial.name, reason.substr(0, reason.find(':')));
    }
  }
  return list;
}

/// The experiment's main result: every path, and its difference from the best one without simulation.
ReportTable outcome_table(const PathComparison& paths, const ReportJson& result) {
  ReportTable table{
      "Result (virtual): mean over specimens of the photographs' mean absolute error, path by path",
      {"path", "simulated", "specimens", "mean_mm", "worse", "by more than 0.1 mm, or opened", "not cut",
       "margin below 2.2 mm, of closed", "difference from the best without simulation, mm", "95 % interval, mm"},
      {}};
  for (const PathResult& path : paths.paths) {
    const bool is_best = path.name == paths.best_without_simulation;
    table.rows.push_back(
        {path.name, path.is_simulated ? "yes" : "no", std::to_string(path.pairs),
         path.mean_mm ? measure_text(*path.mean_mm, "mm") : "", std::to_string(path.worse), std::to_string(path.harmed),
         std::to_string(path.uncut), fmt::format("{} of {}", path.close_margins, path.closed),
         is_best              ? "best"
         : path.difference_mm ? fmt::format("{:+.2f}", *path.difference_mm)
                              : "",
         path.confidence ? fmt::format("{:+.2f} to {:+.2f}", path.confidence->low, path.confidence->high) : ""});
  }
  if (result.contains("known_physics")) {
    const ReportJson& floor = result.at("known_physics");
    table.rows.push_back({"known-physics limit (arm's errors unknown to the planner)", "",
                          cell(floor.at("specimens"), ""), cell(floor.at("mean_after_mm"), "mean_after_mm"), "", "", "",
                          "", "", ""});
  }
  return table;
}

/// The claim that the results support: the corrections against the best path without a simulated cut.
std::string claim(const PathComparison& paths) {
  if (!paths.best_without_simulation)
    return "No rival without a simulated cut can be compared, so no benefit of simulation can be claimed. ";
  std::string claims;
  for (const char* name : {"incise", "hybrid", "learned"}) {
    if (const std::string one = claim_of(paths, name); !one.empty()) claims += one + ". ";
  }
  return claims;
}

/// The simulated tool as fitted to the cuts of the calibration's specimens.
ReportTable fit_table(const ReportJson& result) {
  ReportTable table{"Calibration (virtual): what the photographs say about the simulated tool",
                    {"parameter", "mean", "sd", "identified by the data", "at the end of the simulated range"},
                    {}};
  const ReportJson& fit = result.at("fit");
  for (const char* parameter : {"drag_length_mm", "ln_stiffness_factor", "bias_mm"}) {
    const ReportJson& estimate = fit.at(parameter);
    if (std::string_view(parameter) == "ln_stiffness_factor" && !fit.at("stiffness_varied").get<bool>()) {
      table.rows.push_back({parameter, "", "", "not varied", ""});
      continue;
    }
    table.rows.push_back({parameter, measure_text(estimate.at("mean").get<double>(), "mm"),
                          measure_text(estimate.at("sd").get<double>(), "mm"), estimate.at("told").get<std::string>(),
                          estimate.at("at_limit").get<bool>() ? "yes" : "no"});
  }
  for (const ReportJson& one : result.at("left_out_of_calibration"))
    table.rows.push_back(
        {"left out: " + one.at("name").get<std::string>(), "", "", one.at("reason").get<std::string>(), ""});
  return table;
}

}  // namespace

ReportData experiment_report(const std::vector<Trial>& trials, const PathComparison& paths, const ReportJson& result,
                             const std::filesystem::path& folder) {
  ReportData data;
  data.title = "Virtual experiment: cut, calibrate, correct, cut again";
  data.virtual_notice = kVirtualNotice;
  data.is_of_a_study = false;
  data.pictures_heading = "Results on the virtual bench";
  const TrialSummary summary = summary_of(trials, TrialRole::Test);
  if (summary.pairs > 0) {
    data.subtitle = fmt::format(
        "Mean absolute error of the photographs of {} virtual specimen{}: {:.2f} mm as planned, {:.2f} mm corrected "
        "({:.0f} % less); {} worse. ",
        summary.pairs, summary.pairs == 1 ? "" : "s", summary.mean_before_mm, summary.mean_after_mm,
        summary.gain_percent, summary.worse);
    data.subtitle += claim(paths);
  }
  const std::string refused = refused_specimens(trials);
  data.subtitle += refused.empty() ? "No step refused a specimen." : "Refused (step in brackets): " + refused + ".";
  add_picture(
      data, folder / "comparison/box_plot.svg", "Errors before and after",
      "Absolute and signed errors along the contours of the virtual photographs, after the paper's Fig. 6 a, b.");
  add_pairs(data, trials);
  add_picture(data, folder / "comparison/error_by_clock.svg", "Error round the ring",
              "Signed error by clock position over the tumour.");
  add_picture(data, folder / "advice/roc.svg", "Was the advice right?",
              "Stated probability that the corrected cut is the worse one, against which cut was the worse one.");
  add_picture(data, folder / "advice/reliability.svg", "Close margins, stated and seen",
              "Stated probability of a margin below 2.2 mm somewhere, against how often there was one.");
  if (result.at("table_1").is_array())
    add_picture(data, folder / "table_1/table_1.svg", "Table I of this experiment",
                "Simulated speed and dullness against the photographs, after the paper's Table I.");
  add_picture(data, folder / "calibration/fit.svg", "Calibration",
              "Photographed and simulated signed errors, and the posterior of each parameter.");
  data.tables.push_back(outcome_table(paths, result));
  if (result.at("fit").is_object()) data.tables.push_back(fit_table(result));
  data.tables.push_back(
      table_of("Table II of this experiment (virtual): every cut, measured in its photograph", table_2_json(trials)));
  data.tables.push_back(papers_table());
  if (result.contains("table_1") && result.at("table_1").is_array())
    data.tables.push_back(
        table_of("Table I of this experiment (simulated, against virtual photographs)", result.at("table_1")));
  ReportTable commands{"Commands", {"command"}, {}};
  for (const Trial& trial : trials)
    for (const std::string& line : trial.commands) commands.rows.push_back({line});
  data.tables.push_back(std::move(commands));
  return data;
}

}  // namespace incise::laboratory
