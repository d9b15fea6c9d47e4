#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/core/nearest_name.hpp>
#include <incise/core/version.hpp>
#include <incise/cutting/cut_settings.hpp>
#include <incise/cutting/path_heat.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/robot/program_verdict.hpp>
#include <incise/steps/registration_trust.hpp>
#include <incise/steps/robot_steps.hpp>
#include <incise/storage/own_files.hpp>
#include <incise/storage/registration_json.hpp>
#include <incise/workflow/run.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace incise::steps {
namespace {

/// Returns the numbers of a registration that the checks need. @throws DataError if one is missing.
RegistrationSummary registration_summary(const RegistrationRecord& record, const std::filesystem::path& file) {
  const auto require = [&](bool is_there, const char* key) {
    if (!is_there) throw DataError(file, key, "nothing", "a value, as `incise register` writes it");
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

void require_of_case(const ToolPath& path, const ExportRequest& request, Monitor& monitor) {
  if (!request.case_file.empty() && path.specimen_id.empty()) {
    monitor.message(Severity::Warning,
                    fmt::format("{} names no specimen: it may be of a specimen other than that of {}",
                                request.path.string(), request.case_file.string()));
  }
  if (!are_of_different_specimens(path.specimen_id, request.case_specimen_id)) return;
  throw DataError(request.path, "specimen_id", path.specimen_id,
                  fmt::format("{}'s specimen, {}", request.case_file.string(), request.case_specimen_id),
                  "Two scans of one specimen get one specimen_id in their cases");
}

/// Returns the verdict of the simulated cut that verifies the path, and of the registration. @param kind_in_file, kind
/// of the path as read, and as exported
Verdict verdict_along(const ExportRequest& request, PathKind kind_in_file, PathKind kind,
                      const std::optional<RegistrationRecord>& registration) {
  Verdict verdict = read_path_verdict(request.path);
  if (kind == PathKind::Mark) {
    verdict = as_verdict_of_mark(verdict);
  } else if (kind_in_file == PathKind::Mark) {
    verdict.add("not_simulated", {}, "the path's file holds a mark: no simulated cut along it is known");
  }
  if (registration) verdict.add(verdict_of(*registration, request.registration));
  return verdict;
}

void require_override_names(const std::vector<std::string>& names) {
  std::vector<std::string> possible;
  std::ranges::copy_if(check_names(), std::back_inserter(possible), can_be_overridden);
  for (const std::string& name : names) {
    if (can_be_overridden(name)) continue;
    const bool is_check = std::ranges::find(check_names(), name) != check_names().end();
    throw CaseError("command line", "--override", fmt::format("'{}'", name),
                    is_check ? std::string("a check that can be overridden; this one cannot")
                             : fmt::format("one of {}", fmt::join(possible, ", ")),
                    is_check ? "" : did_you_mean(name, possible));
  }
}

void require_ending(const std::filesystem::path& output, ProgramForm form) {
  const std::string ending = output.extension().string();
  const auto refuse = [&](const char* expected) {
    throw CaseError("command line", "-o", output.string(),
                    fmt::format("a name that ends in {} for --format {}", expected, to_string(form)));
  };
  if (form == ProgramForm::JointCsv && ending != ".csv") refuse(".csv");
  if (form == ProgramForm::Json && ending != ".json") refuse(".json");
  if (form == ProgramForm::RosTrajectory && ending != ".yaml" && ending != ".bag")
    refuse(".yaml (ROS 2) or .bag (ROS 1)");
  if (form == ProgramForm::UrScript &&
      (ending.empty() || ending == ".csv" || ending == ".json" || ending == ".yaml" || ending == ".bag"))
    refuse(".script");
}

/// Refuses to override the checks that make a path a mark: it follows the edge, slowly, and hardly scratches it.
/// Without them it is a cut without a verdict.
void require_a_mark(const std::vector<std::string>& overrides) {
  for (const std::string& name : overrides) {
    if (name != "depth" && name != "speed_max" && name != "edge_distance") continue;
    throw CaseError("command line", "--override", fmt::format("'{}' for a mark", name),
                    "another check: without this one, the path is no mark of the tumour's edge");
  }
}

/// Settings that follow from others.
void complete(ExportRequest& a, const ToolPath& path) {
  const bool is_mark = path.kind == PathKind::Mark;
  a.settings.overlap_mm = a.overlap_mm.value_or(is_mark ? 0.0 : a.usual_overlap_mm);
  if (is_mark) a.settings.plunge_speed_mm_s = a.checks.mark_speed_mm_s;
  a.checks.must_be_ring = !a.is_open;
  const double length_mm = a.setup.T_flange_tool.topRightCorner<3, 1>().norm();
  if (length_mm < a.checks.needle_length_mm) {
    throw CaseError("command line", "--tcp", fmt::format("a tip {:.4g} mm from the flange", length_mm),
                    fmt::format("at least the needle's length, {} mm (--needle-length-mm)", a.checks.needle_length_mm),
                    "Lengths are in mm");
  }
}

RobotProgram program_of(const ToolPath& path, const ExportRequest& request) {
  try {
    return make_program(path, request.settings, request.setup);
  } catch (const InvalidArgument& error) {
    throw DataError(request.path, "waypoints", error);
  }
}

/// Warns of every check that is skipped or looser than by default.
void warn_of_less(const ExportRequest& a, const CheckInputs& inputs, const ToolPath& path, Monitor& monitor) {
  const auto missing = [&](bool is_given, const char* option, const char* checks) {
    if (is_given) return;
    monitor.message(Severity::Warning, fmt::format("not checked without {}: {}", option, checks));
  };
  missing(inputs.surface != nullptr, "--surface", "arm, shaft and needle against the tissue, and the depth below it");
  missing(inputs.registration.has_value(), "--registration", "how well the tissue was found");
  missing(inputs.power_w.has_value(), "--power-w", "the electrode's power");
  if (a.is_open) monitor.message(Severity::Warning, "not checked with --open: closed, gap, encloses");
  const CheckSettings usual;
  const auto looser = [&](bool is_looser, const char* option, double value, double by_default) {
    if (!is_looser) return;
    monitor.message(Severity::Warning,
                    fmt::format("a looser check: {} is {} mm, by default {} mm", option, value, by_default));
  };
  const bool is_mark = path.kind == PathKind::Mark;
  looser(!is_mark && a.checks.close_margin_mm < usual.close_margin_mm, "--close-margin-mm", a.checks.close_margin_mm,
         usual.close_margin_mm);
  looser(!is_mark && a.checks.planned_depth_mm > usual.planned_depth_mm, "--depth-mm", a.checks.planned_depth_mm,
         usual.planned_depth_mm);
  looser(a.checks.needle_length_mm > usual.needle_length_mm, "--needle-length-mm", a.checks.needle_length_mm,
         usual.needle_length_mm);
  looser(a.checks.shaft_radius_mm < usual.shaft_radius_mm, "--shaft-diameter-mm", 2.0 * a.checks.shaft_radius_mm,
         2.0 * usual.shaft_radius_mm);
  looser(a.setup.table_z_mm < ArmSetup{}.table_z_mm, "--table-z-mm", a.setup.table_z_mm, ArmSetup{}.table_z_mm);
}

double half_width_of_heat_mm(const ToolPath& path, const ExportRequest& request) {
  const Tool tool = request.tool.value_or(Needle{.length_mm = request.checks.needle_length_mm});
  return widest_heat(request.thermal, *request.power_w, path, tool).half_width_mm;
}

std::string text_of(const RobotProgram& program, const ProgramChecks& checks, const ProgramHeader& header,
                    const ExportRequest& request) {
  switch (request.form) {
    case ProgramForm::JointCsv:
      return to_joint_csv(program, header);
    case ProgramForm::Json:
      return program_json(program, &checks, header);
    case ProgramForm::RosTrajectory:
      return request.output.extension() == ".bag" ? to_rosbag(program, header) : to_ros_yaml(program, header);
    default:
      return to_urscript(program, header, {.motion = request.motion.value_or(ScriptMotion::MoveP)});
  }
}

nlohmann::ordered_json summary_of(const RobotProgram& program, const ProgramChecks& checks) {
  nlohmann::ordered_json result = nlohmann::ordered_json::parse(program_json(program, &checks));
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

constexpr Range kPlausibleToolMm{0.1, kLargestLengthMm};  // thinner or shorter is no instrument
constexpr Range kWithinReachMm{-5000.0, 5000.0};          // of any arm
constexpr Range kPlausiblePowerW{0.0, 400.0, true};       // no electrosurgical generator gives more (IEC 60601-2-2)

}  // namespace

void describe(Visitor& v, ExportRequest& r) {
  v("format", r.form, "Format of the program; ros-trajectory: .yaml for ROS 2, .bag for ROS 1.");
  v("motion", r.motion, "Moves of URScript: movep (blends, constant speed; the default) or servoj (timed joints).");
  v("kind", r.kind, "Kind of path whose checks apply, in place of the path's own kind.");
  v("intended", r.intended, "The path before correction, to check the deviation.");
  v("surface", r.surface,
    "The tissue in the robot's frame (.ply, .stl, .obj, .vtp; triangles or points): depth, arm, shaft and needle are "
    "checked against it.");
  v("registration", r.registration, "Result of `incise register` (.json): its quality is checked.");
  v("power_w", r.power_w, "Power of the electrode, to check it and how far beside the needle its heat reaches.",
    kPlausiblePowerW);
  v("table_z_mm", r.setup.table_z_mm, "Height of the table's plane in the base frame.", kWithinReachMm);
  v("needle_length_mm", r.checks.needle_length_mm, "Length of the needle; the shaft begins behind it.",
    kPlausibleToolMm);
  double shaft_mm = 2.0 * r.checks.shaft_radius_mm;
  v("shaft_diameter_mm", shaft_mm, "Diameter of the instrument's shaft.", kPlausibleToolMm);
  if (v.sets()) r.checks.shaft_radius_mm = 0.5 * shaft_mm;
  v("depth_mm", r.checks.planned_depth_mm, "Planned depth.", kPositive);
  v("close_margin_mm", r.checks.close_margin_mm, "Least distance from the tumour edge.", kPositive);
  v("overlap_mm", r.overlap_mm, "How far a ring continues beyond its start; by default 8, for a mark 0.",
    {0.0, kLargestLengthMm});
  v("open", r.is_open, "The path is an open cut: closed, gap and encloses are not checked.");
}

void report_gate(const Verdict& verdict, const VerdictGate& gate, Monitor& monitor) {
  for (const VerdictReason& reason : verdict.reasons()) {
    const bool is_accepted = std::find(gate.accepted.begin(), gate.accepted.end(), reason.id) != gate.accepted.end();
    if (is_accepted) {
      monitor.message(Severity::Warning, fmt::format("accepted: {}: {}", reason.id, reason.message));
    } else if (reason.severity == VerdictStatus::Refused) {
      monitor.message(Severity::Warning, fmt::format("no program: refused: {}: {}", reason.id, reason.message));
    } else {
      monitor.message(Severity::Warning, fmt::format("no program: caution: {}: {}. --accept {} accepts it", reason.id,
                                                     reason.message, reason.id));
    }
  }
}

void take_case(const CaseFile& file, ExportRequest& request) {
  const Case& settings = file.settings;
  require_round_tool(settings);
  take_arm(settings, request.setup);
  take_limits(settings, request.checks);
  request.is_open = !request.checks.must_be_ring;
  request.usual_overlap_mm = settings.cut.overlap_mm;
  request.power_w = settings.plan.power_w;
  request.thermal = settings.thermal;
  request.tool = settings.tool;
  request.case_file = file.file;
  request.case_sha256 = sha256_of_file(file.file);
  request.case_specimen_id = specimen_id_of_case(file);
}

StepResult export_program(const ExportRequest& given, const StepContext& context) {
  ExportRequest request = given;
  require_override_names(request.overrides);
  require_ending(request.output, request.form);
  require_own_program(request.output);
  if (request.motion && request.form != ProgramForm::UrScript) {
    throw CaseError("command line", "--motion",
                    fmt::format("{} for --format {}", to_string(*request.motion), to_string(request.form)),
                    "no --motion: only URScript has two kinds of motion");
  }
  ToolPath path = read_robot_path(request.path);
  const PathKind kind_in_file = path.kind;
  if (request.kind) path.kind = *request.kind;
  require_of_case(path, request, context.monitor);
  if (path.kind == PathKind::Mark) {
    require_a_mark(request.overrides);
    // A case with an open cut says nothing about the mark of its tumour's edge.
    if (!request.case_file.empty()) request.is_open = false;
  }
  if (request.is_open && path.is_closed) {
    throw CaseError("command line", "--open", fmt::format("{}, a closed path", request.path.string()), "an open path",
                    "Leave --open out: a ring must pass closed, gap and encloses.");
  }
  complete(request, path);
  CheckInputs inputs;
  std::optional<ToolPath> intended;
  std::optional<TriMesh> surface;
  if (!request.intended.empty()) inputs.intended = &intended.emplace(read_robot_path(request.intended));
  if (!request.surface.empty()) inputs.surface = &surface.emplace(read_cloud(request.surface));
  std::optional<RegistrationRecord> registration;
  if (!request.registration.empty()) {
    registration = read_registration(request.registration);
    require_same_specimen(request.registration, path.specimen_id, "the path's");
    require_clouds_unchanged(*registration, request.registration, context.monitor);
    inputs.registration = registration_summary(*registration, request.registration);
  }
  Verdict verdict = verdict_along(request, kind_in_file, path.kind, registration);
  if (!request.surface.empty()) require_same_specimen(request.surface, path.specimen_id, "the path's");
  if (intended) require_same_specimen(request.intended, path.specimen_id, "the path's");
  if (request.power_w) {
    inputs.power_w = request.power_w;
    inputs.heat_half_width_mm = half_width_of_heat_mm(path, request);
  }
  require_writable(request.output);
  warn_of_less(request, inputs, path, context.monitor);

  const RobotProgram program = program_of(path, request);
  ProgramChecks checks = check_program(program, path, request.checks, inputs);
  override_checks(checks, request.overrides);
  StepResult done{summary_of(program, checks)};
  nlohmann::ordered_json& result = done.json;
  for (const ProgramCheck& check : checks.checks) {
    if (check.is_overridden) context.monitor.message(Severity::Warning, "overridden: " + check.message());
  }
  add_failed_checks(checks, verdict);
  const VerdictGate gate = gate_of(verdict, request.accepted);
  report_gate(verdict, gate, context.monitor);
  result["verdict"] = to_json(verdict);
  result["gate"] = to_json(gate);
  if (!gate.is_open) {
    result["stale_output"] = nullptr;
    std::error_code absent;
    const bool is_there = std::filesystem::is_regular_file(request.output, absent);
    if (is_there) result["stale_output"] = request.output.string();
    result["wall_s"] = context.wall_s();
    done.is_acceptable = false;
    return done;
  }
  ProgramHeader provenance{{"made_by", fmt::format("incise {} ({})", version(), source_commit())},
                           {"made_from", request.path.filename().string()},
                           {"made_from_sha256", sha256_of_file(request.path)}};
  if (!request.case_file.empty()) {
    provenance.emplace_back("case", request.case_file.filename().string());
    provenance.emplace_back("case_sha256", request.case_sha256);
  }
  if (!path.specimen_id.empty()) provenance.emplace_back("specimen_id", path.specimen_id);
  if (path.is_virtual) provenance.emplace_back("specimen", kVirtualSpecimen);
  for (const auto& line : verdict_header(verdict, gate)) provenance.push_back(line);
  const ProgramHeader header = program_header(program, path, checks, provenance);
  const std::string text = text_of(program, checks, header, request);
  write_atomically(request.output, text);
  result["program"] = request.output.string();
  result["wall_s"] = context.wall_s();
  return done;
}

}  // namespace incise::steps
