#include "option_checks.hpp"
#include "options.hpp"
#include "verdict_gate.hpp"

#include <incise/core/units.hpp>
#include <incise/steps/robot_steps.hpp>
#include <incise/storage/case_file.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace incise::cli {
namespace {

constexpr double kFarthestTableMm = 5000.0;  // beyond any arm's reach
constexpr double kLeastToolMm = 0.1;         // thinner or shorter is no instrument
constexpr double kMostPowerW = 400.0;        // no electrosurgical generator gives more (IEC 60601-2-2)

struct ExportArguments {
  steps::ExportRequest request;
  std::filesystem::path case_file;
  std::string robot = "ur10e", format = "urscript", motion, kind;
  double shaft_diameter_mm = 2.0 * CheckSettings{}.shaft_radius_mm;
  double power_w = 0.0;  // not given
  std::vector<double> tcp, near_deg;
};

/// Returns the options as a request of the library.
steps::ExportRequest request_of(const ExportArguments& arguments) {
  steps::ExportRequest request = arguments.request;
  if (!arguments.case_file.empty()) steps::take_case(read_case(arguments.case_file), request);
  request.form = value_named<steps::ProgramForm>(arguments.format);
  if (!arguments.motion.empty()) request.motion = value_named<ScriptMotion>(arguments.motion);
  if (!arguments.kind.empty()) request.kind = value_named<PathKind>(arguments.kind);
  if (arguments.power_w > 0.0) request.power_w = arguments.power_w;
  request.checks.shaft_radius_mm = 0.5 * arguments.shaft_diameter_mm;
  const std::vector<double>& tcp = arguments.tcp;
  if (!tcp.empty()) request.setup.T_flange_tool = tool_pose(Vec3(tcp.data()), Vec3(tcp.data() + 3));
  for (std::size_t i = 0; i < arguments.near_deg.size(); ++i)
    request.setup.near_rad[static_cast<int>(i)] = units::rad_from_deg(arguments.near_deg[i]);
  return request;
}

int run_export(const ExportArguments& arguments, const CommonOptions& options) {
  steps::ExportRequest request = request_of(arguments);
  request.output = options.required_output("cut.script");
  refuse_input_as_output("-o", request.output, {request.path, request.intended, request.surface, request.registration});
  Console console(options.level());
  OlderOutput older(request.output, console);
  require_accepted_ids(request.accepted);
  return run_step(options, [&](const auto& context) {
    steps::StepResult done = steps::export_program(request, context);
    if (done.is_acceptable) older.replaced();
    return done;
  });
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
  verb->add_option("path", a.request.path, "path.json, frame robot")->required();
  verb->add_option("--robot", a.robot, "Robot arm")->check(CLI::IsMember({"ur10e"}));
  verb->add_option("--format", a.format, "Format of the program; ros-trajectory: .yaml for ROS 2, .bag for ROS 1")
      ->check(CLI::IsMember({"urscript", "joint-csv", "ros-trajectory", "json"}));
  verb->add_option("--motion", a.motion,
                   "Moves of URScript: movep (blends, constant speed; the default) or servoj (timed joints)")
      ->check(name_of_any<ScriptMotion>());
  verb->add_option("--kind", a.kind, "Kind of path whose checks apply, in place of the path's own kind")
      ->check(CLI::IsMember({"mark", "incise"}));
  verb->add_option("--override", a.request.overrides,
                   "Write the program even if this check fails. Repeat for each check; the program lists them")
      ->expected(1)
      ->take_all();
  add_accept(*verb, a.request.accepted);
  CLI::Option* const of_case =
      verb->add_option("--case", a.case_file,
                       "Case of the path: its arm, limits, power, heat, tool and overlap, as `incise run` uses them");
  verb->add_option("--intended", a.request.intended, "The path before correction, to check the deviation");
  verb->add_option("--surface", a.request.surface,
                   "The tissue in the robot's frame (.ply, .stl, .obj, .vtp; triangles or points): depth, arm, "
                   "shaft and needle are checked against it");
  verb->add_option("--registration", a.request.registration,
                   "Result of `incise register` (.json): its quality is checked");
  verb->add_option("--power-w", a.power_w,
                   "Power of the electrode, to check it and how far beside the needle its heat reaches")
      ->check(above_zero("--power-w"))
      ->check(CLI::Range(0.0, kMostPowerW));
  verb->add_option("--tcp", a.tcp,
                   "Tool centre point in the flange's frame, as on the pendant: x y z (mm) rx ry rz (rad); z along the "
                   "needle. By default 0 0 150 0 0 0")
      ->expected(6);
  verb->add_option("--near-joints-deg", a.near_deg, "Joint angles that the arm is near before it starts")
      ->expected(6)
      ->check(between("--near-joints-deg", -360.0, 360.0));
  verb->add_option("--table-z-mm", a.request.setup.table_z_mm, "Height of the table's plane in the base frame")
      ->check(between("--table-z-mm", -kFarthestTableMm, kFarthestTableMm));
  verb->add_option("--needle-length-mm", a.request.checks.needle_length_mm,
                   "Length of the needle; the shaft begins behind it")
      ->check(between("--needle-length-mm", kLeastToolMm, kLargestLengthMm));
  verb->add_option("--shaft-diameter-mm", a.shaft_diameter_mm, "Diameter of the instrument's shaft")
      ->check(between("--shaft-diameter-mm", kLeastToolMm, kLargestLengthMm));
  verb->add_option("--depth-mm", a.request.checks.planned_depth_mm, "Planned depth")->check(above_zero("--depth-mm"));
  verb->add_option("--close-margin-mm", a.request.checks.close_margin_mm, "Least distance from the tumour edge")
      ->check(above_zero("--close-margin-mm"));
  verb->add_option("--overlap-mm", a.request.overlap_mm,
                   "How far a ring continues beyond its start; by default 8, for a mark 0")
      ->check(CLI::Range(0.0, kLargestLengthMm))
      ->default_str("");
  verb->add_flag("--open", a.request.is_open, "The path is an open cut: closed, gap and encloses are not checked");
  for (const char* name : {"--power-w", "--tcp", "--depth-mm", "--close-margin-mm", "--overlap-mm", "--open"})
    of_case->excludes(verb->get_option(name));
}

}  // namespace incise::cli
