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

/// Writes what people read of a finished run beside its products, `program/`, `study.json` and `manifest.json`; an
/// earlier program is removed first, and a new one written only if the gate is open:
///
///   program/  path.json (robot's frame), program.script, program.json, true_path.csv, manifest.json
///
/// @returns what study.json holds: stages, verdict, outcome, both cuts, correction, program.  @throws DataError
nlohmann::ordered_json write_run(RunFolder& folder, const Run& run, double wall_s, const ProgramExtras& extras = {});

/// Writes the program of a run as URScript, all or nothing; its header holds the verdict and every accepted caution.
/// @pre run.gate.is_open (InvalidArgument).  @throws DataError where the file cannot be written.
void write_urscript(const std::filesystem::path& file, const Run& run);

/// Writes `true_path.csv`, cycle by cycle: time, tip, its speed and deviation, joints.
void write_true_path(const std::filesystem::path& folder, const Replay& replay);

}  // namespace incise
