#include "laboratory/experiment_tables.hpp"

#include <incise/core/described_json.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/report/number_text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <ostream>

namespace incise::laboratory {
namespace {

using TableJson = nlohmann::ordered_json;

/// The columns of Table II, and where an evaluation holds them.
struct Measure {
  const char* column;
  const char* pointer;
};
constexpr Measure kMeasures[] = {{"mean_abs_error_mm", "/abs_error_mm/mean"},
                                 {"sd_abs_error_mm", "/abs_error_mm/sd"},
                                 {"max_abs_error_mm", "/abs_error_mm/max"},
                                 {"mean_signed_error_mm", "/signed_error_mm/mean"},
                                 {"hu_score", "/hu_score"},
                                 {"centroid_shift_mm", "/centroid_shift_mm"},
                                 {"close_margin_fraction", "/close_margin/fraction"}};

TableJson row_of(const Trial& trial, std::string_view cut_name, const TrialCut& cut) {
  TableJson row;
  row["specimen"] = trial.name;
  row["seed"] = trial.seed;
  row["role"] = to_string(trial.role);
  row["kind"] = trial.kind.empty() ? TableJson(nullptr) : TableJson(trial.kind);
  row["cut"] = cut_name;
  row["outcome"] = cut.measured ? json_part(cut.measured->measures, "/outcome")
                                : TableJson(cut.is_made ? "no_closed_ring" : "not_cut");
  for (const Measure& measure : kMeasures)
    row[measure.column] = cut.measured ? json_part(cut.measured->measures, measure.pointer) : TableJson(nullptr);
  row["stretch_force_n"] = trial.stretch_force_n;
  row["registration_rmse_mm"] = to_json(trial.registration_rmse_mm);
  row["advice"] = json_part(trial.assessment, "/advice");
  const std::string& ended_at = trial.ended_at.empty() ? cut.ended_at : trial.ended_at;
  row["ended_at"] = ended_at.empty() ? TableJson(nullptr) : TableJson(ended_at);
  return row;
}

/// A cell of a CSV file: quoted where it has to be.
std::string csv_cell(const TableJson& value) {
  std::string text = value.is_number_float() ? fmt::format("{}", value.get<double>()) : cell(value, "");
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

TableJson json_part(const TableJson& json, const char* pointer) {
  const TableJson::json_pointer at(pointer);
  return json.contains(at) ? json.at(at) : TableJson(nullptr);
}

std::string cell(const TableJson& value, std::string_view column) {
  if (value.is_null()) return "";
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_number_float()) return value.dump();
  const bool is_share = column.ends_with("_score") || column.ends_with("_fraction");
  return measure_text(value.get<double>(), is_share ? "" : "mm");
}

std::vector<std::string> refusals_of(const Trial& trial) {
  std::vector<const std::string*> reasons{&trial.ended_at, &trial.planned.ended_at, &trial.corrected.ended_at};
  for (const RivalCut& rival : trial.rivals) reasons.push_back(&rival.cut.ended_at);
  for (const LearningCut& learning : trial.learning) reasons.push_back(&learning.cut.ended_at);
  reasons.push_back(&trial.withheld.ended_at);
  std::vector<std::string> list;
  for (const std::string* reason : reasons)
    if (!reason->empty()) list.push_back(*reason);
  return list;
}

std::string learning_name(RivalPath path, std::size_t photographs) {
  return fmt::format("{}_{}", to_string(path), photographs);
}

const TrialCut* find_rival(const Trial& trial, RivalPath path) {
  for (const RivalCut& rival : trial.rivals)
    if (rival.path == path) return &rival.cut;
  return nullptr;
}

std::optional<double> mean_error_mm(const TrialCut& cut) {
  if (!cut.measured) return std::nullopt;
  return cut.measured->measures.at("abs_error_mm").at("mean").get<double>();
}

TrialSummary summary_of(const std::vector<Trial>& trials, TrialRole role, std::optional<RivalPath> path) {
  const TrialCut not_made;
  TrialSummary summary;
  double uncorrected_mm = 0.0;
  for (const Trial& trial : trials) {
    if (trial.role != role) continue;
    ++summary.specimens;
    const TrialCut* found = path ? find_rival(trial, *path) : &trial.corrected;
    const TrialCut& second = found != nullptr ? *found : not_made;
    if (!trial.planned.measured) continue;
    const double before_mm = *mean_error_mm(trial.planned);
    if (!second.is_made) {
      ++summary.uncorrected;
      uncorrected_mm += before_mm;
      continue;
    }
    if (!second.measured) {
      ++summary.opened;
      ++summary.worse;
      continue;
    }
    const double after_mm = *mean_error_mm(second);
    ++summary.pairs;
    summary.mean_before_mm += before_mm;
    summary.mean_after_mm += after_mm;
    if (after_mm > before_mm) ++summary.worse;
    summary.most_worse_mm = std::max(summary.most_worse_mm, after_mm - before_mm);
  }
  if (summary.pairs == 0) return summary;
  summary.gain_percent_of_all =
      100.0 * (1.0 - (summary.mean_after_mm + uncorrected_mm) / (summary.mean_before_mm + uncorrected_mm));
  summary.mean_before_mm /= static_cast<double>(summary.pairs);
  summary.mean_after_mm /= static_cast<double>(summary.pairs);
  summary.gain_percent = 100.0 * (1.0 - summary.mean_after_mm / summary.mean_before_mm);
  return summary;
}

TableJson known_physics_json(const std::vector<Trial>& trials) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const Trial& trial : trials) {
    const TableJson mean = json_part(trial.known_physics, "/mean_abs_error_mm");
    if (!mean.is_number() || !trial.planned.measured || !trial.corrected.measured) continue;
    sum += mean.get<double>();
    ++count;
  }
  return {{"specimens", count},
          {"mean_after_mm", count > 0 ? TableJson(sum / static_cast<double>(count)) : TableJson(nullptr)}};
}

TableJson table_2_json(const std::vector<Trial>& trials) {
  TableJson rows = TableJson::array();
  for (const Trial& trial : trials) {
    rows.push_back(row_of(trial, "planned", trial.planned));
    if (trial.role != TrialRole::Calibrate) rows.push_back(row_of(trial, "corrected", trial.corrected));
    for (const RivalCut& rival : trial.rivals) rows.push_back(row_of(trial, to_string(rival.path), rival.cut));
    for (const LearningCut& learning : trial.learning)
      rows.push_back(row_of(trial, learning_name(learning.path, learning.photographs), learning.cut));
  }
  return rows;
}

TableJson assessments_json(const std::vector<Trial>& trials) {
  TableJson list = TableJson::array();
  for (const Trial& trial : trials) {
    if (!trial.assessment.is_object()) continue;
    TableJson entry{{"specimen", trial.name},
                    {"role", to_string(trial.role)},
                    {"kind", trial.kind.empty() ? TableJson(nullptr) : TableJson(trial.kind)}};
    for (const char* key : {"advice", "reasons", "expected_gain_mm", "p_worse", "p_worse_if_alike", "p_worse_if_unlike",
                            "p_unlike", "p_close_margin", "distances"})
      entry[key] = trial.assessment.value(key, TableJson());
    const bool is_pair = trial.planned.measured && trial.corrected.measured;
    entry["accepted"] = json_part(trial.compensation, "/accepted");
    entry["gain_mm"] =
        is_pair ? TableJson(*mean_error_mm(trial.planned) - *mean_error_mm(trial.corrected)) : TableJson(nullptr);
    list.push_back(std::move(entry));
  }
  return list;
}

void write_table_2(const std::filesystem::path& file, const std::vector<Trial>& trials) {
  const TableJson rows = table_2_json(trials);
  write_atomically(file, [&rows](std::ostream& out) {
    out << "specimen_is";
    for (const auto& [column, value] : rows.front().items()) out << ',' << column;
    out << '\n';
    for (const TableJson& row : rows) {
      out << "virtual";
      for (const TableJson& value : row) out << ',' << csv_cell(value);
      out << '\n';
    }
  });
}

}  // namespace incise::laboratory
