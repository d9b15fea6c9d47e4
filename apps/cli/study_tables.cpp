#include "study_tables.hpp"

#include <incise/io/atomic_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <ostream>

namespace incise::cli {
namespace {

using TableJson = nlohmann::ordered_json;

constexpr const char* kVirtualNotice = "Virtual specimens, cut by a computed bench: no real tissue, no robot. Nothing here is a clinical result.";

/// The columns of Table II, and where an evaluation holds them.
struct Measure {
  const char* column;
  const char* pointer;
};
constexpr Measure kMeasures[] = {{"mean_abs_error_mm", "/abs_error_mm/mean"},   {"sd_abs_error_mm", "/abs_error_mm/sd"},
                                 {"max_abs_error_mm", "/abs_error_mm/max"},     {"mean_signed_error_mm", "/signed_error_mm/mean"},
                                 {"hu_score", "/hu_score"},                     {"centroid_shift_mm", "/centroid_shift_mm"},
                                 {"close_margin_fraction", "/close_margin/fraction"}};

TableJson measure_at(const TableJson& measures, const char* pointer) {
  const TableJson::json_pointer at(pointer);
  return measures.contains(at) ? measures.at(at) : TableJson(nullptr);
}

double mean_error_mm(const TrialCut& cut) { return cut.measures.at("abs_error_mm").at("mean").get<double>(); }

TableJson row_of(const Trial& trial, const char* cut_name, const std::optional<TrialCut>& cut) {
  TableJson row;
  row["specimen"] = trial.name;
  row["seed"] = trial.seed;
  row["role"] = to_string(trial.role);
  row["kind"] = trial.kind.empty() ? TableJson(nullptr) : TableJson(trial.kind);
  row["cut"] = cut_name;
  row["outcome"] = cut ? measure_at(cut->measures, "/outcome") : TableJson("not_cut");
  for (const Measure& measure : kMeasures) row[measure.column] = cut ? measure_at(cut->measures, measure.pointer) : TableJson(nullptr);
  row["stretch_force_n"] = trial.stretch_force_n;
  row["registration_rmse_mm"] = trial.registration_rmse_mm;
  row["verdict"] = trial.assessment.is_object() ? measure_at(trial.assessment, "/verdict") : TableJson(nullptr);
  row["ended_at"] = trial.ended_at.empty() ? TableJson(nullptr) : TableJson(trial.ended_at);
  return row;
}

std::string cell(const TableJson& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return fmt::format("{:.4g}", value.get<double>());
  return value.dump();
}

/// A cell of a CSV file: quoted where it has to be.
std::string csv_cell(const TableJson& value) {
  std::string text = value.is_number_float() ? fmt::format("{}", value.get<double>()) : cell(value);
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

ReportTable table_of(const std::string& title, const TableJson& rows) {
  ReportTable table;
  table.title = title;
  if (rows.empty()) return table;
  for (const auto& [column, value] : rows.front().items()) table.columns.push_back(column);
  for (const TableJson& row : rows) {
    std::vector<std::string>& cells = table.rows.emplace_back();
    for (const std::string& column : table.columns) cells.push_back(row.contains(column) ? cell(row.at(column)) : "");
  }
  return table;
}

void add_picture(ReportData& data, const std::filesystem::path& svg, const std::string& title, const std::string& lead) {
  if (!std::filesystem::exists(svg)) return;
  data.on_tissue.push_back({title, lead, read_text(svg), {}});
}

/// What the paper measured, as the paper's: never ours.
ReportTable papers_table() {
  ReportTable table;
  table.title = "For comparison: what the paper reports of four ex vivo tongues (its Table II; not ours)";
  table.columns = {"specimen", "cut", "mean_abs_error_mm", "sd_abs_error_mm", "hu_score", "centroid_shift_mm"};
  table.rows = {{"S1 (paper)", "as planned", "1.57", "0.66", "0.08", "1.96"},
                {"S2 (paper)", "as planned", "1.91", "0.90", "0.12", "2.22"},
                {"S1, S2 (paper)", "as planned", "1.73", "0.80", "0.10", ""},
                {"S3, S4 (paper)", "corrected", "1.46", "", "0.06", ""}};
  return table;
}

}  // namespace

const char* to_string(TrialRole role) {
  switch (role) {
    case TrialRole::Calibrate: return "calibrate";
    case TrialRole::Test: return "test";
    case TrialRole::Outside: return "outside";
  }
  return "unknown";
}

TrialSummary summary_of(const std::vector<Trial>& trials, TrialRole role, std::optional<TrialCut> Trial::*after) {
  TrialSummary summary;
  double uncorrected_mm = 0.0;
  for (const Trial& trial : trials) {
    if (trial.role != role) continue;
    ++summary.specimens;
    if (!trial.planned) continue;
    const double before_mm = mean_error_mm(*trial.planned);
    if (!(trial.*after)) {
      ++summary.uncorrected;
      uncorrected_mm += before_mm;
      continue;
    }
    const double after_mm = mean_error_mm(*(trial.*after));
    ++summary.pairs;
    summary.mean_before_mm += before_mm;
    summary.mean_after_mm += after_mm;
    if (after_mm > before_mm) ++summary.worse;
    summary.most_worse_mm = std::max(summary.most_worse_mm, after_mm - before_mm);
  }
  if (summary.pairs == 0) return summary;
  summary.gain_percent_of_all = 100.0 * (1.0 - (summary.mean_after_mm + uncorrected_mm) / (summary.mean_before_mm + uncorrected_mm));
  summary.mean_before_mm /= static_cast<double>(summary.pairs);
  summary.mean_after_mm /= static_cast<double>(summary.pairs);
  summary.gain_percent = 100.0 * (1.0 - summary.mean_after_mm / summary.mean_before_mm);
  return summary;
}

TableJson to_json(const TrialSummary& summary) {
  const auto number = [&summary](double value) { return summary.pairs > 0 ? TableJson(value) : TableJson(nullptr); };
  return {{"specimens", summary.specimens},
          {"pairs", summary.pairs},
          {"uncorrected", summary.uncorrected},
          {"mean_before_mm", number(summary.mean_before_mm)},
          {"mean_after_mm", number(summary.mean_after_mm)},
          {"gain_percent", number(summary.gain_percent)},
          {"gain_percent_of_all", number(summary.gain_percent_of_all)},
          {"worse", summary.worse},
          {"most_worse_mm", summary.most_worse_mm}};
}

TableJson known_physics_json(const std::vector<Trial>& trials) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const Trial& trial : trials) {
    const TableJson mean = trial.known_physics.is_object() ? measure_at(trial.known_physics, "/mean_abs_error_mm") : TableJson(nullptr);
    if (!mean.is_number()) continue;
    sum += mean.get<double>();
    ++count;
  }
  return {{"specimens", count}, {"mean_after_mm", count > 0 ? TableJson(sum / static_cast<double>(count)) : TableJson(nullptr)}};
}

TableJson table_2_json(const std::vector<Trial>& trials) {
  TableJson rows = TableJson::array();
  for (const Trial& trial : trials) {
    rows.push_back(row_of(trial, "planned", trial.planned));
    if (trial.role != TrialRole::Calibrate) rows.push_back(row_of(trial, "corrected", trial.corrected));
    if (trial.paper_pass) rows.push_back(row_of(trial, "paper_pass", trial.paper_pass));
  }
  return rows;
}

TableJson assessments_json(const std::vector<Trial>& trials) {
  TableJson list = TableJson::array();
  for (const Trial& trial : trials) {
    if (!trial.assessment.is_object()) continue;
    TableJson entry{{"specimen", trial.name}, {"role", to_string(trial.role)}, {"kind", trial.kind.empty() ? TableJson(nullptr) : TableJson(trial.kind)}};
    for (const char* key : {"verdict", "reasons", "expected_gain_mm", "p_worse", "p_close_margin", "distances"})
      entry[key] = trial.assessment.value(key, TableJson());
    const bool is_pair = trial.planned && trial.corrected;
    entry["gain_mm"] = is_pair ? TableJson(mean_error_mm(*trial.planned) - mean_error_mm(*trial.corrected)) : TableJson(nullptr);
    list.push_back(std::move(entry));
  }
  return list;
}

void write_table_2(const std::filesystem::path& file, const std::vector<Trial>& trials) {
  const TableJson rows = table_2_json(trials);
  write_atomically(file, [&rows](std::ostream& out) {
    bool is_first = true;
    for (const auto& [column, value] : rows.front().items()) out << (std::exchange(is_first, false) ? "" : ",") << column;
    out << '\n';
    for (const TableJson& row : rows) {
      is_first = true;
      for (const TableJson& value : row) out << (std::exchange(is_first, false) ? "" : ",") << csv_cell(value);
      out << '\n';
    }
  });
}

ReportData experiment_report(const std::vector<Trial>& trials, const TableJson& result, const std::filesystem::path& folder) {
  ReportData data;
  data.title = "Virtual experiment: cut, calibrate, correct, cut again";
  data.virtual_notice = kVirtualNotice;
  data.is_of_a_study = false;
  data.pictures_heading = "Results on the virtual bench";
  const TrialSummary summary = summary_of(trials, TrialRole::Test);
  if (summary.pairs > 0) {
    data.subtitle = fmt::format("Mean absolute error of the photographs of {} virtual specimens: {:.2f} mm as planned, {:.2f} mm corrected ({:.0f} % less); {} worse.",
                                summary.pairs, summary.mean_before_mm, summary.mean_after_mm, summary.gain_percent, summary.worse);
  }
  add_picture(data, folder / "comparison/box_plot.svg", "Errors before and after", "Absolute and signed errors along the contours of the virtual photographs, after the paper's Fig. 6 a, b.");
  add_picture(data, folder / "comparison/error_by_clock.svg", "Error round the ring", "Signed error by the place on a clock face over the tumour.");
  add_picture(data, folder / "advice/roc.svg", "Was the advice right?", "Stated probability that the corrected cut is the worse one, against which one it was.");
  add_picture(data, folder / "advice/reliability.svg", "Close margins, stated and seen", "Stated probability of a margin below 2.2 mm somewhere, against how often there was one.");
  add_picture(data, folder / "table_1/table_1.svg", "Table I of this experiment", "Simulated speed and dullness against the photographs, after the paper's Table I.");
  add_picture(data, folder / "calibration/fit.svg", "Calibration", "Signed error photographed and simulated, and what the data say of each parameter.");
  data.tables.push_back(table_of("Table II of this experiment (virtual): every cut, measured in its photograph", table_2_json(trials)));
  data.tables.push_back(papers_table());
  if (result.contains("table_1") && result.at("table_1").is_array()) data.tables.push_back(table_of("Table I of this experiment (simulated, against virtual photographs)", result.at("table_1")));
  ReportTable commands{"Commands", {"command"}, {}};
  for (const Trial& trial : trials)
    for (const std::string& line : trial.commands) commands.rows.push_back({line});
  data.tables.push_back(std::move(commands));
  return data;
}

}  // namespace incise::cli
