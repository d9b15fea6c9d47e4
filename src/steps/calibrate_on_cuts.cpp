#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/entry_folder.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/report/calibration_figures.hpp>
#include <incise/steps/case_steps.hpp>
#include <incise/steps/registration_trust.hpp>
#include <incise/storage/evaluation_file.hpp>
#include <incise/storage/registration_json.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

namespace incise::steps {
namespace {

using Json = nlohmann::ordered_json;

/// @throws DataError for a registration that found no transform or does not say how well it fits.
RegistrationQuality registration_of(const std::filesystem::path& file, Monitor& monitor) {
  const RegistrationRecord record = read_registration(file);
  if (!record.T_target_source)
    throw DataError(file, "T_target_source", "null", "the transform of a successful registration");
  if (!record.rmse_mm || !(*record.rmse_mm > 0.0)) {
    throw DataError(file, "rmse_mm", record.rmse_mm ? fmt::format("{}", *record.rmse_mm) : "no number",
                    "the distance between the surfaces, above 0, as `incise register` writes it");
  }
  report_reasons(verdict_of(record, file), monitor);
  return {*record.rmse_mm, record.scale};
}

/// Makes the names of specimens differ: a name that is taken gets the specimen's number.
void make_names_differ(std::vector<CalibrationSubject>& subjects) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    std::string& name = subjects[i].photographed.name;
    if (!seen.insert(name).second) name = fmt::format("{} ({})", name, i + 1);
  }
}

/// Reads and checks everything that can be checked before anything is written or computed.
std::vector<CaseFile> read_inputs(const CalibrateRequest& request, std::vector<CalibrationSubject>& subjects,
                                  Monitor& monitor) {
  std::vector<CaseFile> files;
  for (std::size_t i = 0; i < request.cases.size(); ++i) {
    files.push_back(read_case_with_inputs(request.cases[i]));
    require_plan_inputs(files.back());
    CalibrationSubject subject;
    subject.photographed = read_photographed_cut(request.observed[i]);
    if (!request.forces_n.empty()) subject.photographed.stretch_force_n = request.forces_n[i];
    if (!request.registrations.empty()) subject.registration = registration_of(request.registrations[i], monitor);
    subject.photograph_file = request.observed[i].string();
    subject.case_file = files.back().file.string();
    subject.settings = files.back().settings;
    subjects.push_back(std::move(subject));
  }
  make_names_differ(subjects);
  return files;
}

/// The settings of every case in full.
std::string settings_of_all(const std::vector<CaseFile>& cases) {
  Json json = Json::array();
  for (const CaseFile& file : cases) json.push_back(Json::parse(settings_json(file)));
  return Json{{"cases", json}}.dump();
}

/// Returns the calibration without its long lists, which only the file has.
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

/// The rows of the table are in the order of the request; those of the map ascend.
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

void write_calibration(const std::filesystem::path& folder, const Calibration& calibration,
                       const std::vector<CaseFile>& cases, const std::vector<std::string>& specimen_ids,
                       const std::vector<std::filesystem::path>& inputs, const StepContext& context) {
  const char* table = calibration.method == CalibrationMethod::Paper ? "table_1" : "simulations";
  write_atomically(folder / fmt::format("{}.csv", table), csv_text(calibration_table(calibration)));
  write_atomically(folder / fmt::format("{}.tex", table), latex_text(calibration_table_rounded(calibration)));
  if (calibration.method == CalibrationMethod::Paper) {
    write_atomically(folder / "table_1.svg", score_heat_map_svg(grid_of(calibration)));
  }
  if (calibration.fit) write_atomically(folder / "fit.svg", fit_figure(calibration));
  write_manifest(folder, manifest_of(context.run, settings_of_all(cases), inputs, context.wall_s()));
  Json json = to_json(calibration);
  json["specimen_ids"] = specimen_ids;
  write_json(folder / "calibration.json", json);
}

}  // namespace

CalibrateResult calibrate_on_cuts(const CalibrateRequest& request, const StepContext& context) {
  std::vector<CalibrationSubject> subjects;
  const std::vector<CaseFile> files = read_inputs(request, subjects, context.monitor);
  const std::filesystem::path& output = request.output;
  CalibrateResult result;
  std::vector<std::unique_ptr<RunFolder>> folders;
  std::vector<std::string> specimen_ids;
  with_parts_kept(output, [&] {
    for (std::size_t i = 0; i < files.size(); ++i) {
      const std::filesystem::path folder = output / "specimens" / std::to_string(i + 1);
      folders.push_back(std::make_unique<RunFolder>(files[i], folder, context.run));
      subjects[i].inputs = folders.back().get();
      subjects[i].cache = &folders.back()->cache();
      subjects[i].sink = folders.back().get();
      specimen_ids.push_back(folders.back()->specimen_id());
      require_same_specimen(request.observed[i], specimen_ids.back(), "its case's");
      if (!request.registrations.empty())
        require_same_specimen(request.registrations[i], specimen_ids.back(), "its case's");
    }
    Cache runs(std::make_unique<EntryFolder>(output / "cache"));
    Calibration calibration = calibrate(subjects, request.request, runs, context.workers, context.monitor);
    std::vector<std::filesystem::path> inputs = request.observed;
    inputs.insert(inputs.end(), request.registrations.begin(), request.registrations.end());
    for (const CaseFile& file : files) inputs.push_back(file.file);
    write_calibration(output, calibration, files, specimen_ids, inputs, context);
    result.step.json = summary_of_calibration(calibration);
    result.step.json["folder"] = output.string();
    result.step.json["wall_s"] = context.wall_s();
    result.step.is_acceptable = is_usable(calibration);
    result.calibration = std::move(calibration);
  });
  return result;
}

}  // namespace incise::steps
