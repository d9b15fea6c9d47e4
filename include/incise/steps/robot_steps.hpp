#pragma once

#include <incise/cutting/thermal.hpp>
#include <incise/cutting/tool.hpp>
#include <incise/robot/checks.hpp>
#include <incise/robot/player.hpp>
#include <incise/robot/program.hpp>
#include <incise/robot/program_text.hpp>
#include <incise/steps/step.hpp>
#include <incise/storage/case_file.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise::steps {

/// What a program is written as.
enum class ProgramForm { UrScript, JointCsv, RosTrajectory, Json };
inline constexpr std::array<std::string_view, 4> kProgramFormNames{"urscript", "joint-csv", "ros-trajectory", "json"};
[[nodiscard]] constexpr Names names_of(ProgramForm) {
  return kProgramFormNames;
}

/// From a path in the robot's frame to a checked program.
struct ExportRequest {
  std::filesystem::path path;
  std::filesystem::path intended;      ///< the path before correction; empty: not known
  std::filesystem::path surface;       ///< the tissue in the robot's frame; empty: not known
  std::filesystem::path registration;  ///< that laid the path down; empty: not known
  std::optional<PathKind> kind;        ///< in place of the one in the path's file
  bool is_open = false;                ///< the path is an open cut
  ProgramForm form = ProgramForm::UrScript;
  std::optional<ScriptMotion> motion;  ///< of URScript alone; absent: MoveP
  CheckSettings checks;
  ProgramSettings settings;
  std::optional<double> overlap_mm;  ///< of a closed path; absent: usual_overlap_mm for an incision, none for a mark
  double usual_overlap_mm = kRingOverlapMm;  ///< of an incision, >= 0
  ArmSetup setup;
  std::optional<double> power_w;       ///< of the generator; absent: not known
  ThermalSettings thermal;             ///< of the tissue: a path does not say what it is cut into
  std::optional<Tool> tool;            ///< absent: a needle as long as `checks` has it
  std::filesystem::path case_file;     ///< whose settings these are; empty: no case's
  std::string case_sha256;             ///< of that file
  std::string case_specimen_id;        ///< of that case; empty: not known
  std::vector<std::string> overrides;  ///< checks that a person takes on them
  std::vector<std::string> accepted;   ///< cautions of the verdict, likewise
  std::filesystem::path output;
};
/// Copies from a case what its own run takes for its program: arm, limits, power, heat, tool and overlap. The path has
/// to be of the case's specimen. Reads the scan or mesh of a case that names no specimen.
/// @throws CaseError as require_round_tool; DataError where the scan or mesh cannot be read.
void take_case(const CaseFile& file, ExportRequest& request);
/// Writes the program if the verdict allows it; else the result is not acceptable, and nothing is written.
/// @throws DataError for a file that cannot be used; CaseError for overrides, a tool or an output that do not go with
/// the path or the form.
[[nodiscard]] StepResult export_program(const ExportRequest& request, const StepContext& context);

/// A written program as the arm would run it.
struct ReplayRequest {
  std::filesystem::path program;
  std::filesystem::path path;     ///< frame robot; empty: the one that the program was made for, if it says so
  double slider_percent = 100.0;  ///< of the controller's speed slider, [1, 100]
  double max_deviation_mm = PlayerSettings{}.max_deviation_mm;  ///< of the tip from the path in the cut, > 0
  std::filesystem::path output;                                 ///< folder; empty: no files
};
/// Not acceptable: a program that does not run to its end, leaves its path, or is not the one that was checked.
/// @throws DataError for a file that cannot be used.
[[nodiscard]] StepResult replay_program(const ReplayRequest& request, const StepContext& context);

/// Writes `replay.svg`, where the program cuts, into a folder. @throws DataError
void write_replay_figure(const std::filesystem::path& folder, const Replay& replay);

/// Warns of each reason that blocks the program, and of each caution that was accepted.
void report_gate(const Verdict& verdict, const VerdictGate& gate, Monitor& monitor);

}  // namespace incise::steps
