#include "described_options.hpp"
#include "option_checks.hpp"
#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/steps/camera_steps.hpp>

#include <algorithm>
#include <sstream>

namespace incise::cli {
namespace {

struct RegisterArguments {
  steps::RegisterRequest request;
  std::string scale = "0.9,1.1";
  std::string method = "rigid";
  std::vector<double> approach{0.0, 0.0, -1.0};
  bool no_icp = false;
  bool from_identity = false;
  NonrigidSettings nonrigid;
};

/// free, fixed or LO,HI.
ScaleRange scale_of(const std::string& text) {
  if (text == "free") return ScaleRange::free();
  if (text == "fixed") return ScaleRange::fixed();
  std::istringstream in(text);
  ScaleRange range;
  char comma = '\0';
  std::string rest;
  const bool is_read = static_cast<bool>(in >> range.low >> comma >> range.high) && comma == ',' && !(in >> rest);
  if (!is_read || !(range.low > 0.0 && range.low <= range.high && range.high < 1e6)) {
    throw CaseError("command line", "--scale", text, "free, fixed, or LO,HI with 0 < LO <= HI",
                    "For example: --scale 0.95,1.05");
  }
  return range;
}

int run_register(const RegisterArguments& arguments, const CommonOptions& options) {
  steps::RegisterRequest request = arguments.request;
  request.output = options.required_output("registration");
  refuse_input_as_output("-o", request.output, {request.source, request.target});
  require_replaceable(request.output);
  RegistrationSettings& settings = request.settings;
  settings.scale = scale_of(arguments.scale);
  settings.finish_with_icp = !arguments.no_icp;
  if (arguments.from_identity) settings.start = Similarity{std::clamp(1.0, settings.scale.low, settings.scale.high)};
  request.approach = direction_of(arguments.approach, "--approach");
  require_valid(validate(settings));
  if (arguments.method == "nonrigid") request.nonrigid = arguments.nonrigid;
  return run_step(options, [&](const auto& context) { return steps::lay_clouds(request, context); });
}

}  // namespace

void add_register(Application& application) {
  auto [verb, a] = application.add_verb<RegisterArguments>(
      "register",
      "Find the similarity transform from one cloud to another, and whether to trust it. Exit status 4: do not trust "
      "it",
      "incise register --source simulated.ply --target tissue.ply --scale fixed --settling-mm 1 -o registration",
      run_register);
  verb->add_option("--source", a.request.source, "Cloud or surface to be moved (.ply, .vtp, .stl, .obj)")->required();
  verb->add_option("--target", a.request.target, "Cloud or surface that stays")->required();
  verb->add_option("--scale", a.scale, "free, fixed, or LO,HI");
  verb->add_option("--method", a.method, "nonrigid: also bend the source to the target (moved_source.ply)")
      ->check(CLI::IsMember({"rigid", "nonrigid"}));
  add_options_of(*verb, a.request.settings, "outlier_weight", "rotations", "max_iterations", "settling_mm");
  verb->add_flag("--from-identity", a.from_identity, "Do not search: the clouds already nearly coincide");
  verb->add_flag("--no-icp", a.no_icp, "Use coherent point drift alone");
  verb->add_option("--max-rmse-mm", a.request.max_rmse_mm,
                   "Greatest acceptable residual; 0: 3 % of the target's radius")
      ->check(between("--max-rmse-mm", 0.0, 1000.0));
  add_options_of(*verb, a.nonrigid, "smoothness", "stiffness");
  verb->add_option("--approach", a.approach, "Line of sight of the picture")->expected(3);
}

}  // namespace incise::cli
