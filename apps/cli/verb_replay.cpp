#include "option_checks.hpp"
#include "options.hpp"

#include <incise/steps/robot_steps.hpp>

namespace incise::cli {
namespace {

int run_replay(steps::ReplayRequest request, const CommonOptions& options) {
  request.output = options.output;
  refuse_input_as_output("-o", request.output, {request.program, request.path});
  return run_step(options, [&](const auto& context) { return steps::replay_program(request, context); });
}

}  // namespace

void add_replay(Application& application) {
  auto [verb, a] = application.add_verb<steps::ReplayRequest>(
      "replay",
      "Play a program and show what the tip of the tool would do. Exit status 4 if it cannot be run, or the tip leaves "
      "its path",
      "incise replay cut.script --speed-slider 50 -o replay", run_replay);
  describe_output(*verb, kNothingByDefault);
  verb->add_option("program", a.program, "A program that `incise export` wrote: URScript, .csv or .json")->required();
  verb->add_option("--speed-slider", a.slider_percent, "Setting of the controller's speed slider, percent")
      ->check(CLI::Range(1.0, 100.0));
  verb->add_option("--max-deviation-mm", a.max_deviation_mm,
                   "Greatest allowed deviation of the tip from the path in the cut; beyond it the exit status is 4")
      ->check(above_zero("--max-deviation-mm"));
  verb->add_option("--path", a.path,
                   "path.json, frame robot, to compare the tip with; by default the one in the program");
}

}  // namespace incise::cli
