#include "described_options.hpp"
#include "option_checks.hpp"
#include "options.hpp"
#include "verdict_gate.hpp"

#include <incise/core/units.hpp>
#include <incise/steps/robot_steps.hpp>
#include <incise/storage/case_file.hpp>

namespace incise::cli {
namespace {

struct ExportArguments {
  steps::ExportRequest request;
  std::filesystem::path case_file;
  std::string robot = "ur10e";
};

int run_export(const ExportArguments& arguments, const CommonOptions& options) {
  steps::ExportRequest request = arguments.request;
  if (!arguments.case_file.empty()) steps::take_case(read_case(arguments.case_file), request);
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
  ArmSetup& setup = a.request.setup;
  verb->add_option("path", a.request.path, "path.json, frame robot")->required();
  verb->add_option("--robot", a.robot, "Robot arm")->check(CLI::IsMember({"ur10e"}));
  verb->add_option("--override", a.request.overrides,
                   "Write the program even if this check fails. Repeat for each check; the program lists them")
      ->expected(1)
      ->take_all();
  add_accept(*verb, a.request.accepted);
  CLI::Option* const of_case =
      verb->add_option("--case", a.case_file,
                       "Case of the path: its arm, limits, power, heat, tool and overlap, as `incise run` uses them");
  verb->add_option_function<std::vector<double>>(
          "--tcp",
          [&setup](const std::vector<double>& tcp) {
            setup.T_flange_tool = tool_pose(Vec3(tcp.data()), Vec3(tcp.data() + 3));
          },
          "Tool centre point in the flange's frame, as on the pendant: x y z (mm) rx ry rz (rad); z along the needle. "
          "By default 0 0 150 0 0 0")
      ->expected(6);
  verb->add_option_function<std::vector<double>>(
          "--near-joints-deg",
          [&setup](const std::vector<double>& joints) {
            for (int i = 0; i < setup.near_rad.size(); ++i)
              setup.near_rad[i] = units::rad_from_deg(joints[static_cast<std::size_t>(i)]);
          },
          "Joint angles that the arm is near before it starts")
      ->expected(6)
      ->check(between("--near-joints-deg", -360.0, 360.0));
  add_options_of(*verb, a.request, "format", "motion", "kind", "intended", "surface", "registration", "power_w",
                 "table_z_mm", "needle_length_mm", "shaft_diameter_mm", "depth_mm", "close_margin_mm", "overlap_mm",
                 "open");
  for (const char* name : {"--power-w", "--tcp", "--depth-mm", "--close-margin-mm", "--overlap-mm", "--open"})
    of_case->excludes(verb->get_option(name));
}

}  // namespace incise::cli
