#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/table_io.hpp>
#include <incise/robot/program_text.hpp>
#include <incise/storage/result_json.hpp>
#include <incise/storage/run_files.hpp>

namespace incise {
namespace {

using Json = nlohmann::ordered_json;

Json headline(const std::optional<SimulatedCut>& cut) {
  if (!cut) return nullptr;
  Json json = to_json(*cut);
  for (const char* key : {"removals", "removal_columns", "removal_causes"}) json.erase(key);
  return json;
}

Json program_json(const Run& run) {
  Json json;
  if (!run.program) {
    json["written"] = false;
    json["reason"] = run.why_without_program;
    return json;
  }
  json = Json::parse(program_json(run.program->program, &run.program->checks));
  json.erase("poses");
  json["motion"].erase("samples");
  json["follows"] = run.study.is_accepted ? "corrected path" : "uncorrected path";
  json["gate"] = to_json(run.gate);
  json["written"] = run.gate.is_open;
  if (run.program->replay) json["replay"] = to_json(*run.program->replay);
  return json;
}

Json run_json(RunFolder& folder, const Run& run) {
  const Study& study = run.study;
  Json json;
  json["stages"] = to_json(study.stages);
  json["verdict"] = to_json(run.verdict);
  json["outcome"] = to_string(study.outcome);
  json["before"] = headline(study.as_planned);
  json["after"] = headline(study.corrected);
  json["accepted"] = study.is_accepted;
  json["correction_note"] = study.correction_note.empty() ? Json(nullptr) : Json(study.correction_note);
  json["correction"] = study.correction ? correction_summary_json(*study.correction) : Json(nullptr);
  json["specimen_is"] = folder.case_file().settings.is_virtual ? "virtual" : "real";
  json["specimen_id"] = folder.specimen_id();
  if (study.plan) json["program"] = program_json(run);
  return json;
}

void write_program(RunFolder& folder, const Run& run, const ProgramExtras& extras) {
  const CheckedProgram& made = *run.program;
  AtomicFolder target(folder.root() / "program");
  write_tool_path(target.path() / "path.json", made.path, run.verdict);
  write_atomically(target.path() / "program.json", program_json(made.program, &made.checks, made.header));
  write_urscript(target.path() / "program.script", run);
  write_true_path(target.path(), *made.replay);
  if (extras) extras(target.path(), made);
  folder.write_manifest_to(target.path(), 0.0, &run.verdict);
  target.commit();
}

}  // namespace

Json write_run(RunFolder& folder, const Run& run, double wall_s, const ProgramExtras& extras) {
  if (run.study.plan) remove_replaceable(folder.root() / "program");
  if (run.gate.is_open) write_program(folder, run, extras);
  Json json = run_json(folder, run);
  json["wall_s"] = wall_s;
  const std::filesystem::path record = folder.root() / "study.json";
  Json kept = json;
  kept["case_file"] = read_json(record).at("case_file");
  write_json(record, kept);
  folder.write_manifest_to(folder.root(), wall_s, &run.verdict);
  return json;
}

void write_urscript(const std::filesystem::path& file, const Run& run) {
  INCISE_REQUIRE(run.program && run.gate.is_open, "expected a run whose gate is open");
  write_atomically(file, to_urscript(run.program->program, run.program->header));
}

void write_true_path(const std::filesystem::path& folder, const Replay& replay) {
  std::vector<NamedColumn> columns{{"time_s", {}},   {"tip_x_mm", {}},       {"tip_y_mm", {}},
                                   {"tip_z_mm", {}}, {"tip_speed_mm_s", {}}, {"deviation_mm", {}}};
  for (const std::string& name : ur10e().joint_names) columns.push_back({name + "_rad", {}});
  for (const ReplaySample& s : replay.samples) {
    const double row[] = {s.time_s, s.tip_mm.x(), s.tip_mm.y(), s.tip_mm.z(), s.tip_speed_mm_s, s.deviation_mm};
    for (std::size_t i = 0; i < 6; ++i) {
      columns[i].second.push_back(row[i]);
      columns[6 + i].second.push_back(s.q_rad[static_cast<int>(i)]);
    }
  }
  write_csv_columns(folder / "true_path.csv", columns);
}

}  // namespace incise
