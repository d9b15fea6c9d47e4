#pragma once

#include <incise/robot/player.hpp>
#include <incise/storage/run_folder.hpp>
#include <incise/workflow/run.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <functional>

namespace incise {

/// Adds files to the folder of a program, such as pictures of its replay.
using ProgramExtras = std::function<void(const std::filesystem::path& folder, const CheckedProgram& program)>;

/// Writes the files of a finished run beside its products: `study.json`, `manifest.json` and, if the gate is open,
/// `program/`. An earlier program is removed first if the run has a plan.
///
///   program/  path.json (robot's frame), program.script, program.json, true_path.csv, manifest.json
///
/// @returns the content of study.json without `case_file`: stages, verdict, outcome, both cuts, correction, program.
/// @throws DataError if a file or folder cannot be written or replaced.
nlohmann::ordered_json write_run(RunFolder& folder, const Run& run, double wall_s, const ProgramExtras& extras = {});

/// Writes the program of a run as URScript, all or nothing; its header holds the verdict and every accepted caution.
/// @pre run.program exists and run.gate.is_open (InvalidArgument).  @throws DataError if the file cannot be written.
void write_urscript(const std::filesystem::path& file, const Run& run);

/// Writes `folder/true_path.csv`, one row per sample of the replay: time (s), tip (mm, robot's frame), its speed (mm/s)
/// and deviation (mm), joint positions (rad).
void write_true_path(const std::filesystem::path& folder, const Replay& replay);

}  // namespace incise
