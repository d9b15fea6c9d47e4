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

/// File formats of a program.
enum class ProgramForm { UrScript, JointCsv, RosTrajectory, Json };
inline constexpr std::array<std::string_view, 4> kProgramFormNames{"urscript", "joint-csv", "ros-trajectory", "json"};
[[nodiscard]] constexpr Names names_of(ProgramForm) {
  return kProgramFormNames;
}

/// Input of export_program: a path in the robot's frame, and what is known of the cut.
struct ExportRequest {
  std::filesystem::path path;
  std::filesystem::path intended;      ///< the path before correction; empty: not known
  std::filesystem::path surface;       ///< the tissue in the robot's frame; empty: not known
  std::filesystem::path registration;  ///< registration that laid the path down; empty: not known
  std::optional<PathKind> kind;        ///< replaces the kind in the path's file; absent: as in the file
  bool is_open = false;                ///< the path is an open cut
  ProgramForm form = ProgramForm::UrScript;
  std::optional<ScriptMotion> motion;  ///< only with URScript; absent: MoveP
  CheckSettings checks;
  ProgramSettings settings;
  std::optional<double> overlap_mm;  ///< of a closed path; absent: usual_overlap_mm for an incision, 0 for a mark
  double usual_overlap_mm = kRingOverlapMm;  ///< of an incision, >= 0
  ArmSetup setup;
  std::optional<double> power_w;       ///< power of the generator; absent: not known
  ThermalSettings thermal;             ///< of the tissue that is cut, which a path does not state
  std::optional<Tool> tool;            ///< absent: a needle of the length in `checks`
  std::filesystem::path case_file;     ///< case that these settings are from; empty: none
  std::string case_sha256;             ///< of case_file
  std::string case_specimen_id;        ///< specimen of that case; empty: not known
  std::vector<std::string> overrides;  ///< failed checks for which a person takes responsibility
  std::vector<std::string> accepted;   ///< cautions of the verdict that a person accepts
  std::filesystem::path output;
};
/// Describes the fields that are options of `incise export`.
void describe(Visitor& v, ExportRequest& r);
/// Copies from a case what its own run uses for its program: arm, limits, power, heat, tool and overlap. The exported
/// path must be of the case's specimen. Reads the scan or mesh of a case that names no specimen.
/// @throws CaseError as require_round_tool; DataError if the scan or mesh cannot be read.
void take_case(const CaseFile& file, ExportRequest& request);
/// Checks a path and writes its program if the verdict allows it. Otherwise nothing is written and the result is not
/// acceptable. @throws DataError for a file that cannot be used; CaseError for overrides, a tool or an output that do
/// not suit the path or the format.
[[nodiscard]] StepResult export_program(const ExportRequest& request, const StepContext& context);

/// Input of replay_program: a written program, and the path that it should follow.
struct ReplayRequest {
  std::filesystem::path program;
  std::filesystem::path path;     ///< in the frame `robot`; empty: the path in the program, if it has one
  double slider_percent = 100.0;  ///< position of the controller's speed slider, [1, 100]
  double max_deviation_mm = PlayerSettings{}.max_deviation_mm;  ///< of the tip from the path in the cut, > 0
  std::filesystem::path output;                                 ///< folder; empty: no files
};
/// Runs a written program as the arm would. Not acceptable: a program that does not run to its end, leaves its path, or
/// is not the one that was checked. @throws DataError for a file that cannot be used.
[[nodiscard]] StepResult replay_program(const ReplayRequest& request, const StepContext& context);

/// Writes replay.svg into a folder; nothing if the program does not cut. @throws DataError
void write_replay_figure(const std::filesystem::path& folder, const Replay& replay);

/// Warns of each reason that blocks the program, and of each accepted caution.
void report_gate(const Verdict& verdict, const VerdictGate& gate, Monitor& monitor);

}  // namespace incise::steps
