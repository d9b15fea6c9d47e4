#include "option_checks.hpp"
#include "options.hpp"
#include "registration_trust.hpp"
#include "verdict_gate.hpp"

#include <incise/core/problem_text.hpp>
#include <incise/core/units.hpp>
#include <incise/core/version.hpp>
#include <incise/cutting/cut_settings.hpp>
#include <incise/cutting/path_heat.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/described_json.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/nearest_name.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/robot/program_text.hpp>
#include <incise/robot/program_verdict.hpp>
#include <incise/storage/own_files.hpp>
#include <incise/storage/registration_json.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <ostream>

namespace incise::cli {
namespace {

struct ExportArguments {
  std::filesystem::path path, intended, surface, registration;
  std::string robot = "ur10e", format = "urscript", motion = "movep", kind;
  CheckSettings checks;
  ProgramSettings settings;
  ArmSetup setup;
  double overlap_mm = -1.0;  // not given
  double shaft_diameter_mm = 2.0 * CheckSettings{}.shaft_radius_mm;
  double power_w = 0.0;  // not given
  std::vector<double> tcp, near_deg;
  std::vector<std::string> overrides, accepted;
  bool is_open = false;
  const CLI::Option* motion_option = nullptr;
};

void require_override_names(const std::vector<std::string>& names) {
  std::vector<std::string> possible;
  std::ranges::copy_if(check_names(), std::back_inserter(possible), can_be_overridden);
  for (const std::string& name : names) {
    if (can_be_overridden(name)) continue;
    const bool is_check = std::ranges::find(check_names(), name) != check_names().end();
    throw CaseError("command line", "--override", fmt::format("'{}'", name),
                    is_check ? std::string("a check that can be overridden; this one cannot")
                             : fmt::format("one of {}", fmt::join(possible, ", ")),
                    is_check ? "" : fmt::format("Did you mean '{}'?", nearest_name(name, possible)));
  }
}

void require_ending(const std::filesystem::path& output, const std::string& format) {
  const std::string ending = output.extension().string();
  const auto refuse = [&](const char* expected) {
    throw CaseError("command line", "-o", output.string(),
                    fmt::format("a name that ends in {} for --format {}", expected, format));
  };
  if (format == "joint-csv" && ending != ".csv") refuse(".csv");
  if (format == "json" && ending != ".json") refuse(".json");
  if (format == "ros-trajectory" && ending != ".yaml" && ending != ".bag") refuse(".yaml (ROS 2) or .bag (ROS 1)");
  if (format == "urscript" &&
      (ending.empty() || ending == ".csv" || ending == ".json" || ending == ".yaml" || ending == ".bag"))
    refuse(".script");
}

/// The checks need more than the transform.
RegistrationSummary registration_summary(const RegistrationRecord& record, const std::filesystem::path& file) {
  const auto require = [&](bool is_there, const char* key) {
    if (!is_there) throw DataError(file, key, "nothing", "what `incise register` writes");
  };
  require(record.rmse_mm.has_value(), "rmse_mm");
  require(record.inlier_fraction.has_value(), "inlier_fraction");
  require(record.is_converged.has_value(), "converged");
  return {record.scale * record.camera_scale, *record.rmse_mm, *record.inlier_fraction, *record.is_converged};
}

ToolPath read_robot_path(const std::filesystem::path& file) {
  ToolPath path = read_tool_path(file);
  require_robot_frame(path, file);
  require_tumor_size(path, file);
  return path;
}

/// Of the simulated cut that verifies the path, and of the registration. @param kind_in_file, kind  of the path as it
/// was read, and as it is exported
Verdict verdict_of(const ExportArguments& arguments, PathKind kind_in_file, PathKind kind,
                   const std::optional<RegistrationRecord>& registration) {
  Verdict verdict = read_path_verdict(arguments.path);
  if (kind == PathKind::Mark) {
    verdict = as_verdict_of_mark(verdict);
  } else if (kind_in_file == PathKind::Mark) {
    verdict.add("not_simulated", {}, "the path's file holds a mark: no simulated cut along it is known");
  }
  if (registration) verdict.add(cli::verdict_of(*registration, arguments.registration));
  return verdict;
}

/// What makes a mark one: it follows the edge, hardly scratches it, and slowly. Without these it is a cut without a
/// verdict.
void require_a_mark(const std::vector<std::string>& overrides) {
  for (const std::string& name : overrides) {
    if (name != "depth" && name != "speed_max" && name != "edge_distance") continue;
    throw CaseError("command line", "--override", fmt::format("'{}' for a mark", name),
                    "another check: without this one it is no mark of the tumour's edge");
  }
}

/// Settings that follow from others.
void complete(ExportArguments& a, const ToolPath& path) {
  const bool is_mark = path.kind == PathKind::Mark;
  a.settings.overlap_mm = a.overlap_mm >= 0.0 ? a.overlap_mm : is_mark ? 0.0 : CutSettings{}.overlap_mm;
  if (is_mark) a.settings.plunge_speed_mm_s = a.checks.mark_speed_mm_s;
  a.checks.must_be_ring = !a.is_open;
  a.checks.shaft_radius_mm = 0.5 * a.shaft_diameter_mm;
  if (!a.tcp.empty()) a.setup.T_flange_tool = tool_pose(Vec3(a.tcp.data()), Vec3(a.tcp.data() + 3));
  const double length_mm = a.setup.T_flange_tool.topRightCorner<3, 1>().norm();
  if (length_mm < a.checks.needle_length_mm) {
    throw CaseError("command line", "--tcp", fmt::format("a tip {:.4g} mm from the flange", length_mm),
                    fmt::format("at least the needle's length, {} mm (--needle-length-mm)", a.checks.needle_length_mm),
                    "Lengths are in mm");
  }
  for (std::size_t i = 0; i < a.near_deg.size(); ++i)
    a.setup.near_rad[static_cast<int>(i)] = units::rad_from_deg(a.near_deg[i]);
}

RobotProgram program_of(const ToolPath& path, const ExportArguments& arguments) {
  try {
    return make_program(path, arguments.settings, arguments.setup);
  } catch (const InvalidArgument& error) {
    throw fault_of_file(arguments.path, "waypoints", error, "a path that a tool can follow");
  }
}

/// What nobody will look at, and what will be looked at less strictly than by default: nothing of it is silent.
void warn_of_less(const ExportArguments& a, const CheckInputs& inputs, const ToolPath& path, Console& console) {
  const auto missing = [&](bool is_given, const char* option, const char* checks) {
    if (is_given) return;
    console.message(Severity::Warning, fmt::format("not checked without {}: {}", option, checks));
  };
  missing(inputs.surface != nullptr, "--surface", "arm, shaft and needle against the tissue, and the depth below it");
  missing(inputs.registration.has_value(), "--registration", "how well the tissue was found");
  missing(inputs.power_w.has_value(), "--power-w", "the electrode's power");
  if (a.is_open) console.message(Severity::Warning, "not checked with --open: closed, gap, encloses");
  const CheckSettings usual;
  const auto looser = [&](bool is_looser, const char* option, double value, double by_default) {
    if (!is_looser) return;
    console.message(Severity::Warning,
                    fmt::format("a looser check: {} is {} mm, by default {} mm", option, value, by_default));
  };
  const bool is_mark = path.kind == PathKind::Mark;
  looser(!is_mark && a.checks.close_margin_mm < usual.close_margin_mm, "--close-margin-mm", a.checks.close_margin_mm,
         usual.close_margin_mm);
  looser(!is_mark && a.checks.planned_depth_mm > usual.planned_depth_mm, "--depth-mm", a.checks.planned_depth_mm,
         usual.planned_depth_mm);
  looser(a.checks.needle_length_mm > usual.needle_length_mm, "--needle-length-mm", a.checks.needle_length_mm,
         usual.needle_length_mm);
  looser(a.shaft_diameter_mm < 2.0 * usual.shaft_radius_mm, "--shaft-diameter-mm", a.shaft_diameter_mm,
         2.0 * usual.shaft_radius_mm);
  looser(a.setup.table_z_mm < ArmSetup{}.table_z_mm, "--table-z-mm", a.setup.table_z_mm, ArmSetup{}.table_z_mm);
}

constexpr double kFarthestTableMm = 5000.0;  // beyond any arm's reach
constexpr double kLeastToolMm = 0.1;         // thinner or shorter is no instrument
constexpr double kMostPowerW = 400.0;        // no electrosurgical generator gives more (IEC 60601-2-2)

/// With the constants of muscle that a case has by default: a path does not say what it is cut into.
double half_width_of_heat_mm(const ToolPath& path, const ExportArguments& arguments) {
  const Needle needle{.length_mm = arguments.checks.needle_length_mm};
  return widest_heat(ThermalSettings{}, arguments.power_w, path, needle).half_width_mm;
}

std::string text_of(const RobotProgram& program, const ProgramChecks& checks, const ProgramHeader& header,
                    const ExportArguments& arguments, const std::filesystem::path& output) {
  if (arguments.format == "joint-csv") return to_joint_csv(program, header);
  if (arguments.format == "json") return to_json(program, &checks, header);
  if (arguments.format == "ros-trajectory")
    return output.extension() == ".bag" ? to_rosbag(program, header) : to_ros_yaml(program, header);
  return to_urscript(program, header, {.motion = value_named<ScriptMotion>(arguments.motion)});
}

nlohmann::ordered_json summary_of(const RobotProgram& program, const ProgramChecks& checks) {
  nlohmann::ordered_json result = nlohmann::ordered_json::parse(to_json(program, &checks));
  result.erase("poses");
  if (result["motion"].contains("samples")) result["motion"].erase("samples");
  double fastest = 0.0;
  for (const ProgramPose& pose : program.poses) fastest = std::max(fastest, pose.tip_speed_mm_s);
  result["max_tip_speed_mm_s"] = fastest;
  result["min_singular_value"] = nullptr;
  result["joint_travel_deg"] = nullptr;
  if (program.motion.outcome != MotionOutcome::Found) return result;
  result["min_singular_value"] = program.motion.min_singular_value;
  result["joint_travel_deg"] = program.motion.travel_deg;
  return result;
}

int run_export(const ExportArguments& given, const CommonOptions& options) {
  ExportArguments arguments = given;
  Console console(options.level());
  const std::filesystem::path output = options.required_output("cut.script");
  refuse_input_as_output("-o", output, {arguments.path, arguments.intended, arguments.surface, arguments.registration});
  OlderOutput older(output, console);
  require_override_names(arguments.overrides);
  require_accepted_ids(arguments.accepted);
  require_ending(output, arguments.format);
  require_own_program(output);
  if (arguments.format != "urscript" && arguments.motion_option->count() > 0) {
    throw CaseError("command line", "--motion", fmt::format("{} for --format {}", arguments.motion, arguments.format),
                    "no --motion: only URScript has two kinds");
  }
  ToolPath path = read_robot_path(arguments.path);
  const PathKind kind_in_file = path.kind;
  if (!arguments.kind.empty()) path.kind = value_named<PathKind>(arguments.kind);
  if (path.kind == PathKind::Mark) require_a_mark(arguments.overrides);
  if (arguments.is_open && path.is_closed) {
    throw CaseError("command line", "--open", fmt::format("{}, a closed path", arguments.path.string()), "an open path",
                    "Leave --open out: a ring is held to closed, gap and encloses.");
  }
  complete(arguments, path);
  CheckInputs inputs;
  std::optional<ToolPath> intended;
  std::optional<TriMesh> surface;
  if (!arguments.intended.empty()) inputs.intended = &intended.emplace(read_robot_path(arguments.intended));
  if (!arguments.surface.empty()) inputs.surface = &surface.emplace(read_cloud(arguments.surface));
  std::optional<RegistrationRecord> registration;
  if (!arguments.registration.empty()) {
    registration = read_registration(arguments.registration);
    require_same_specimen(arguments.registration, path.specimen_id, "the path's");
    require_clouds_unchanged(*registration, arguments.registration, console);
    inputs.registration = registration_summary(*registration, arguments.registration);
  }
  Verdict verdict = verdict_of(arguments, kind_in_file, path.kind, registration);
  if (!arguments.surface.empty()) require_same_specimen(arguments.surface, path.specimen_id, "the path's");
  if (intended) require_same_specimen(arguments.intended, path.specimen_id, "the path's");
  if (arguments.power_w > 0.0) {
    inputs.power_w = arguments.power_w;
    inputs.heat_half_width_mm = half_width_of_heat_mm(path, arguments);
  }
  require_writable(output);
  warn_of_less(arguments, inputs, path, console);

  const RobotProgram program = program_of(path, arguments);
  ProgramChecks checks = check_program(program, path, arguments.checks, inputs);
  override_checks(checks, arguments.overrides);
  nlohmann::ordered_json result = summary_of(program, checks);
  for (const ProgramCheck& check : checks.checks) {
    if (check.is_overridden) console.message(Severity::Warning, "overridden: " + check.message());
  }
  add_failed_checks(checks, verdict);
  const VerdictGate gate = gate_of(verdict, arguments.accepted);
  report_gate(verdict, gate, console);
  result["verdict"] = to_json(verdict);
  result["gate"] = to_json(gate);
  if (!gate.is_open) {
    result["stale_output"] = older.json();
    result["wall_s"] = options.wall_s();
    print_result(options, result);
    return kNotAcceptable;
  }
  ProgramHeader provenance{{"made_by", fmt::format("incise {} ({})", version(), source_commit())},
                           {"made_from", arguments.path.filename().string()},
                           {"made_from_sha256", sha256_of_file(arguments.path)}};
  if (!path.specimen_id.empty()) provenance.emplace_back("specimen_id", path.specimen_id);
  if (path.is_virtual) provenance.emplace_back("specimen", kVirtualSpecimen);
  for (const auto& line : verdict_header(verdict, gate)) provenance.push_back(line);
  const ProgramHeader header = program_header(program, path, checks, provenance);
  const std::string text = text_of(program, checks, header, arguments, output);
  write_atomically(output, text);
  older.replaced();
  result["program"] = output.string();
  result["wall_s"] = options.wall_s();
  print_result(options, result);
  return kDone;
}

}  // namespace

void add_export(Application& application) {
  auto [verb, a] = application.add_verb<ExportArguments>(
      "export",
      "Turn a path in the robot's frame into a program, after the safety checks. A path whose cut was never simulated "
      "needs --accept not_simulated",
      "incise export projected/path.json --surface projected/surface.ply --registration "
      "registration/registration.json -o cut.script",
      run_export);
  verb->add_option("path", a.path, "path.json, frame robot")->required();
  verb->add_option("--robot", a.robot, "The arm")->check(CLI::IsMember({"ur10e"}));
  verb->add_option("--format", a.format, "Of the program; ros-trajectory: .yaml for ROS 2, .bag for ROS 1")
      ->check(CLI::IsMember({"urscript", "joint-csv", "ros-trajectory", "json"}));
  a.motion_option =
      verb->add_option("--motion", a.motion, "Of URScript: movep (blends, constant speed) or servoj (timed joints)")
          ->check(name_of_any<ScriptMotion>());
  verb->add_option("--kind", a.kind, "Which checks hold, in place of the path's own kind")
      ->check(CLI::IsMember({"mark", "incise"}));
  verb->add_option("--override", a.overrides,
                   "Write the program although this check fails; once for each, noted in the program")
      ->expected(1)
      ->take_all();
  add_accept(*verb, a.accepted);
  verb->add_option("--intended", a.intended, "The path before correction, to check the deviation");
  verb->add_option("--surface", a.surface,
                   "The tissue in the robot's frame (.ply, .stl, .obj, .vtp; triangles or points): depth, arm, "
                   "shaft and needle are checked against it");
  verb->add_option("--registration", a.registration, "Result of `incise register` (.json): its quality is checked");
  verb->add_option("--power-w", a.power_w,
                   "Power of the electrode, to check it and how far beside the needle its heat reaches")
      ->check(above_zero("--power-w"))
      ->check(CLI::Range(0.0, kMostPowerW));
  verb->add_option("--tcp", a.tcp,
                   "Tool centre point in the flange as on the pendant: x y z (mm) rx ry rz (rad); z along the needle. "
                   "By default 0 0 150 0 0 0")
      ->expected(6);
  verb->add_option("--near-joints-deg", a.near_deg, "Joints that the arm stands near")
      ->expected(6)
      ->check(between("--near-joints-deg", -360.0, 360.0));
  verb->add_option("--table-z-mm", a.setup.table_z_mm, "Height of the table's plane in the base frame")
      ->check(between("--table-z-mm", -kFarthestTableMm, kFarthestTableMm));
  verb->add_option("--needle-length-mm", a.checks.needle_length_mm, "Of the needle; behind it comes the shaft")
      ->check(between("--needle-length-mm", kLeastToolMm, kLargestLengthMm));
  verb->add_option("--shaft-diameter-mm", a.shaft_diameter_mm, "Of the instrument's shaft")
      ->check(between("--shaft-diameter-mm", kLeastToolMm, kLargestLengthMm));
  verb->add_option("--depth-mm", a.checks.planned_depth_mm, "Planned depth")->check(above_zero("--depth-mm"));
  verb->add_option("--close-margin-mm", a.checks.close_margin_mm, "Least distance from the tumour edge")
      ->check(above_zero("--close-margin-mm"));
  verb->add_option("--overlap-mm", a.overlap_mm, "How far a ring runs on beyond its start; by default 8, a mark 0")
      ->check(CLI::Range(0.0, kLargestLengthMm))
      ->default_str("");
  verb->add_flag("--open", a.is_open, "The path is an open cut: closed, gap and encloses are not checked");
}

}  // namespace incise::cli
