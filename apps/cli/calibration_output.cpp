#include "calibration_output.hpp"

#include <incise/io/atomic_file.hpp>
#include <incise/io/json_text.hpp>
#include <incise/report/calibration_figures.hpp>
#include <incise/storage/calibration_file.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise::cli {
namespace {

using Json = nlohmann::ordered_json;

/// The settings of every case in full.
std::string settings_of_all(const std::vector<CaseFile>& cases) {
  Json json = Json::array();
  for (const CaseFile& file : cases) json.push_back(Json::parse(settings_json(file)));
  return Json{{"cases", json}}.dump();
}

/// Long lists stay in the file.
Json summary_of_calibration(const Calibration& calibration) {
  Json json = to_json(calibration);
  json.erase("fitted");
  if (json["posterior"].is_object()) {
    json["posterior"].erase("samples");
    for (Json& estimate : json["posterior"]) {
      if (!estimate.is_object()) continue;
      estimate.erase("grid");
      estimate.erase("density");
    }
  }
  return json;
}

/// The table's rows lie speed by speed, as they were asked for; the map is in ascending order.
ScoreGrid grid_of(const Calibration& calibration) {
  ScoreGrid grid;
  grid.is_virtual = calibration.is_virtual;
  const std::vector<ScoreRow>& rows = calibration.table.rows;
  for (const ScoreRow& row : rows) {
    grid.speeds_mm_s.push_back(row.setting.speed_mm_s);
    grid.dullnesses.push_back(row.setting.dullness);
  }
  for (std::vector<double>* values : {&grid.speeds_mm_s, &grid.dullnesses}) {
    std::sort(values->begin(), values->end());
    values->erase(std::unique(values->begin(), values->end()), values->end());
  }
  for (const double speed : grid.speeds_mm_s) {
    for (const double dullness : grid.dullnesses) {
      for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i].setting.speed_mm_s != speed || rows[i].setting.dullness != dullness) continue;
        if (calibration.table.chosen == i) grid.chosen = grid.cells.size();
        grid.cells.push_back({rows[i].is_failure, rows[i].percent, rows[i].mean_signed_mm});
      }
    }
  }
  return grid;
}

std::string fit_figure(const Calibration& calibration) {
  const DragFit& fit = *calibration.fit;
  std::vector<ProfileCurves> curves;
  for (const SpecimenFit& s : fit.specimens) curves.push_back({s.name, s.observed_mm, s.fitted_mm, s.simulated_mm});
  const auto marginal = [](const char* label, const ParameterEstimate& e) {
    return MarginalCurve{label, e.grid, e.density, e.low, e.high};
  };
  std::vector<MarginalCurve> marginals{marginal("drag length, mm", fit.drag_length_mm),
                                       marginal("bias, mm", fit.bias_mm)};
  if (fit.knows_stiffness) marginals.push_back(marginal("ln(stiffness factor)", fit.ln_stiffness));
  return drag_fit_svg(curves, marginals, calibration.is_virtual);
}

std::string score_in_words(const Calibration& calibration) {
  if (!calibration.score_percent) return "no inner edge there to score";
  const std::string score = fmt::format("{:.1f} % of the baseline", *calibration.score_percent);
  if (!calibration.fit) return score;
  return fmt::format("{} (inner edges of {} of {} specimens)", score,
                     calibration.table.rows[*calibration.table.chosen].inner_specimens, calibration.specimens.size());
}

void print_estimate(const char* name, const ParameterEstimate& estimate) {
  fmt::print("{:<24} {:>8.3f} ± {:.3f}   {:.3f} to {:.3f}\n", name, estimate.mean, estimate.sd, estimate.low,
             estimate.high);
}

}  // namespace

void write_calibration(const std::filesystem::path& folder, const Calibration& calibration,
                       const std::vector<CaseFile>& cases, const std::vector<std::string>& specimen_ids,
                       const std::vector<std::filesystem::path>& inputs, const CommonOptions& options, double wall_s) {
  const char* table = calibration.method == CalibrationMethod::Paper ? "table_1" : "simulations";
  write_atomically(folder / fmt::format("{}.csv", table), csv_text(calibration_table(calibration)));
  write_atomically(folder / fmt::format("{}.tex", table), latex_text(calibration_table_rounded(calibration)));
  if (calibration.method == CalibrationMethod::Paper) {
    write_atomically(folder / "table_1.svg", score_heat_map_svg(grid_of(calibration)));
  }
  if (calibration.fit) write_atomically(folder / "fit.svg", fit_figure(calibration));
  write_manifest(folder, manifest_of(options, settings_of_all(cases), inputs, wall_s));
  Json json = to_json(calibration);
  json["specimen_ids"] = specimen_ids;
  write_json(folder / "calibration.json", json);
}

void print_calibration(const CommonOptions& options, const Calibration& calibration,
                       const std::filesystem::path& folder, double wall_s) {
  if (options.json) {
    Json json = summary_of_calibration(calibration);
    json["folder"] = folder.string();
    json["wall_s"] = wall_s;
    print_result(options, json);
    return;
  }
  const TextTable table = calibration_table_rounded(calibration);
  const auto print_row = [](const std::vector<std::string>& cells) {
    for (const std::string& cell : cells) fmt::print("{:>16}", cell);
    fmt::print("\n");
  };
  print_row(table.header);
  for (const auto& row : table.rows) print_row(row);
  fmt::print("\nbaseline {:.3f} mm\n", calibration.table.baseline_mm);
  for (const LeftOutSpecimen& one : calibration.left_out) fmt::print("left out: {}: {}\n", one.name, one.reason);
  if (calibration.fit) {
    fmt::print("\n{:<24} {:>8} ± sd      {:.0f} % interval\n", "", "mean", 100.0 * DragFitSettings{}.credible);
    print_estimate("drag length mm", calibration.fit->drag_length_mm);
    print_estimate("ln stiffness factor", calibration.fit->ln_stiffness);
    print_estimate("bias mm", calibration.fit->bias_mm);
    fmt::print("\n");
    for (const std::string& sentence : calibration.identifiability->sentences) fmt::print("{}\n", sentence);
  }
  if (calibration.chosen) {
    fmt::print("\nchosen: {:.3g} mm/s x {:.3g}, {}\n", calibration.chosen->speed_mm_s, calibration.chosen->dullness,
               score_in_words(calibration));
  }
  fmt::print("everything: {}\n", (folder / "calibration.json").string());
}

}  // namespace incise::cli
